"""The NumPy twin against theory, without the compiled kernel."""

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from reference import Material, Reference
from reference.bodies import quarter_turn
from reference.drucker_prager import (
    cone,
    elastic_increment,
    invariants,
    moduli,
    return_mapping,
    rotate,
    tension_limit,
)
from reference.interface import APART, Interface
from reference.shapes import hat, weights
from reference.walls import hold_momentum, hold_velocity

Array = NDArray[np.float64]
FREE = [("free", 0.0, 0.0)] * 4
SOIL = Material(1800.0, 30e6, 0.33)
PLASTIC = Material(1800.0, 30e6, 0.33, "drucker_prager", 22.0, 1e3)
CONES = ("outer", "inner", "plane_strain_associated", "plane_strain")
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


def random_stress(seed: int, size: float, n: int = 400) -> Array:
    half = size * np.random.default_rng(seed).standard_normal((n, 3, 3))
    half[:, 2, :2] = half[:, :2, 2] = 0.0
    return half + np.swapaxes(half, 1, 2)


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


def test_cones_match_their_closed_forms() -> None:
    phi, psi = np.radians(22), np.radians(7)
    soil = replace(PLASTIC, dilation=7.0)

    def triaxial(a: float, sign: int) -> tuple[float, float]:
        below = np.sqrt(3) * (3 + sign * np.sin(a))
        return 6 * np.sin(a) / below, 6 * np.cos(a) / below

    def plane(a: float) -> tuple[float, float]:
        below = np.sqrt(9 + 12 * np.tan(a) ** 2)
        return 3 * np.tan(a) / below, 3 / below

    etabar = 3 * np.sin(psi) / np.sqrt(9 + 3 * np.sin(psi) ** 2)
    d = np.sqrt(1 - etabar**2 / 3) + etabar * np.sin(phi) / 3
    expected = {
        "outer": (*triaxial(phi, -1), triaxial(psi, -1)[0]),
        "inner": (*triaxial(phi, 1), triaxial(psi, 1)[0]),
        "plane_strain_associated": (*plane(phi), plane(psi)[0]),
        "plane_strain": (np.sin(phi) / d, np.cos(phi) / d, etabar),
    }
    for name, coefficients in expected.items():
        assert cone(replace(soil, cone=name)) == pytest.approx(coefficients, rel=1e-13)


@pytest.mark.parametrize("name", CONES)
@pytest.mark.parametrize("cutoff", [np.inf, 500.0])
def test_return_ends_on_or_inside_the_surface(name: str, cutoff: float) -> None:
    soil = replace(PLASTIC, cone=name, dilation=5.0, tension_cutoff=cutoff)
    eta, xi, _ = cone(soil)
    limit = tension_limit(soil)
    trial = np.concatenate([random_stress(4, 3e2), random_stress(5, 3e3)])
    stress, plastic_strain = return_mapping(soil, trial)
    p, _, q = invariants(stress)
    before_p, _, before_q = invariants(trial)
    f = q + eta * p - xi * 1e3
    yielded = before_q + eta * before_p > xi * 1e3
    assert yielded.sum() > 50 and (p > 0.999 * limit).sum() > 20 and (~yielded).sum() > 20
    assert f.max() < 1e-8 and p.max() < limit + 1e-8
    np.testing.assert_allclose(np.maximum(f, p - limit)[yielded], 0, atol=1e-8)
    inside = ~yielded & (before_p <= limit)
    np.testing.assert_array_equal(stress[inside], trial[inside])
    assert np.all(plastic_strain[inside] == 0) and np.all(plastic_strain >= 0)
    again, more = return_mapping(soil, stress)
    np.testing.assert_allclose(again, stress, atol=1e-8)
    np.testing.assert_allclose(more, 0, atol=1e-14)


@pytest.mark.parametrize("name", CONES)
@pytest.mark.parametrize("cutoff", [np.inf, 500.0])
def test_associated_return_is_the_closest_point_in_energy(name: str, cutoff: float) -> None:
    soil = replace(PLASTIC, cone=name, dilation=22.0, tension_cutoff=cutoff)
    _, shear, bulk = moduli(soil)
    trial = random_stress(5, 3e3, 150)
    stress, _ = return_mapping(soil, trial)
    p, s, _ = invariants(trial - stress)
    plastic = s / (2 * shear) + p[:, None, None] * np.eye(3) / (3 * bulk)
    admissible, _ = return_mapping(soil, random_stress(6, 2e3, 200))
    work = np.einsum("pij,apij->ap", plastic, admissible[:, None] - stress[None])
    assert work.max() < 1e-9


def test_equivalent_plastic_strain_is_that_of_the_deviatoric_plastic_strain() -> None:
    trial = random_stress(7, 3e3)
    stress, plastic_strain = return_mapping(PLASTIC, trial)
    _, shear, _ = moduli(PLASTIC)
    deviatoric = (invariants(trial)[1] - invariants(stress)[1]) / (2 * shear)
    expected = np.sqrt(2 / 3 * np.sum(deviatoric**2, axis=(1, 2)))
    np.testing.assert_allclose(plastic_strain, expected, atol=1e-15)


def test_plane_strain_failure_is_mohr_coulomb() -> None:
    """Shearing at the angle of dilation ends where the in-plane stresses meet Mohr-Coulomb."""
    for name, dilation in (("plane_strain_associated", 22.0), ("plane_strain", 0.0)):
        soil = replace(PLASTIC, cone=name, dilation=dilation)
        opening = np.sin(np.radians(dilation))
        rate = np.diag([opening + 1, opening - 1, 0])[None]
        stress = -1e5 * np.eye(3)[None]
        for _ in range(3000):
            stress, _ = return_mapping(soil, stress + elastic_increment(soil, 1e-5 * rate))
        high, low = stress[0, 0, 0], stress[0, 1, 1]
        phi = np.radians(22)
        strength = 2e3 * np.cos(phi) - (high + low) * np.sin(phi)
        assert high - low == pytest.approx(strength, rel=1e-6)


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


def runs_into_an_ellipse(seed: int, friction: float, heaviest: float) -> Interface:
    """Soil that runs at random into an ellipse of mass 1, in nodes of at most the `heaviest`."""
    random = np.random.default_rng(seed)
    count, axes = random.integers(2, 9), np.array([1.0, 0.5])
    turn = random.uniform(0, 2 * np.pi, count)
    place = axes * np.column_stack([np.cos(turn), np.sin(turn)])
    normal = place / axes**2
    normal /= np.hypot(*normal.T)[:, None]
    body: Any = SimpleNamespace(
        centre=np.zeros(2), mass=1.0, inertia=axes @ axes / 4, friction=friction
    )
    whole: Any = SimpleNamespace(velocity=np.zeros(2), spin=0.0)
    mass, free = random.uniform(0.02, heaviest, count), random.standard_normal((count, 2))
    return Interface(body, whole, place, normal, np.full(count, APART), mass, free)


@pytest.mark.parametrize(
    ("friction", "heaviest", "seeds"),
    [
        (0.1, 0.5, (31, 124, 126, 142, 260)),  # soil turns about on its way to where it settles
        (0.1, 0.5, (112, 374, 453, 595, 655, 1945, 2078)),  # whole steps of Newton's method cycle
        (0.7, 3.0, (93, 344, 686, 834)),  # no part of such a step is better: in turn
        (0.7, 3.0, range(200)),
    ],
)
def test_soil_meets_a_stone_by_the_law_of_coulomb(
    friction: float, heaviest: float, seeds: Sequence[int]
) -> None:
    """None runs into it or is pulled; friction is enough for what sticks, and the most it can be,
    against the slip, where soil slips; no energy is gained."""
    for seed in seeds:
        found = runs_into_an_ellipse(seed, friction, heaviest)
        assert found.unsettled == 0.0
        motion = np.append(found.whole.velocity, found.whole.spin)
        across = quarter_turn(found.normal)
        left = found.velocity() - found.motion_at @ motion
        out, slip = (np.sum(left * of, axis=1) for of in (found.normal, across))
        pushed, rubbed = (np.sum(found.taken * of, axis=1) for of in (found.normal, across))
        assert out.min() > -1e-9 and pushed.min() > -1e-9
        assert np.abs(out * pushed).max() < 1e-9
        assert (np.abs(rubbed) - friction * pushed).max() < 1e-9
        slips = np.abs(slip) > 1e-9
        most = -np.sign(slip) * friction * pushed
        np.testing.assert_allclose(rubbed[slips], most[slips], atol=1e-9)
        energy = found.mass @ (found.velocity() ** 2).sum(axis=1) + motion @ found.inertia @ motion
        assert energy < found.mass @ (found.free**2).sum(axis=1) * (1 + 1e-12)


def test_soil_on_the_verge_of_slipping_takes_all_its_friction() -> None:
    """Rounding may find that it neither sticks nor slips; its impulse is the same either way."""
    random, friction = np.random.default_rng(3), 0.7
    stone = runs_into_an_ellipse(0, friction, 1.0)
    for rubbing in np.where(random.random(1000) < 0.5, friction, -friction):
        arm = random.standard_normal(2)
        yields = random.uniform(1.0, 9.0) * np.eye(2) + np.outer(arm, arm)
        impulse = np.array([1.0, rubbing])
        apart = -yields @ impulse
        if apart[0] < 0:
            found, _, _ = stone._met(apart, yields)
            np.testing.assert_allclose(found, impulse, rtol=1e-11)
