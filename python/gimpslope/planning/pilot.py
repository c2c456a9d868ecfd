"""A run on one grid, and what a plan takes from it."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..run import Run
from ..setup import Setup
from .quantities import need_rest, peak_values, state_values

_DIGITS = 6


@dataclass(frozen=True)
class Pilot:
    """A finished run on one grid.

    Attributes
    ----------
    cell : m
    points, steps : their number; steps of all stages
    loading_steps : those before the slide
    seconds, stepping : wall time of the whole of it, and of its steps alone, s
    reached : end of its slide, s
    values : the wanted quantities by name, SI units, at its end; NaN for what it has not reached
    history : those that need the slope at rest, at times of the slide (s)
    run : its run file
    """

    cell: float
    points: int
    steps: int
    loading_steps: int
    seconds: float
    stepping: float
    reached: float
    values: dict[str, float]
    history: dict[float, dict[str, float]]
    run: Run


def fly(setup: Setup, path: Path, names: Sequence[str], *, overwrite: bool = True) -> Pilot:
    """Run a setup and measure it; raises as `simulate` does."""
    start = clock.perf_counter()
    run = setup.simulate(path, overwrite=overwrite, progress=False)
    spent = clock.perf_counter() - start
    steps, energy = int(run.summary["steps"] or 0), run.energy
    return Pilot(
        cell=setup.scene.cell,
        points=len(run.points),
        steps=steps,
        loading_steps=steps - int(energy.step[-1]),
        seconds=spent,
        stepping=run.attributes["timing"]["wall_seconds"],
        reached=float(energy.time[-1]),
        values=peak_values(run, names) | state_values(run.final, names),
        history=_history(run, names),
        run=run,
    )


def _history(run: Run, names: Sequence[str]) -> dict[float, dict[str, float]]:
    if not need_rest(names):
        return {}
    moving = [state for state in run.snapshots() if state.time > run.energy.peak.time]
    return {round(state.time, _DIGITS): state_values(state, names) for state in moving}


def change(one: Pilot, other: Pilot) -> dict[str, float]:
    """By how much each value differs from that of another run, as a share of the latter."""
    return {
        name: abs(value / other.values[name] - 1) if other.values[name] else np.inf
        for name, value in one.values.items()
    }
