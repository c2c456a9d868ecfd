"""Impulses on rigid stones that are looked for by iteration: what is left of them is told."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from rigid_scene import CELL, ROCK, SPACING, G, points, rectangle

import gimpslope as gs
from gimpslope import method_warning

NOTHING = (0, 0.0, 0.0)
SOIL = gs.Elastic(2000.0, 5e6, 0.3)


def tower(count: int, threads: int = 1) -> gs.Solver:
    """Rigid blocks on each other and on a floor, which begin to fall. A sweep over their contacts
    stops the lowest that falls, so that the taller the tower is the more sweeps it takes."""
    blocks = [rectangle(0.2, 0.2, SPACING) + np.array([0.0, 0.2 * k]) for k in range(count)]
    return gs.Solver(
        points(SPACING, *((block, ROCK.density, 0, k) for k, block in enumerate(blocks))),
        [ROCK],
        cell=CELL,
        walls=gs.Walls(gs.Free(), gs.Free(), gs.Coulomb(0.5), gs.Free()),
        wall_positions=(-1.0, 2.0, 0.0, 0.2 * count + 1.0),
        gravity=(0.0, -G),
        method=gs.Method(alpha=0.0, time_step=1e-3, threads=threads),
    )


def in_soil(density: float, friction: float) -> gs.Solver:
    """A stone three quarters of a cell in radius amid soil that moves at random."""
    ground = rectangle(1.2, 1.2, SPACING)
    inside = np.hypot(*(ground - 0.6).T) < 0.15
    given = points(SPACING, (ground[~inside], SOIL.density, 0, -1), (ground[inside], density, 1, 0))
    return gs.Solver(
        given,
        [SOIL, gs.Rigid(density, friction)],
        cell=CELL,
        velocity=0.3 * np.random.default_rng(1).normal(size=(len(given.position), 2)),
        method=gs.Method(alpha=0.0, courant=0.4),
    )


def warnings_of(solver: gs.Solver) -> list[str]:
    scene = gs.Scene(gs.Outline.slope(2, 1), SOIL, cell=CELL)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        method_warning.warn_at_end(gs.Setup(scene), solver)
    return [str(one.message) for one in caught if "did not settle" in str(one.message)]


def test_a_few_stones_settle() -> None:
    few = tower(3)
    few.advance(50)
    assert few.unsettled == {"interfaces": NOTHING, "contacts": NOTHING}
    assert warnings_of(few) == []


def test_a_tall_tower_tells_how_far_its_stones_ran_into_each_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tall = tower(80)
    tall.advance(60)
    found = tall.unsettled["contacts"]
    assert found.steps == 60 and 0 < found.largest < found.sum <= 60 * found.largest
    overlaps = 0.2 - np.diff(tall.rigid_stones.centre[:, 1])
    assert found.sum == pytest.approx(overlaps.max(), rel=0.2)
    assert warnings_of(tall) == []
    monkeypatch.setattr(method_warning, "UNSETTLED", 0.9 * found.sum / CELL)
    (said,) = warnings_of(tall)
    assert said.startswith("in 60 of 60 steps the impulses where rigid stones touch did not settle")
    assert said.endswith("fewer stones on top of each other settle sooner")
    tall.reset_clock()
    assert tall.unsettled["contacts"] == NOTHING


def test_what_is_left_does_not_depend_on_threads() -> None:
    one, two = tower(40), tower(40, threads=2)
    for solver in (one, two):
        solver.advance(20)
    assert one.unsettled == two.unsettled and one.unsettled["contacts"].steps > 0


@pytest.mark.parametrize(
    ("density", "friction"), [(2600.0, 30.0), (100.0, 30.0), (10.0, 30.0), (1.0, 60.0), (1.0, 70.0)]
)
def test_soil_does_not_throw_a_light_stone(density: float, friction: float) -> None:
    """However much heavier the soil is at the nodes that it holds: no energy is gained."""
    solver = in_soil(density, friction)
    energy = solver.energies().kinetic
    solver.advance(40)
    assert solver.energies().kinetic < energy
    assert solver.unsettled["interfaces"] == NOTHING


def test_a_stone_lighter_than_air_takes_more_rounds_than_there_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    solver = in_soil(density=0.1, friction=70.0)
    energy = solver.energies().kinetic
    solver.advance(100)
    found = solver.unsettled["interfaces"]
    assert 0 < found.steps < 40 and 0 < found.largest <= found.sum < 1e-4 * CELL
    assert solver.energies().kinetic < energy
    monkeypatch.setattr(method_warning, "UNSETTLED", 0.9 * found.sum / CELL)
    (said,) = warnings_of(solver)
    assert said.endswith("heavier stones settle sooner")
