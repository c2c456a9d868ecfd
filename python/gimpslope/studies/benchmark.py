"""The speed of the kernel on slope A, beside that of the same step as a plain loop."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from .. import _check, _core
from ..scene import Points, Scene
from ..solver import Solver
from . import reference

_REPEATS = 7
_SECONDS = 0.3  # of one repeat
_WARM_UP = 50  # steps
_MARGIN = 40  # cells that points of the plain loop may go beyond the slope


@dataclass(frozen=True)
class Measurement:
    """Speed of one scene: median and extremes over the repeats, in point-steps a second.

    `plain` is the speed of the plain loop on one thread, and `ratio` the median of the ratios of
    kernel to plain loop, measured in turn.
    """

    points: int
    threads: int
    ledger: bool
    instruction_set: str
    median: float
    slowest: float
    fastest: float
    plain: float
    ratio: float
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
    ledger: bool = False
    instruction_set: str = ""

    def __post_init__(self) -> None:
        _check.whole("points", self.points, 10)
        _check.whole("threads", self.threads, 1)
        _check.flag("ledger", self.ledger)

    def measure(self) -> Measurement:
        """Step the slope and time it."""
        scene = reference.soil_slope(cell=0.1 * (23_490 / self.points) ** 0.5)
        points = _displaced(scene.points, scene.spacing / 4)
        solver, plain = self._solver(scene, points), self._plain(scene, points)
        steps, plain_steps = _steps(solver.advance), _steps(plain.advance)
        pairs = [
            (_rate(solver.advance, steps), _rate(plain.advance, plain_steps))
            for _ in range(_REPEATS)
        ]
        rates = [len(points) * fast for fast, _ in pairs]
        return Measurement(
            points=len(points),
            threads=solver.threads,
            ledger=self.ledger,
            instruction_set=solver.instruction_set,
            median=statistics.median(rates),
            slowest=min(rates),
            fastest=max(rates),
            plain=len(points) * statistics.median(slow for _, slow in pairs),
            ratio=statistics.median(fast / slow for fast, slow in pairs),
            bytes_per_point=solver.bytes / len(points),
        )

    def _solver(self, scene: Scene, points: Points) -> Solver:
        return Solver(
            points,
            scene.materials,
            cell=scene.cell,
            walls=scene.walls,
            wall_positions=scene.wall_positions,
            gravity=(0.0, -scene.gravity),
            method=reference.method(threads=self.threads, ledger=self.ledger),
            instruction_set=self.instruction_set,
        )

    def _plain(self, scene: Scene, points: Points) -> _core.Plain:
        method = reference.method(ledger=False)
        return _core.Plain(
            points.position,
            np.zeros_like(points.position),
            points.half_length,
            points.mass,
            points.volume,
            points.material,
            [material.to_core() for material in scene.materials],
            cell=scene.cell,
            origin=scene.origin,
            walls=scene.walls.to_core(scene.wall_positions),
            blend=method.blend,
            time_step=method.step,
            gravity=(0.0, -scene.gravity),
            margin=_MARGIN,
            instruction_set=self.instruction_set,
        )


def table(measurements: list[Measurement]) -> str:
    """The measurements in lines of text."""
    head = "  points  threads  ledger  instructions  M point-steps/s  (slowest ... fastest)"
    lines = [f"{head}  plain loop  ratio  bytes/point"]
    for m in measurements:
        spread = f"({m.slowest / 1e6:.1f} ... {m.fastest / 1e6:.1f})"
        lines.append(
            f"{m.points:8,}  {m.threads:7}  {'on' if m.ledger else 'off':>6}"
            f"  {m.instruction_set:>12}  {m.median / 1e6:15.1f}"
            f"  {spread:>21}  {m.plain / 1e6:10.1f}  {m.ratio:5.2f}  {m.bytes_per_point:11.0f}"
        )
    return "\n".join(lines)


def _displaced(points: Points, distance: float) -> Points:
    random = np.random.default_rng(seed=1)
    shift = random.uniform(-distance, distance, points.position.shape)
    return replace(points, position=np.maximum(points.position + shift, 1e-3 * distance))


def _steps(advance: Callable[[int], None]) -> int:
    """Steps for one repeat, after some to warm up."""
    advance(_WARM_UP)
    return max(1, round(_SECONDS * _rate(advance, _WARM_UP)))


def _rate(advance: Callable[[int], None], steps: int) -> float:
    """Steps a second."""
    start = time.perf_counter()
    advance(steps)
    return steps / (time.perf_counter() - start)
