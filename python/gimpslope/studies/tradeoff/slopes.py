"""Slope A of the study, and a small slope with a stone whose full model can be taken to a limit."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from ...analysis import smooth_peak
from ...materials import DruckerPrager
from ...method import Method
from ...outline import Outline
from ...recorder import Recorder
from ...scene import Scene
from ...setup import Setup
from ...simulation import Simulation
from ...stages import Slide, Stages
from ...stones import Ellipse
from .. import reference
from ..stopwatch import Stopwatch

READING = "identified"
SHARE = 1 / 3
"""Of the small slope in slope A: lengths and cohesion; times scale by its root."""

SMALL = Outline.slope(height=9 * SHARE, crest=2 * SHARE, angle=45)
STONE = Ellipse((0.7, 2.2), (0.6, 0.6))
VISCOSITY = reference.READINGS[READING].viscosity * SHARE**1.5  # m2/s
DURATIONS = {"a": 10.0, "stone": 1.2}  # s


class Figures(NamedTuple):
    """What a slide is judged by: peak of the kinetic energy (J/m), its time (s), and the largest
    displacement in the end (m), of slope A the vertical one. NaN for a peak that is not reached."""

    energy: float
    time: float
    displacement: float


class Slid(NamedTuple):
    """A slide and its cost, loading and settling included."""

    figures: Figures
    core_seconds: float


def slope_a(cell: float, method: Method) -> Slid:
    """Slope A, as identified."""
    scene = reference.slope(reading=READING, cell=cell)
    return _slide(Setup(scene, method, Stages(slide=Slide(DURATIONS["a"]))), vertical=True)


def with_stone(cell: float, method: Method, model: str) -> Slid:
    """The small slope, its stone in one of `reference.STONE_MODELS`."""
    soil = DruckerPrager(
        density=1800,
        young=30e6,
        poisson=0.33,
        friction=22,
        cohesion=1e3 * SHARE,
        cone=reference.READINGS[READING].cone,
    )
    scene = Scene(
        SMALL,
        soil,
        stones=[STONE],
        stone=reference.rock(READING, model),
        cell=cell,
        walls=reference.READINGS[READING].walls,
    )
    return _slide(Setup(scene, method, Stages(slide=Slide(DURATIONS["stone"]))), vertical=False)


def off(figures: Figures, known: Figures) -> float:
    """Root of the mean square of the three errors, each as a part of the known value."""
    errors = (found / true - 1 for found, true in zip(figures, known, strict=True))
    return math.sqrt(sum(error**2 for error in errors) / len(known))


def known_to(limit: Figures, uncertainty: Figures) -> float:
    """Uncertainty of limits, told as `off` tells errors."""
    return off(Figures(*map(sum, zip(limit, uncertainty, strict=True))), limit)


def _slide(setup: Setup, *, vertical: bool) -> Slid:
    simulation, watch = Simulation(setup), Stopwatch()
    with TemporaryDirectory() as folder:
        recorder = Recorder(simulation, Path(folder) / "slope.h5", progress=False)
        with watch:
            run = simulation.run(recorder)
        peak, moved = smooth_peak(run.energy), run.max_displacement()
    far = moved.vertical if vertical else moved.total
    energy, time = (math.nan, math.nan) if peak is None else (peak.kinetic, peak.time)
    return Slid(Figures(energy, time, far), watch.core_seconds)
