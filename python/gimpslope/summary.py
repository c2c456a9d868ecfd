"""The main results of a run in a few numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .analysis import phases_of
from .energy import Energy
from .io import hdf5
from .scene import Scene
from .snapshot import MaxDisplacement
from .stones import Stones

if TYPE_CHECKING:
    from .run import Run

_READABLE = {
    "points": "{:,}",
    "steps": "{:,}",
    "steps_before_slide": "{:,}",
    "stones": "{:,}",
    "smallest_gap_in_cells": "{:.2f}",
    "peak_kinetic_energy": "{:,.0f} J/m",
    "time_of_peak": "{:.3f} s",
    "speed_at_peak": "{:.3f} m/s",
    "max_speed": "{:.3f} m/s",
    "final_kinetic_energy": "{:,.3g} J/m",
    "simulated_time": "{:.3f} s",
    "max_displacement_total": "{:.3f} m",
    "max_displacement_horizontal": "{:.3f} m",
    "max_displacement_vertical": "{:.3f} m",
    "toe": "{:.3f} m",
    "wall_seconds": "{:.1f} s",
    "point_steps_per_second": "{:,.0f} /s",
}
_AT_PEAK = ("time_of_peak", "speed_at_peak")


def summarise(run: Run) -> dict[str, float | int | None]:
    """The main results of a run from the data written so far, in SI units.

    Keys: points, steps (of all stages), steps_before_slide (of gravity and settling), stones,
    smallest_gap_in_cells (between two stones; those closer than two cells share nodes),
    peak_kinetic_energy (J/m, the largest so far), time_of_peak, speed_at_peak (of the fastest point
    then; both None while the kinetic energy still grows), max_speed, max_displacement_total,
    _horizontal and _vertical, toe (largest x of a point in the end), final_kinetic_energy (J/m),
    simulated_time (of the slide), wall_seconds (spent stepping) and point_steps_per_second. What
    the run has not reached, or not recorded, is None.
    """
    rows = hdf5.read_energy(run.path)
    return {
        "points": len(hdf5.read_points(run.path).get("mass", ())),
        "steps": _steps(rows["step"]),
        "steps_before_slide": _steps(rows["step"][rows["stage"] < hdf5.STAGES.index("slide")]),
        "stones": len(run.scene.stones),
        "smallest_gap_in_cells": smallest_gap(run.scene),
        **_energy_summary(run.energy),
        **_displacement_summary(run),
        **_speed_of_computing(run.attributes.get("timing")),
    }


def still_grows(summary: Mapping[str, float | int | None]) -> bool:
    """Whether the kinetic energy was largest in the end, so that it may have its peak to come."""
    return summary["peak_kinetic_energy"] is not None and summary["time_of_peak"] is None


def _steps(column: npt.NDArray[np.int64]) -> int:
    """All steps taken, given a count that starts again from zero whenever the clock does."""
    ends = np.append(column[:-1][np.diff(column) < 0], column[-1:])
    return int(ends.sum())


def smallest_gap(scene: Scene) -> float | None:
    """Between the two nearest stones, in cells; None without two."""
    gaps = Stones(scene.stones).gaps()
    return float(gaps.min()) / scene.cell if len(gaps) > 1 else None


def _energy_summary(energy: Energy) -> dict[str, float | None]:
    names = (
        "peak_kinetic_energy",
        "time_of_peak",
        "speed_at_peak",
        "max_speed",
        "final_kinetic_energy",
        "simulated_time",
    )
    if len(energy) == 0:
        return dict.fromkeys(names)
    peak = phases_of(energy).peak
    values = (
        energy.peak.value,
        peak,
        None if peak is None else energy.speed_at_peak,
        float(energy.max_speed.max()),
        float(energy.kinetic[-1]),
        float(energy.time[-1]),
    )
    return dict(zip(names, values, strict=True))


def _displacement_summary(run: Run) -> dict[str, float | None]:
    names = [f"max_displacement_{name}" for name in MaxDisplacement._fields] + ["toe"]
    if len(run.times) == 0:
        return dict.fromkeys(names)
    state = run.final
    values = (*state.max_displacement, float(state.position[:, 0].max()))
    return dict(zip(names, values, strict=True))


def _speed_of_computing(timing: dict[str, Any] | None) -> dict[str, float | None]:
    seconds = timing["wall_seconds"] if timing else None
    rate = timing["point_steps"] / seconds if timing and seconds else None
    return {"wall_seconds": seconds, "point_steps_per_second": rate}


def readable(summary: dict[str, float | int | None]) -> dict[str, str]:
    """The values as text, with their units."""
    absent = dict.fromkeys(_AT_PEAK, "still growing") if still_grows(summary) else {}
    return {
        name: absent.get(name, "not recorded") if value is None else _READABLE[name].format(value)
        for name, value in summary.items()
    }
