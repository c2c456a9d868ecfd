"""The speed of the kernel on slope A."""

from __future__ import annotations

import statistics
import time
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from .. import _check
from ..scene import Points
from ..solver import Solver
from . import reference

_REPEATS = 7
_SECONDS = 0.5  # of one repeat
_WARM_UP = 100  # steps


@dataclass(frozen=True)
class Measurement:
    """Speed of one scene: median and extremes over the repeats, in point-steps a second."""

    points: int
    threads: int
    instruction_set: str
    median: float
    slowest: float
    fastest: float
    bytes_per_point: float

    def to_dict(self) -> dict[str, Any]:
        """The fields by name."""
        return asdict(self)


@dataclass(frozen=True)
class Case:
    """Slope A, let go from rest under full gravity, as it is measured.

    The cell is chosen for about the given number of `points` (23,490 at 0.1 m), and the points are
    displaced by up to a quarter of their spacing: a regular lattice flatters the memory.
    """

    points: int = 23_490
    threads: int = 1
    instruction_set: str = ""

    def __post_init__(self) -> None:
        _check.whole("points", self.points, 10)
        _check.whole("threads", self.threads, 1)

    def measure(self) -> Measurement:
        """Step the slope and time it."""
        cell = 0.1 * (23_490 / self.points) ** 0.5
        scene = reference.soil_slope(cell=cell)
        solver = Solver(
            _displaced(scene.points, scene.spacing / 4),
            scene.materials,
            cell=cell,
            walls=scene.walls,
            wall_positions=scene.wall_positions,
            gravity=(0.0, -scene.gravity),
            method=reference.method(threads=self.threads, ledger=False),
            instruction_set=self.instruction_set,
        )
        solver.advance(_WARM_UP)
        steps = max(1, round(_SECONDS * _WARM_UP / _timed(solver, _WARM_UP)))
        rates = [len(solver) * steps / _timed(solver, steps) for _ in range(_REPEATS)]
        return Measurement(
            points=len(solver),
            threads=solver.threads,
            instruction_set=solver.instruction_set,
            median=statistics.median(rates),
            slowest=min(rates),
            fastest=max(rates),
            bytes_per_point=solver.bytes / len(solver),
        )


def table(measurements: list[Measurement]) -> str:
    """The measurements in lines of text."""
    lines = ["  points  threads  instructions  M point-steps/s  (slowest ... fastest)  bytes/point"]
    for m in measurements:
        lines.append(
            f"{m.points:8,}  {m.threads:7}  {m.instruction_set:>12}  {m.median / 1e6:15.1f}"
            f"  ({m.slowest / 1e6:.1f} ... {m.fastest / 1e6:.1f}){m.bytes_per_point:19.0f}"
        )
    return "\n".join(lines)


def _displaced(points: Points, distance: float) -> Points:
    random = np.random.default_rng(seed=1)
    shift = random.uniform(-distance, distance, points.position.shape)
    return replace(points, position=np.maximum(points.position + shift, 1e-3 * distance))


def _timed(solver: Solver, steps: int) -> float:
    start = time.perf_counter()
    solver.advance(steps)
    return time.perf_counter() - start
