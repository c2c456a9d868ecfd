"""What of a run is recorded, and when."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import _check
from ._record import Record

_DIGITS = 12
_ROUNDING = 10.0**-_DIGITS  # s


@dataclass(frozen=True)
class Recording(Record):
    """When energy rows and snapshots are written.

    Parameters
    ----------
    energy_interval : between rows of energy, s, > 0
    snapshot_interval : between snapshots of the slide, s, > 0
    snapshot_times : further times of snapshots, s, >= 0; those after the slide are left out

    Raises
    ------
    TypeError, ValueError
        If a parameter is not made of finite numbers in its range.
    """

    energy_interval: float = 0.005
    snapshot_interval: float = 0.2
    snapshot_times: Sequence[float] = ()

    def __post_init__(self) -> None:
        times = _check.array("snapshot_times", self.snapshot_times, ("k",))
        if (times < 0).any():
            raise ValueError(f"snapshot_times must be numbers >= 0, got {times.min()}")
        self._store(
            energy_interval=_check.positive("energy_interval", self.energy_interval),
            snapshot_interval=_check.positive("snapshot_interval", self.snapshot_interval),
            snapshot_times=tuple(times.tolist()),
        )

    def times(self, duration: float) -> list[float]:
        """Times of the snapshots of a slide of that duration (s), in order, its end included."""
        every = np.arange(0.0, duration, self.snapshot_interval)
        rounded = np.unique(np.round([*every, *self.snapshot_times], _DIGITS))
        return [*(float(time) for time in rounded if time < duration - _ROUNDING), duration]

    def row_time(self, start: float, number: int) -> float:
        """Time of the row of that number in a stage, s: counted, for times that are summed up
        drift."""
        return round(start + number * self.energy_interval, _DIGITS)
