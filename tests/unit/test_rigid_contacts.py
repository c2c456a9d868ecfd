"""Rigid stones that touch walls, and each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from rigid_scene import (
    CELL,
    ROCK,
    SPACING,
    SQUARE_OF_A_POINT,
    G,
    angular_momentum,
    bodies,
    disk,
    momentum,
    points,
    rectangle,
)

import gimpslope as gs
from gimpslope._check import FloatArray

# On walls


def on_incline(
    place: FloatArray, slope: float, friction: float, dt: float, spacing: float = SPACING
) -> gs.Solver:
    """A rigid body on a floor of Coulomb friction, in gravity tilted by `slope`, radians."""
    return gs.Solver(
        points(spacing, (place, ROCK.density, 0, 0)),
        [ROCK],
        cell=2 * spacing,
        walls=gs.Walls(gs.Free(), gs.Free(), gs.Coulomb(friction), gs.Free()),
        wall_positions=(-1.0, 9.0, 0.0, 9.0),
        gravity=(G * np.sin(slope), -G * np.cos(slope)),
        method=gs.Method(alpha=0.01, time_step=dt),
    )


def test_block_slides_down_an_incline() -> None:
    """g (sin - mu cos), from the first step: a low and wide block, which does not tip."""
    slope, friction = np.radians(30.0), 0.3
    sliding_block = on_incline(rectangle(0.8, 0.4, SPACING), slope, friction, 1e-3)
    sliding_block.advance_to(0.5)
    after = bodies(sliding_block)
    expected = G * (np.sin(slope) - friction * np.cos(slope))
    assert after.velocity[0, 0] / sliding_block.time == pytest.approx(expected, rel=1e-3)
    assert abs(after.velocity[0, 1]) < 1e-9
    assert abs(after.angle[0]) < 1e-9


@pytest.mark.parametrize("degrees", [10.0, 30.0, 38.0])
def test_block_sticks_where_the_friction_is_enough(degrees: float) -> None:
    """tan < mu = 0.8, which is 38.7 degrees: it does not creep."""
    stuck = on_incline(rectangle(0.8, 0.4, SPACING), np.radians(degrees), 0.8, 1e-3)
    start = bodies(stuck).centre
    stuck.advance_to(0.5)
    np.testing.assert_allclose(bodies(stuck).centre, start, atol=1e-12)


def test_block_stays_on_the_floor() -> None:
    resting = on_incline(rectangle(0.8, 0.4, SPACING), 0.0, 0.5, 1e-3)
    start = bodies(resting).centre
    resting.advance_to(1.0)
    np.testing.assert_allclose(bodies(resting).centre, start, atol=1e-12)


@pytest.mark.parametrize(
    ("degrees", "stands"),
    [(20.0, True), (23.0, True), (26.0, True), (27.2, False)],
)
def test_tower_tips_where_its_weight_leaves_its_base(degrees: float, stands: bool) -> None:
    """Twice as high as wide it stands up to arctan 1/2 = 26.6 degrees, and falls beyond. (While it
    stands, what the sweeps over contacts leave turns it by 2e-5 in half a second.)"""
    leaning = on_incline(rectangle(0.4, 0.8, SPACING), np.radians(degrees), 3.0, 1e-3)
    leaning.advance_to(0.5)
    turned = -bodies(leaning).angle[0]
    assert abs(turned) < 5e-5 if stands else turned > 0.01


def test_disk_rolls_down_a_rough_incline() -> None:
    """It rolls and does not slip: spin times radius is its speed. A solid disk rolls with
    g sin / (1 + I / (m R^2)) = 2/3 g sin; this one has the corners of its points, and rolls
    on them with 92 % of that (measured) and 99 % of the spin."""
    radius, slope = 0.6, np.radians(40.0)
    wheel = disk(radius, SPACING / 2, (0.0, radius))
    rolling = on_incline(wheel, slope, 1.5, 5e-4, SPACING / 2)
    rolling.advance_to(0.5)
    after = bodies(rolling)
    speed = after.velocity[0, 0]
    inertia = np.sum((wheel - wheel.mean(axis=0)) ** 2) / len(wheel)
    ideal = G * np.sin(slope) / (1 + inertia / radius**2)
    assert 1 + inertia / radius**2 == pytest.approx(1.5, rel=0.01)
    assert -after.spin[0] * radius == pytest.approx(speed, rel=0.03)
    assert 0.88 * ideal < speed / rolling.time < 1.02 * ideal


def test_block_that_starts_within_the_floor_is_not_thrown_off() -> None:
    """Five millimetres, which at a step of a millisecond are 5 m/s and a flight of 1.3 m."""
    sunk = on_incline(rectangle(0.4, 0.4, SPACING) - np.array([0.0, 0.005]), 0.0, 0.5, 1e-3)
    start = bodies(sunk).centre[0, 1]
    sunk.advance_to(0.2)
    assert bodies(sunk).centre[0, 1] - start < CELL


# Stones and stones


def flying(*parts: tuple[FloatArray, Any]) -> gs.Solver:
    """Rigid stones with their velocities, and nothing else."""
    given = points(SPACING, *[(part[0], ROCK.density, 0, k) for k, part in enumerate(parts)])
    velocity = np.array([part[1] for part in parts])[given.stone]
    method = gs.Method(alpha=0.0, time_step=1e-3, ledger=True)
    return gs.Solver(given, [ROCK], cell=CELL, velocity=velocity, method=method)


def turning_of(pair: gs.Solver) -> float:
    """Angular momentum about the origin of two stones of the same mass, with that of the squares of
    their points."""
    of_squares = pair.mass.sum() / 2 * SQUARE_OF_A_POINT
    return angular_momentum(pair) + of_squares * float(bodies(pair).spin.sum())


@pytest.mark.parametrize("aside", [0.0, 0.2])
def test_stones_that_meet_do_not_pass_through_each_other(aside: float) -> None:
    """Two disks at 2 m/s, head on and off the middle: momentum and angular momentum stay, they
    come no nearer than half a cell less than they are wide, and no energy is gained."""
    radius = 0.3
    pair = flying(
        (disk(radius, SPACING, (0.0, 0.0)), (2.0, 0.0)),
        (disk(radius, SPACING, (0.9, aside)), (-1.0, 0.0)),
    )
    before, turned, energy = momentum(pair), turning_of(pair), pair.energies().kinetic
    nearest = np.inf
    for _ in range(60):
        pair.advance(10)
        a, b = bodies(pair).centre
        nearest = min(nearest, float(np.hypot(*(a - b))))
    np.testing.assert_allclose(momentum(pair), before, atol=1e-12 * before[0])
    scale = pair.mass.sum() * 0.9
    assert abs(turning_of(pair) - turned) < 1e-10 * scale
    assert nearest > 2 * radius - 0.5 * CELL
    assert pair.energies().kinetic < 0.9 * energy
    assert pair.ledger.taken == pytest.approx(energy - pair.energies().kinetic, rel=1e-10)


def test_small_stones_that_meet_do_not_pass_through_each_other() -> None:
    """Disks of half a cell in radius, which fill half of a cell at most."""
    radius = 0.5 * CELL
    pair = flying(
        (disk(radius, SPACING, (0.01, 0.01)), (1.0, 0.0)),
        (disk(radius, SPACING, (0.51, 0.01)), (-1.0, 0.0)),
    )
    pair.advance(400)
    assert bodies(pair).centre[0, 0] < bodies(pair).centre[1, 0]


def pile(above: FloatArray, slope: float, friction: float | None) -> gs.Solver:
    """A block of 0.4 m that a rough floor holds, another stone on it, and gravity tilted by
    `slope`, radians."""
    rock = gs.Rigid(ROCK.density, mutual_friction=friction)
    return gs.Solver(
        points(
            SPACING,
            (rectangle(0.4, 0.4, SPACING), rock.density, 0, 0),
            (above, rock.density, 0, 1),
        ),
        [rock],
        cell=CELL,
        walls=gs.Walls(gs.Free(), gs.Free(), gs.Coulomb(2.0), gs.Free()),
        wall_positions=(-1.0, 9.0, 0.0, 9.0),
        gravity=(G * np.sin(slope), -G * np.cos(slope)),
        method=gs.Method(alpha=0.0, time_step=1e-3),
    )


@pytest.mark.parametrize("aside", [0.0, 0.1, 0.13])
def test_block_rests_on_a_block(aside: float) -> None:
    """Flat on flat without friction, with its centre above the other one: there is nothing to push
    it aside. (What the sweeps over contacts leave turns the lower one by 1e-5, and moves the upper
    one by 1.2e-3 of a cell.)"""
    resting = pile(rectangle(0.4, 0.4, SPACING) + np.array([aside, 0.4]), 0.0, None)
    start = bodies(resting).centre
    resting.advance_to(0.5)
    np.testing.assert_allclose(bodies(resting).centre, start, atol=2e-3 * CELL)


@pytest.mark.parametrize(("degrees", "friction"), [(15.0, None), (25.0, 15.0)])
def test_block_slides_down_a_block(degrees: float, friction: float | None) -> None:
    """With g (sin - mu cos), while its centre is above the other one."""
    slope = np.radians(degrees)
    sliding = pile(rectangle(0.4, 0.2, SPACING) + np.array([0.0, 0.4]), slope, friction)
    sliding.advance_to(0.25)
    grip = np.tan(np.radians(friction or 0.0))
    expected = G * (np.sin(slope) - grip * np.cos(slope))
    found = bodies(sliding)
    assert found.velocity[1, 0] / 0.25 == pytest.approx(expected, rel=1e-3)
    assert abs(found.velocity[0, 0]) < 1e-9


def test_block_sticks_to_a_block_that_is_rough_enough() -> None:
    """The smaller of two angles of friction counts, here 30 degrees on a slope of 20."""
    stuck = pile(rectangle(0.4, 0.2, SPACING) + np.array([0.0, 0.4]), np.radians(20.0), 30.0)
    start = bodies(stuck).centre
    stuck.advance_to(0.25)
    np.testing.assert_allclose(bodies(stuck).centre, start, atol=1e-3 * CELL)


def test_smaller_friction_of_two_stones_counts() -> None:
    """A block of 30 degrees slides on one without friction as if it had none itself."""
    slope = np.radians(20.0)
    rough = gs.Rigid(ROCK.density, mutual_friction=30.0)
    above = rectangle(0.4, 0.2, SPACING) + np.array([0.0, 0.4])
    sliding = gs.Solver(
        points(
            SPACING,
            (rectangle(0.4, 0.4, SPACING), ROCK.density, 0, 0),
            (above, rough.density, 1, 1),
        ),
        [ROCK, rough],
        cell=CELL,
        walls=gs.Walls(gs.Free(), gs.Free(), gs.Coulomb(2.0), gs.Free()),
        wall_positions=(-1.0, 9.0, 0.0, 9.0),
        gravity=(G * np.sin(slope), -G * np.cos(slope)),
        method=gs.Method(alpha=0.0, time_step=1e-3),
    )
    sliding.advance_to(0.2)
    assert bodies(sliding).velocity[1, 0] / 0.2 == pytest.approx(G * np.sin(slope), rel=1e-3)


def test_stones_that_pass_each_other_do_not_touch() -> None:
    """With half a cell between their edges they share nodes, and go on as if alone, to the bit."""
    left, right = rectangle(0.4, 0.4, SPACING), rectangle(0.4, 0.4, SPACING)
    right = right + np.array([0.6, 0.45])
    both = flying((left, (1.0, 0.0)), (right, (-1.0, 0.0)))
    each = flying((left, (1.0, 0.0))), flying((right, (-1.0, 0.0)))
    for solver in (both, *each):
        solver.advance(600)
    found = bodies(both)
    assert found.centre[0, 0] > found.centre[1, 0]
    for k, alone in enumerate(each):
        for name in ("centre", "angle", "velocity", "spin", "impulse", "angular_impulse"):
            np.testing.assert_array_equal(getattr(found, name)[k], getattr(bodies(alone), name)[0])
