"""Rigid stones that soil slides along: an incline that deforms, lifting, pressing and turning."""

from __future__ import annotations

import numpy as np
import pytest
from rigid_scene import CELL, SPACING, G, bodies, disk, points, rectangle

import gimpslope as gs
from gimpslope._check import FloatArray

DENSITY = 2600.0
PLATE = gs.Elastic(2000.0, 5e6, 0.3)
WIDTH, DEPTH = 2.4, 0.4


def on_plate(friction: float | None, shift: float = 0.0) -> gs.Solver:
    """A block of 0.6 x 0.4 m at rest on an elastic plate, which carries it and what it weighs."""
    plate = rectangle(WIDTH, DEPTH, SPACING)
    block = rectangle(0.6, 0.4, SPACING) + np.array([0.6 + shift, DEPTH])
    solver = gs.Solver(
        points(SPACING, (plate, PLATE.density, 0, -1), (block, DENSITY, 1, 0)),
        [PLATE, gs.Rigid(DENSITY, friction)],
        cell=CELL,
        walls=gs.Walls(gs.Roller(), gs.Roller(), gs.Fixed(), gs.Free()),
        wall_positions=(0.0, WIDTH, 0.0, 2.0),
        gravity=(0.0, -G),
        method=gs.Method(alpha=0.01, courant=0.4, ledger=True),
    )
    solver.set_damping(local=0.3)
    solver.advance_to(0.4)
    solver.set_damping()
    solver.reset_clock()
    return solver


def tilted(friction: float, degrees: float, shift: float = 0.0) -> tuple[float, float, gs.Solver]:
    """Acceleration of the block from 0.1 s on, m/s2, and how far it goes, m, once the gravity is
    tilted."""
    solver = on_plate(friction, shift)
    start = bodies(solver).centre[0, 0]
    slope = np.radians(degrees)
    solver.set_gravity(G * np.sin(slope), -G * np.cos(slope))
    times, speed = np.linspace(0.1, 0.4, 7), []
    for time in times:
        solver.advance_to(time)
        speed.append(bodies(solver).velocity[0, 0])
    went = float(bodies(solver).centre[0, 0] - start)
    return float(np.polyfit(times, speed, 1)[0]), went, solver


@pytest.mark.parametrize("shift", [0.0, 0.04])
@pytest.mark.parametrize(("friction", "degrees"), [(20.0, 30.0), (20.0, 25.0), (0.0, 10.0)])
def test_block_slides_down_a_plate_that_deforms(
    friction: float, degrees: float, shift: float
) -> None:
    """With g (sin - mu cos) where the slope is steeper than the friction. What is off, up to 2 %,
    is the swing of the plate, which takes its own part of the tilted gravity at once."""
    found, _, solver = tilted(friction, degrees, shift)
    slope = np.radians(degrees)
    expected = G * (np.sin(slope) - np.tan(np.radians(friction)) * np.cos(slope))
    assert found == pytest.approx(expected, rel=0.03)
    if friction:
        assert solver.ledger.friction > 20 * abs(solver.ledger.rigidity)


@pytest.mark.parametrize("shift", [0.0, 0.04])
def test_block_sticks_to_a_plate_that_is_rough_enough(shift: float) -> None:
    """It goes no farther than the plate shears: some 1e-3 m, where it would slide 0.08 m."""
    found, went, _ = tilted(20.0, 15.0, shift)
    assert abs(found) < 0.01 * G
    assert abs(went) < 0.03 * CELL
    _, went, _ = tilted(10.0, 15.0, shift)
    assert went > 0.3 * CELL


def pulls_on_the_way_up(friction: float | None) -> FloatArray:
    """Vertical impulses of the plate on the block in each of 40 ms in which it is lifted with
    twice its weight, in those of its weight."""
    solver = on_plate(friction)
    block = solver.material == 1
    solver.body_force = np.where(block[:, None], [0.0, 2 * G], 0.0)
    start = bodies(solver).impulse[0, 1]
    found = [start]
    for time in np.arange(1, 41) * 1e-3:
        solver.advance_to(time)
        lifting = 2 * solver.mass[block].sum() * G * time
        found.append(bodies(solver).impulse[0, 1] - lifting)
    return np.diff(found) / (solver.mass[block].sum() * G * 1e-3)


def test_lifted_block_leaves_without_a_pull() -> None:
    """The plate springs back and pushes it for some milliseconds, and then nothing; soil that
    sticks pulls it down with more than its weight."""
    free, sticking = pulls_on_the_way_up(20.0), pulls_on_the_way_up(None)
    assert free[0] > 0.5
    assert free.min() > -1e-9
    assert np.abs(free[20:]).max() < 1e-9
    assert sticking.min() < -1.0


def gap_at_first_touch(friction: float | None) -> float:
    """Of a block that nears the plate at 1 m/s without gravity, in cells."""
    plate = rectangle(1.2, DEPTH, SPACING)
    block = rectangle(0.6, 0.4, SPACING) + np.array([0.33, DEPTH + 2 * CELL])
    given = points(SPACING, (plate, PLATE.density, 0, -1), (block, DENSITY, 1, 0))
    solver = gs.Solver(
        given,
        [PLATE, gs.Rigid(DENSITY, friction)],
        cell=CELL,
        velocity=np.where((given.stone == 0)[:, None], [0.0, -1.0], 0.0),
        walls=gs.Walls(gs.Roller(), gs.Roller(), gs.Fixed(), gs.Free()),
        wall_positions=(0.0, 1.2, 0.0, 2.0),
        method=gs.Method(alpha=0.0, courant=0.4),
    )
    while bodies(solver).impulse[0, 1] == 0.0:
        solver.step()
    return float((bodies(solver).centre[0, 1] - 0.2 - DEPTH) / CELL)


def test_stone_touches_soil_where_it_meets_it() -> None:
    """Within the tenth of a cell that the edges are known to; soil that sticks is met more than
    half a cell before."""
    assert 0.0 < gap_at_first_touch(20.0) < 0.11
    assert gap_at_first_touch(None) > 0.5


def test_smooth_disk_does_not_turn_with_the_soil_around_it() -> None:
    """A disk of soil turns about a rigid disk in its middle. Friction takes that along, more or
    less; a smooth stone stays as it is but for the corners of its points."""
    ground = disk(0.6, SPACING)
    inside = np.hypot(*ground.T) < 0.25
    spins = []
    for friction in (None, 30.0, 0.0):
        given = points(SPACING, (ground[~inside], 2000.0, 0, -1), (ground[inside], DENSITY, 1, 0))
        arm = np.column_stack([-given.position[:, 1], given.position[:, 0]])
        wheel = gs.Solver(
            given,
            [PLATE, gs.Rigid(DENSITY, friction)],
            cell=CELL,
            velocity=np.where((given.stone < 0)[:, None], arm, 0.0),
            method=gs.Method(alpha=0.0, courant=0.4),
        )
        wheel.advance_to(0.1)
        spins.append(float(bodies(wheel).spin[0]))
    assert spins[0] > 0.5
    assert abs(spins[2]) < 0.1 * spins[0]
