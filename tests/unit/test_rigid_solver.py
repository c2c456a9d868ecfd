"""Solvers with rigid stones: time steps, threads, and the state that is read and set."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_scene import sliding
from kernel_scene import solver as core_solver
from rigid_scene import (
    ANGLE_IRON,
    CELL,
    ROCK,
    SOIL,
    SPACING,
    G,
    bodies,
    disk,
    distances,
    moments,
    points,
    rectangle,
    thrown,
)

import gimpslope as gs
from gimpslope import _core
from gimpslope._check import FloatArray


def test_time_step_is_that_of_the_soil() -> None:
    """No wave runs in a rigid stone, however it is placed."""
    block, ball = rectangle(1.0, 1.0, SPACING), disk(0.2, SPACING, (0.5, 0.5))
    around = block[np.hypot(*(block - 0.5).T) >= 0.2]
    steps = []
    for parts in (
        [(around, SOIL.density, 0, -1)],
        [(around, SOIL.density, 0, -1), (ball, ROCK.density, 1, 0)],
    ):
        solver = gs.Solver(
            points(SPACING, *parts), [SOIL, ROCK], cell=CELL, method=gs.Method(courant=0.4)
        )
        steps.append((solver.time_step, solver.stable_time_step))
    assert steps[0] == steps[1]
    assert steps[0][1] == pytest.approx(CELL / SOIL.wave_speed, rel=1e-12)
    assert thrown(ANGLE_IRON, 0.0, 0.0).stable_time_step == np.inf


def stony(threads: int, steps: int, friction: float | None = None) -> _core.Solver:
    """A column of soil with sixteen rigid stones that spreads over a floor."""
    scene = sliding()
    x, y = scene["position"].T
    number = (x // 4 + 8 * (y // 4)).astype(np.int32)
    stone = np.where(scene["material"] == 1, number, -1)
    angles = {"interface_friction": friction, "mutual_friction": friction or 0.0}
    scene["materials"][1] = {"density": 2600.0, "law": "rigid"} | angles
    solver = core_solver(scene, stone=stone, threads=threads, ledger=True)
    solver.advance(steps)
    return solver


def state(solver: _core.Solver) -> dict[str, FloatArray]:
    fields = ("position", "velocity", "stress", "volume", "plastic_strain")
    return {name: solver.get(name) for name in fields} | {
        "bodies": solver.bodies(),
        "ledger": np.array([*solver.ledger().values()]),
    }


@pytest.fixture(scope="module")
def alone() -> dict[str, FloatArray]:
    return state(stony(1, 400))


@pytest.fixture(scope="module")
def sliding_alone() -> dict[str, FloatArray]:
    return state(stony(1, 400, 25.0))


@pytest.mark.parametrize("threads", [1, 2, 3, 4])
def test_any_number_of_threads_where_soil_slides(
    alone: dict[str, FloatArray], sliding_alone: dict[str, FloatArray], threads: int
) -> None:
    for name, found in state(stony(threads, 400, 25.0)).items():
        np.testing.assert_array_equal(found, sliding_alone[name], err_msg=name)
    assert np.abs(sliding_alone["bodies"] - alone["bodies"])[0, :, :2].max() > 0.1


@pytest.mark.parametrize("threads", [1, 2, 3, 4])
def test_any_number_of_threads(alone: dict[str, FloatArray], threads: int) -> None:
    """To the last bit, from run to run too: a stone sums over its points in their given order."""
    for name, found in state(stony(threads, 400)).items():
        np.testing.assert_array_equal(found, alone[name], err_msg=name)


def test_the_scene_for_threads_crosses_slabs_and_is_sorted(alone: dict[str, FloatArray]) -> None:
    """Points are sorted anew after 100 steps, or sooner when they have gone half a cell."""
    start, cell = sliding()["position"], sliding()["cell"]
    early = stony(1, 1)
    first = early.numbers().copy()
    early.advance(98)
    assert (early.numbers() != first).any()
    assert np.abs(alone["position"] - start).max(axis=0).min() > 4 * cell
    assert len(alone["bodies"][0]) == 16
    assert np.abs(alone["bodies"][0][:, 2]).max() > 0.5  # they turn
    assert (alone["plastic_strain"] > 0).mean() > 0.3


def two_stones(alpha: float = 0.01) -> gs.Solver:
    """Two rigid stones in soil, given in no order."""
    block = rectangle(1.0, 1.0, SPACING)
    stone = np.full(len(block), -1)
    stone[np.hypot(*(block - (0.3, 0.4)).T) < 0.15] = 4
    stone[np.abs(block - (0.7, 0.6)).max(axis=1) < 0.12] = 1
    order = np.random.default_rng(2).permutation(len(block))
    given = points(SPACING, (block, 2000.0, 0, -1))
    given = gs.Points(
        given.position[order],
        given.half_length,
        given.volume,
        np.where(stone[order] < 0, 2000.0, 2600.0) * given.volume,
        (stone[order] >= 0).astype(int),
        stone[order],
    )
    return gs.Solver(given, [SOIL, ROCK], cell=CELL, method=gs.Method(alpha=alpha, courant=0.4))


def test_courant_step_goes_by_the_velocities_that_are_set() -> None:
    solver = two_stones()
    solver.velocity = np.where(solver.material[:, None] == 1, [3.0, 0.0], 0.0)
    solver.advance(1)
    solver.velocity = np.zeros((len(solver), 2))
    wave = CELL / solver.stable_time_step
    assert solver.time_step == pytest.approx(0.4 * CELL / wave, rel=1e-3)


def test_stones_are_in_the_order_of_their_numbers() -> None:
    assert bodies(two_stones()).number.tolist() == [1, 4]
    np.testing.assert_allclose(bodies(two_stones()).centre, [(0.7, 0.6), (0.3, 0.4)], atol=1e-12)


def test_velocities_given_become_those_of_the_rigid_motion() -> None:
    """With the same momentum and angular momentum; those of soil stay as they are given."""
    solver = two_stones()
    solver.advance(20)
    given = np.random.default_rng(3).normal(size=(len(solver), 2))
    solver.velocity = given
    found, mass, place = bodies(solver), solver.mass, solver.position
    rigid = solver.material == 1
    np.testing.assert_array_equal(solver.velocity[~rigid], given[~rigid])
    left = rigid & (place[:, 0] < 0.5)  # number 4
    for k, of in enumerate((rigid & ~left, left)):
        arm, m = place[of] - found.centre[k], mass[of]
        np.testing.assert_allclose(found.velocity[k], m @ given[of] / m.sum(), rtol=1e-12)
        inertia = m @ np.sum(arm**2, axis=1)
        assert found.spin[k] == pytest.approx(m @ moments(arm, given[of]) / inertia, rel=1e-12)
        motion = found.velocity[k] + found.spin[k] * np.column_stack([-arm[:, 1], arm[:, 0]])
        np.testing.assert_allclose(solver.velocity[of], motion, atol=1e-12)


def test_positions_given_make_a_new_shape() -> None:
    """At angle zero, and kept from then on; momentum and angular momentum stay."""
    solver = two_stones()
    solver.velocity = np.random.default_rng(3).normal(size=(len(solver), 2))
    solver.advance(20)
    rigid = solver.material == 1
    of = rigid & (solver.position[:, 0] < 0.5)  # number 4
    assert np.abs(bodies(solver).angle).min() > 0
    place, velocity = solver.position, solver.velocity
    place[of] = place[of] @ np.array([[1.2, 0.1], [0.0, 0.9]]) + 0.01
    solver.position = place
    found = bodies(solver)
    assert (found.angle == 0).all()
    m = solver.mass[of]
    np.testing.assert_allclose(found.centre[1], m @ place[of] / m.sum(), rtol=1e-12)
    np.testing.assert_allclose(m @ solver.velocity[of], m @ velocity[of], rtol=1e-10)
    arm = place[of] - found.centre[1]
    turn = float(m @ moments(arm, velocity[of]))
    assert m @ moments(arm, solver.velocity[of]) == pytest.approx(turn, rel=1e-10)
    solver.advance(20)
    assert abs(bodies(solver).angle[1]) > 0
    after = distances(solver.position[of])
    np.testing.assert_allclose(after, distances(place[of]), atol=1e-13)


def test_what_is_set_to_itself_stays() -> None:
    solver = two_stones()
    solver.velocity = np.random.default_rng(3).normal(size=(len(solver), 2))
    before = bodies(solver)
    solver.velocity = solver.velocity
    solver.position = solver.position
    after = bodies(solver)
    for name in ("centre", "angle", "velocity", "spin"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), atol=1e-12)


def test_clock_and_impulses_start_anew() -> None:
    solver = two_stones()
    solver.set_gravity(0.0, -G)
    solver.velocity = np.random.default_rng(3).normal(size=(len(solver), 2))
    solver.advance(20)
    before = bodies(solver)
    assert np.abs(before.impulse).min() > 0
    solver.reset_clock()
    after = bodies(solver)
    assert (after.impulse == 0).all() and (after.angular_impulse == 0).all()
    for name in ("centre", "angle", "velocity", "spin"):
        np.testing.assert_array_equal(getattr(after, name), getattr(before, name))


def test_bytes_count_the_pairs_of_stones_that_are_near_each_other() -> None:
    """Of 200 stones of a point each, in a row or all but two of them in its middle."""
    count = 200
    row, heap = np.linspace(0.0, 100.0, count), 50.0 + 1e-4 * np.arange(count)
    heap[0], heap[-1] = row[0], row[-1]
    taken = []
    for x in (row, heap):
        place = np.column_stack([x, np.zeros(count)])
        stones = [(place[k : k + 1], ROCK.density, 0, k) for k in range(count)]
        given = points(SPACING, *stones)
        taken.append(gs.Solver(given, [ROCK], cell=CELL, method=gs.Method(time_step=1e-3)).bytes)
    assert taken[1] - taken[0] > 8 * (count - 2) * (count - 3) / 2
