"""The energy rows of a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _check
from ._check import FloatArray
from .io import hdf5

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Peak(NamedTuple):
    """Where a curve is highest."""

    time: float
    value: float


@dataclass(frozen=True, eq=False)
class Energy:
    """Energy rows of one stage, one array (k,) a column.

    Attributes
    ----------
    time : s; in the slide from the trigger
    step : steps taken since the clock was last set to zero
    kinetic, potential, elastic : J/m; potential is zero at y = 0
    max_speed : speed of the fastest point, m/s
    """

    path: Path
    time: FloatArray
    step: npt.NDArray[np.int64]
    kinetic: FloatArray
    potential: FloatArray
    elastic: FloatArray
    max_speed: FloatArray

    def __len__(self) -> int:
        return len(self.time)

    @property
    def peak(self) -> Peak:
        """Time (s) and value (J/m) of the largest kinetic energy; of the first if several.

        Raises `ValueError` for a stage without rows.
        """
        row = self._peak_row()
        return Peak(float(self.time[row]), float(self.kinetic[row]))

    @property
    def speed_at_peak(self) -> float:
        """Speed of the fastest point when the kinetic energy is largest, m/s."""
        return float(self.max_speed[self._peak_row()])

    def stage(self, name: str) -> Energy:
        """The rows of another stage: "gravity", "settling" or "slide"."""
        return energy_of(self.path, name)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Kinetic energy against time, drawn into `ax` or a new figure."""
        from . import figures

        return figures.kinetic_energy(self, ax)

    def _peak_row(self) -> int:
        if len(self) == 0:
            raise ValueError(f"the stage must have energy rows, got none in {str(self.path)!r}")
        return int(np.argmax(self.kinetic))


def energy_of(path: Path, stage: str) -> Energy:
    """The rows of one stage in the run file at `path`."""
    number = hdf5.STAGES.index(_check.one_of("stage", stage, hdf5.STAGES))
    columns = hdf5.read_energy(path)
    rows = columns.pop("stage") == number
    return Energy(path, **{name: column[rows] for name, column in columns.items()})
