"""The NumPy twin against theory, without the compiled kernel."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from reference import Material, Reference
from reference.drucker_prager import (
    cone,
    moduli,
    rotate,
)
from reference.shapes import hat, weights
from reference.walls import hold_momentum, hold_velocity

Array = NDArray[np.float64]
FREE = [("free", 0.0, 0.0)] * 4
SOIL = Material(1800.0, 30e6, 0.33)
PLASTIC = Material(1800.0, 30e6, 0.33, "drucker_prager", 22.0, 1e3)
H = 0.1


def block(cells: int = 6, shape: str = "ugimp", **options: Any) -> Reference:
    """A square of 2 x 2 points a cell with its lower left corner at the origin."""
    s = H / 2
    centre = (np.arange(2 * cells) + 0.5) * s
    position = np.array([(x, y) for x in centre for y in centre])
    n = len(position)
    volume = np.full(n, s * s)
    settings: dict[str, Any] = {
        "materials": [SOIL],
        "cell": H,
        "origin": (0.0, 0.0),
        "walls": FREE,
        "blend": ("alpha", 0.0),
        "time_step": ("fixed", 1e-5),
    } | options
    return Reference(
        position,
        np.zeros((n, 2)),
        np.full((n, 2), s / 2),
        1800.0 * volume,
        volume,
        np.zeros(n),
        shape=shape,
        **settings,
    )


def interior(twin: Reference) -> NDArray[np.bool_]:
    """Points whose nodes see a full, symmetric set of points, so that linear fields are exact."""
    low, high = twin.position.min(axis=0) + 2 * H, twin.position.max(axis=0) - 2 * H
    return np.asarray(np.all((twin.position > low) & (twin.position < high), axis=1))


def flow(twin: Reference, gradient: Any) -> None:
    twin.velocity = twin.position @ np.array(gradient, float).T


@pytest.mark.parametrize("shape", ["linear", "ugimp"])
def test_shapes_reproduce_constants_and_coordinates(shape: str) -> None:
    rng = np.random.default_rng(1)
    x, l = rng.uniform(0.2, 0.8, (50, 2)), rng.uniform(0.01, 0.08, (50, 2))  # noqa: E741
    line = H * np.arange(-1, 12, dtype=np.float64)
    nodes = np.array([(a, b) for a in line for b in line])
    s, sx, sy = weights(shape, x, l, (line, line), H)
    assert s.min() >= 0
    np.testing.assert_allclose(s.sum(axis=1), 1, atol=1e-13)
    np.testing.assert_allclose(s @ nodes, x, atol=1e-13)
    np.testing.assert_allclose(sx.sum(axis=1), 0, atol=1e-11)
    np.testing.assert_allclose(sx @ nodes, np.tile([1, 0], (50, 1)), atol=1e-12)
    np.testing.assert_allclose(sy @ nodes, np.tile([0, 1], (50, 1)), atol=1e-12)


@pytest.mark.parametrize("l", [0.01, 0.025, 0.05, 0.13])
def test_gimp_is_the_mean_of_the_hat_and_its_gradient_the_derivative(l: float) -> None:  # noqa: E741
    line, points = H * np.arange(-4, 5, dtype=np.float64), np.linspace(-0.2, 0.2, 83)

    def along(x: Array) -> tuple[Array, Array]:
        position, half = np.stack([x, 0 * x], axis=1), np.full((len(x), 2), l)
        s, sx, _ = weights("ugimp", position, half, (line, line), H)
        return s.reshape(-1, 9, 9).sum(axis=2), sx.reshape(-1, 9, 9).sum(axis=2)

    samples = l * (2 * (np.arange(2000) + 0.5) / 2000 - 1)
    mean = hat(points[:, None, None] + samples - line[:, None], H).mean(axis=2)
    np.testing.assert_allclose(along(points)[0], mean, atol=1e-6)
    e = 1e-6
    slope = (along(points + e)[0] - along(points - e)[0]) / (2 * e)
    np.testing.assert_allclose(along(points)[1], slope, atol=2e-3)


@pytest.mark.parametrize("shape", ["linear", "ugimp", "cpgimp"])
@pytest.mark.parametrize("blend", [("alpha", 0.1), ("viscosity", 0.5), ("relaxation_time", 0.01)])
def test_momentum_of_a_free_body_changes_by_its_weight(shape: str, blend: Any) -> None:
    twin = block(4, shape, blend=blend, domain_update="jacobian", time_step=("courant", 0.3))
    twin.velocity = np.random.default_rng(2).standard_normal(twin.velocity.shape)
    twin.set_gravity(1.0, -9.81, 0.0)
    before = twin.mass @ twin.velocity
    twin.advance(20)
    weight = twin.mass.sum() * np.array([1.0, -9.81])
    np.testing.assert_allclose(twin.mass @ twin.velocity, before + weight * twin.time, rtol=1e-11)


def test_gravity_ramp_and_position_of_a_falling_body() -> None:
    twin = block(3, time_step=("fixed", 1e-3))
    twin.set_gravity(0.0, -10.0, 0.004)
    first = twin.position.copy()
    twin.advance(6)
    velocity = -10 * 1e-3 * np.cumsum([0.25, 0.5, 0.75, 1, 1, 1])
    np.testing.assert_allclose(twin.velocity[:, 1], velocity[-1], rtol=1e-11)
    np.testing.assert_allclose((twin.position - first)[:, 1], velocity.sum() * 1e-3, rtol=1e-11)
    assert twin.time == pytest.approx(6e-3)


def test_uniaxial_strain_increment() -> None:
    twin = block(8)
    flow(twin, [[0.5, 0], [0, 0]])
    inside = interior(twin)
    twin.advance(1)
    lame, shear, _ = moduli(SOIL)
    e = 0.5 * 1e-5
    expected = np.array([(lame + 2 * shear) * e, lame * e, lame * e, 0])
    np.testing.assert_allclose(
        twin.stress[inside], np.tile(expected, (inside.sum(), 1)), rtol=1e-10, atol=1e-9
    )
    np.testing.assert_allclose(twin.volume[inside], (H / 2) ** 2 * (1 + e), rtol=1e-13)


@pytest.mark.parametrize("update", ["linear", "exponential"])
def test_volume_update(update: str) -> None:
    twin = block(8, volume_update=update, time_step=("fixed", 1e-2))
    flow(twin, [[3.0, 0], [0, 2.0]])
    inside = interior(twin)
    twin.advance(1)
    growth = 1.05 if update == "linear" else np.exp(0.05)
    np.testing.assert_allclose(twin.volume[inside], (H / 2) ** 2 * growth, rtol=1e-12)


def test_rigid_rotation_turns_the_stress() -> None:
    twin = block(8, time_step=("fixed", 1e-2))
    flow(twin, [[0, -30.0], [30.0, 0]])  # 0.3 rad in the step
    twin.stress[:] = [3e3, -1e3, 5e2, 7e2]
    inside = interior(twin)
    twin.advance(1)
    c, s = np.cos(0.3), np.sin(0.3)
    turned = np.array([[c, -s], [s, c]]) @ [[3e3, 7e2], [7e2, -1e3]] @ [[c, s], [-s, c]]
    expected = np.tile([turned[0, 0], turned[1, 1], 5e2, turned[0, 1]], (inside.sum(), 1))
    np.testing.assert_allclose(twin.stress[inside], expected, atol=1e-5)


def test_rotation_by_a_right_angle_swaps_the_axes() -> None:
    stress = np.array([[[1.0, 4, 0], [4, 2, 0], [0, 0, 3]]])
    expected = [[[2, -4, 0], [-4, 1, 0], [0, 0, 3]]]
    np.testing.assert_allclose(rotate(stress, np.array([np.pi / 2])), expected, atol=1e-15)


@pytest.mark.parametrize(
    ("update", "expected"),
    [
        ("none", (1.0, 1.0)),
        ("jacobian", (np.exp(0.075), np.exp(0.075))),
        ("stretch", (1.1, 1.05)),
        ("deformation_diagonal", (1.1, 1.05)),
    ],
)
def test_domains_follow_a_stretch(update: str, expected: tuple[float, float]) -> None:
    twin = block(8, "cpgimp", domain_update=update, volume_update="exponential")
    twin.step_rule = ("fixed", 1e-2)
    flow(twin, [[10.0, 0], [0, 5.0]])
    inside = interior(twin)
    twin.advance(1)
    ratio = twin.half_length[inside] / (H / 4)
    np.testing.assert_allclose(ratio, np.tile(expected, (len(ratio), 1)), rtol=1e-12)


def test_stretch_ignores_rotation_and_the_diagonal_does_not() -> None:
    ratios = {}
    for update in ("stretch", "deformation_diagonal"):
        twin = block(8, "cpgimp", domain_update=update)
        turn = 0.3
        twin.deformation_gradient[:] = [
            [np.cos(turn), -np.sin(turn)],
            [np.sin(turn), np.cos(turn)],
        ]
        twin.advance(1)
        ratios[update] = twin.half_length / (H / 4)
    np.testing.assert_allclose(ratios["stretch"], 1, rtol=1e-13)
    np.testing.assert_allclose(ratios["deformation_diagonal"], np.cos(0.3), rtol=1e-13)


def test_local_damping_takes_its_share_of_the_force() -> None:
    twin = block(3, time_step=("fixed", 1e-3))
    twin.set_gravity(0.0, -10.0, 0.0)
    twin.set_damping(0.2, False)
    twin.advance(2)
    np.testing.assert_allclose(twin.velocity[:, 1], -10 * 1e-3 * (1 + 0.8), rtol=1e-12)


def test_kinetic_damping_clears_the_velocity_after_a_peak() -> None:
    twin = block(3, time_step=("fixed", 1e-3))
    twin.set_gravity(0.0, -10.0, 0.0)
    twin.set_damping(0.0, True)
    twin.velocity[:, 1] = 1.0
    twin.advance(1)
    assert np.all(twin.velocity[:, 1] > 0.9)
    twin.advance(1)
    assert np.all(twin.velocity == 0)


def test_viscosity_becomes_alpha() -> None:
    twin = block(3, blend=("viscosity", 1.9))
    assert twin.alpha(1e-5) == pytest.approx(1.9e-5 / (0.1875 * H**2))
    assert block(3, "linear", blend=("viscosity", 1.9)).alpha(1e-5) == pytest.approx(0.0114)


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.0])
def test_points_move_with_the_grid_velocity_whatever_the_blend(alpha: float) -> None:
    pic, twin = block(3, blend=("alpha", 1.0)), block(3, blend=("alpha", alpha))
    first = pic.position.copy()
    pic.velocity = np.random.default_rng(3).standard_normal(pic.velocity.shape)
    twin.velocity = pic.velocity.copy()
    pic.advance(1)
    twin.advance(1)
    np.testing.assert_allclose(twin.position, first + 1e-5 * pic.velocity, rtol=1e-14)


@pytest.mark.parametrize("kind", ["roller", "fixed", "coulomb"])
def test_flip_feels_the_wall(kind: str) -> None:
    """From a uniform velocity FLIP and PIC agree after one step, wall reaction included."""
    velocities = []
    for alpha in (0.0, 1.0):
        twin = block(3, blend=("alpha", alpha), walls=[*FREE[:2], (kind, 0.3, 0.0), FREE[3]])
        twin.velocity[:] = [0.5, -1.0]
        twin.advance(1)
        velocities.append(twin.velocity)
    np.testing.assert_allclose(velocities[0], velocities[1], atol=1e-13)
    assert np.abs(velocities[0] - [0.5, -1.0]).max() > 0.1


def test_courant_step() -> None:
    stiff = replace(SOIL, young=20e9, poisson=0.2, density=1800.0)
    twin = block(3, materials=[SOIL, stiff], time_step=("courant", 0.4))
    twin.material[5] = 1
    twin.velocity[7] = [3.0, 4.0]
    wave = np.sqrt(20e9 * 0.8 / (1.2 * 0.6) / 1800)
    assert twin.time_step == pytest.approx(0.4 * H / (wave + 5), rel=1e-12)


def test_walls_hold_every_node_on_or_beyond_them() -> None:
    nodes = np.array([[-H, 0.5], [0.0, 0.5], [H, 0.5]])
    v = np.array([[-1.0, 2.0], [-1.0, 2.0], [-1.0, 2.0]])
    expected = {"free": [-1, 2], "roller": [0, 2], "fixed": [0, 0], "coulomb": [0, 2]}
    for kind, held in expected.items():
        walls = [(kind, 0.0, 0.0), *FREE[1:]]
        for got in (hold_velocity(v, v, nodes, walls, H), hold_momentum(v, nodes, walls, H)):
            np.testing.assert_array_equal(got, [held, held, [-1, 2]])


def test_coulomb_wall_lets_go_what_it_did_not_hold() -> None:
    """The strain step sees a node leave the wall only if it moved along the normal before."""
    walls = [FREE[0], FREE[1], ("coulomb", 0.5, 0.0), FREE[3]]
    nodes = np.array([[0.0, 0.0], [H, 0.0]])
    leaving = np.array([[1.0, 0.3], [1.0, 0.3]])
    for before, seen in [
        ([1.0, 0.1], [1.0, 0.3]),  # slid and rose
        ([1.0, 0.0], [1.0, 0.0]),  # slid, held
        ([0.0, 0.0], [0.0, 0.0]),  # stuck
        ([0.0, 0.1], [1.0, 0.3]),  # rose
    ]:
        got = hold_velocity(leaving, np.array([before, before]), nodes, walls, H)
        np.testing.assert_array_equal(got, [seen, seen])


@pytest.mark.parametrize(
    ("momentum", "after"),
    [((3, -2), (2, 0)), ((-3, -2), (-2, 0)), ((0.5, -2), (0, 0)), ((3, 2), (3, 2))],
)
def test_coulomb_friction_on_the_base(momentum: Any, after: Any) -> None:
    walls = [FREE[0], FREE[1], ("coulomb", 0.5, 0.0), FREE[3]]
    node = np.array([[0.3, 0.0]])
    got = hold_momentum(np.array([momentum], float), node, walls, H)
    np.testing.assert_allclose(got, [after])


def test_column_at_rest_carries_its_weight() -> None:
    twin = block(
        4,
        walls=[("roller", 0, 0.0), ("roller", 0, 0.4), ("fixed", 0, 0.0), ("free", 0, 9.0)],
        time_step=("courant", 0.4),
    )
    twin.set_gravity(0.0, -9.81, 0.0)
    twin.set_damping(0.0, True)
    twin.advance(400)
    depth = (np.floor((0.4 - twin.position[:, 1]) / H) + 0.5) * H  # of the cell: both rows share L
    np.testing.assert_allclose(twin.stress[:, 1], -1800 * 9.81 * depth, rtol=1e-3)
    np.testing.assert_allclose(twin.stress[:, 0], 0.33 / 0.67 * twin.stress[:, 1], rtol=1e-9)


def test_released_energy_is_that_of_the_returned_stress() -> None:
    twin = block(3, materials=[PLASTIC, SOIL])
    twin.material[::2] = 1
    twin.stress[:] = [0, 0, 0, 4e3]
    _, xi, _ = cone(PLASTIC)
    _, shear, _ = moduli(PLASTIC)
    soft = twin.material == 0
    expected = twin.volume[soft].sum() * (4e3**2 - (xi * 1e3) ** 2) / (2 * shear)
    assert twin.release_stress() == pytest.approx(expected, rel=1e-12)
    np.testing.assert_allclose(twin.stress[soft, 3], xi * 1e3, rtol=1e-12)
    assert np.all(twin.stress[~soft, 3] == 4e3)
    assert np.all(twin.plastic_strain[soft] > 0) and np.all(twin.plastic_strain[~soft] == 0)


def test_leaving_the_grid_and_misspelt_options_are_errors() -> None:
    twin = block(2)
    twin.position += 2.0
    with pytest.raises(RuntimeError, match="left the grid"):
        twin.advance(1)
    with pytest.raises(ValueError, match="shape is 'bspline'"):
        block(2, "bspline")
    with pytest.raises(ValueError, match="cone is 'oute'"):
        Material(1, 1, 0.2, cone="oute")


def test_splines_meet_linear_motion_up_to_the_walls() -> None:
    """They add up to one and reproduce places by the nodes within the walls alone; what touches a
    wall moves with the node there."""
    x = np.random.default_rng(2).uniform(0.0, 5 * H, (60, 2))
    x[:3, 0], x[3:6, 1] = 0.0, 5 * H
    line = H * np.arange(-3, 9, dtype=np.float64)
    nodes = np.array([(a, b) for a in line for b in line])
    walls = [("roller", 0.0, 0.0), ("fixed", 0.0, 5 * H)] * 2
    s, sx, sy = weights("quadratic_bspline", x, np.zeros_like(x), (line, line), H, walls)
    outside = np.any((nodes < -H / 2) | (nodes > 5.5 * H), axis=1)
    assert not s[:, outside].any()
    assert s.min() >= 0.0
    np.testing.assert_allclose(s.sum(axis=1), 1.0)
    np.testing.assert_allclose(s @ nodes, x, atol=1e-15)
    np.testing.assert_allclose(sx @ nodes, np.tile([1.0, 0.0], (60, 1)), atol=1e-13)
    np.testing.assert_allclose(sy @ nodes, np.tile([0.0, 1.0], (60, 1)), atol=1e-13)
    at_left, at_top = nodes[:, 0] == 0.0, np.isclose(nodes[:, 1], 5 * H)
    np.testing.assert_allclose(s[:3][:, at_left].sum(axis=1), 1.0)
    np.testing.assert_allclose(s[3:6][:, at_top].sum(axis=1), 1.0)
