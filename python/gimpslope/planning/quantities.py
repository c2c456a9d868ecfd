"""What a plan can be made for: results of a slide, by the names of a run's summary."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from types import MappingProxyType
from typing import NamedTuple

from .. import _check
from ..analysis import SmoothPeak, run_out, smooth_peak
from ..run import Run
from ..snapshot import Snapshot


class Quantity(NamedTuple):
    """A result of a slide.

    Attributes
    ----------
    title, unit : in words; the unit of what is shown
    scale : of what is shown, in SI units
    of_peak, of_state : how it follows from the peak of the kinetic energy, or else from the points
        at a time
    """

    title: str
    unit: str
    scale: float = 1.0
    of_peak: Callable[[SmoothPeak], float] | None = None
    of_state: Callable[[Snapshot], float] | None = None


QUANTITIES = MappingProxyType(
    {
        "peak_kinetic_energy": Quantity(
            "peak kinetic energy", "kJ/m", 1e3, of_peak=lambda peak: peak.kinetic
        ),
        "time_of_peak": Quantity("time of the peak", "s", of_peak=lambda peak: peak.time),
        "speed_at_peak": Quantity(
            "fastest point at the peak", "m/s", of_peak=lambda peak: peak.max_speed
        ),
        "max_displacement_total": Quantity(
            "largest displacement", "m", of_state=lambda state: state.max_displacement.total
        ),
        "max_displacement_horizontal": Quantity(
            "largest horizontal one", "m", of_state=lambda state: state.max_displacement.horizontal
        ),
        "max_displacement_vertical": Quantity(
            "largest vertical one", "m", of_state=lambda state: state.max_displacement.vertical
        ),
        "run_out": Quantity("run-out of the toe", "m", of_state=run_out),
    }
)

DEFAULT = ("peak_kinetic_energy", "time_of_peak", "max_displacement_total")


def check_names(names: Sequence[str]) -> tuple[str, ...]:
    """The names, each once; raises `TypeError` or `ValueError` for none or an unknown one."""
    if isinstance(names, str) or not isinstance(names, Sequence) or not names:
        raise TypeError(f"quantities must be one or more names, got {names!r}")
    for name in names:
        _check.one_of("quantities", name, tuple(QUANTITIES))
    return tuple(dict.fromkeys(names))


def need_rest(names: Sequence[str]) -> bool:
    """Whether one of them is not known yet when the kinetic energy has passed its peak."""
    return any(QUANTITIES[name].of_state for name in names)


def at_peak(names: Sequence[str]) -> tuple[str, ...]:
    """Those of them that are."""
    return tuple(name for name in names if QUANTITIES[name].of_peak)


def peak_values(run: Run, names: Sequence[str]) -> dict[str, float]:
    """Those of the peak; NaN while the kinetic energy still grows."""
    peak = smooth_peak(run.energy)
    found = {name: QUANTITIES[name].of_peak for name in names}
    return {
        name: math.nan if peak is None else take(peak)
        for name, take in found.items()
        if take is not None
    }


def state_values(state: Snapshot, names: Sequence[str]) -> dict[str, float]:
    """Those of the points at a time."""
    found = {name: QUANTITIES[name].of_state for name in names}
    return {name: take(state) for name, take in found.items() if take is not None}
