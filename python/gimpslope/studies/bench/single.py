"""How far single precision is from double: both slide on from one state of slope A."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..._check import FloatArray
from ...method import Precision
from ...solver import Solver
from .cases import Case, Slope

STEPS = 2000
"""In double to the common state, and again in each precision from there."""


@dataclass(frozen=True)
class SingleError:
    """Relative differences of single from double precision after `steps` steps of the slide: of
    the kinetic energy, and of the largest and the median displacement in these steps."""

    points: int
    steps: int
    kinetic: float
    largest: float
    median: float


def compare(case: Case) -> SingleError:
    """Slide a slope of the size and threads of a case in both precisions."""
    slope = case.slope()
    start = replace(case.standard, precision="double").solver()
    start.advance(STEPS)
    (kinetic, moved), (single_kinetic, single_moved) = [
        _slide(_continued(case, slope, start, precision)) for precision in ("double", "single")
    ]
    return SingleError(
        points=len(start),
        steps=STEPS,
        kinetic=_difference(single_kinetic, kinetic),
        largest=_difference(single_moved.max(), moved.max()),
        median=_difference(np.median(single_moved), np.median(moved)),
    )


def _continued(case: Case, slope: Slope, start: Solver, precision: Precision) -> Solver:
    """A solver with the state of another, at a fixed step, so that both end at one time."""
    method = replace(case.standard, precision=precision).method()
    solver = Solver(
        replace(slope.points, position=start.position),
        slope.materials,
        cell=slope.scene.cell,
        walls=slope.scene.walls,
        wall_positions=slope.scene.wall_positions,
        velocity=start.velocity,
        stress=start.stress,
        gravity=(0.0, -slope.scene.gravity),
        method=replace(method, courant=None, time_step=start.time_step),
    )
    solver.volume, solver.plastic_strain = start.volume, start.plastic_strain
    return solver


def _slide(solver: Solver) -> tuple[float, FloatArray]:
    """Kinetic energy, J/m, and displacement of each point, m, after the steps."""
    before = solver.position
    solver.advance(STEPS)
    moved: FloatArray = np.linalg.norm(solver.position - before, axis=1)
    return solver.energies().kinetic, moved


def _difference(value: float, expected: float) -> float:
    return abs(float(value) / float(expected) - 1.0)
