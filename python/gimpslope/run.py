"""A run file opened for analysis: energy, speed, plastic zone and displacement."""

from __future__ import annotations

from functools import cached_property
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _check
from ._check import FloatArray
from .energy import Energy, energy_of
from .io import hdf5
from .ledger import LedgerRows, ledger_of
from .method import Method
from .scene import Scene
from .snapshot import MaxDisplacement, PointsAtStart, Snapshot
from .stages import Stages
from .summary import readable, summarise

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PLASTIC_THRESHOLD = 0.01
"""Equivalent plastic strain above which a point counts as part of the plastic zone."""

_TIME_TOLERANCE = 0.01
_SOIL = 0


def open(path: str | PathLike[str]) -> Run:
    """The run in the file at `path`, whether it has ended, was stopped or is still being written.

    Raises
    ------
    FileNotFoundError, ValueError
        If there is no such file, or it is not a run file of a known format.
    """
    return Run(path)


class Run:
    """A run file opened for analysis.

    The file is opened for each reading and closed after it, so that a run can be looked at while it
    is still being written. Points are in the order in which they were given.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        self.path = Path(path)
        hdf5.read_attributes(self.path)

    @property
    def attributes(self) -> dict[str, Any]:
        """The root attributes of the file as they are now, JSON text decoded."""
        return hdf5.read_attributes(self.path)

    @property
    def status(self) -> str:
        """ "running" (also of a killed run), "finished", "interrupted" or "failed"."""
        return str(self.attributes["status"])

    @property
    def status_detail(self) -> str:
        """How the run ended, in words."""
        return str(self.attributes["status_detail"])

    @cached_property
    def scene(self) -> Scene:
        """What was simulated."""
        return Scene.from_dict(self.attributes["scene"])

    @cached_property
    def method(self) -> Method:
        """How it was computed."""
        return Method.from_dict(self.attributes["method"])

    @cached_property
    def stages(self) -> Stages:
        """The loading stages."""
        return Stages.from_dict(self.attributes["stages"])

    @property
    def summary(self) -> dict[str, float | int | None]:
        """The main results, as `summarise` computes them from the data written so far."""
        return summarise(self)

    @property
    def trigger(self) -> dict[str, float]:
        """energy_released (J/m), settling_time (s), settling_ratio; empty before the trigger."""
        return hdf5.read_trigger(self.path)

    @property
    def energy(self) -> Energy:
        """Energy rows of the slide; `energy.stage(name)` gives those of the other stages."""
        return energy_of(self.path, "slide")

    @property
    def ledger(self) -> LedgerRows:
        """Where the energy of the slide went. Raises `ValueError` if the run kept no ledger."""
        return ledger_of(self.path, "slide")

    @property
    def times(self) -> FloatArray:
        """Times of the snapshots, s, shape (k,)."""
        return hdf5.read_snapshot_times(self.path)

    @property
    def points(self) -> PointsAtStart:
        """The points at the start of the slide. Raises `ValueError` if none are written yet."""
        arrays = hdf5.read_points(self.path)
        if not arrays:
            raise ValueError(f"the run must have reached the slide, got none in {str(self.path)!r}")
        return PointsAtStart(**arrays)

    @property
    def final(self) -> Snapshot:
        """The last state: the final one, or the last snapshot of a run that was killed."""
        found = hdf5.read_final(self.path)
        if found is None:
            return self._snapshot(-1)
        time, arrays = found
        return Snapshot(time=time, points=self.points, **arrays)

    def snapshot(self, time: float) -> Snapshot:
        """The snapshot nearest to `time` (s).

        Raises
        ------
        TypeError, ValueError
            If the time is no number, or more than 1 % of the largest interval between snapshots
            before the first or after the last of them.
        """
        times = self.times
        wanted = _check.finite("time", time)
        self._refuse_empty(times)
        tolerance = _TIME_TOLERANCE * np.max(np.diff(times), initial=0.0)
        if not times[0] - tolerance <= wanted <= times[-1] + tolerance:
            raise ValueError(
                f"time must be a number in [{times[0]:.6g}, {times[-1]:.6g}], "
                f"the times of the snapshots, got {time!r}"
            )
        return self._snapshot(int(np.argmin(np.abs(times - wanted))))

    def state(self, time: float | None = None) -> Snapshot:
        """The snapshot nearest to `time` (s), or the last state when it is None."""
        return self.final if time is None else self.snapshot(time)

    def displacement(self, time: float | None = None) -> FloatArray:
        """Displacement (x, y) since the trigger, m, shape (n, 2), at `time` (s) or in the end."""
        return self.state(time).displacement

    def max_displacement(self, time: float | None = None) -> MaxDisplacement:
        """Largest displacement in all, sideways (|u_x|) and up or down (|u_y|), m.

        At `time` (s), or in the end when it is None.
        """
        return self.state(time).max_displacement

    def plastic_zone(
        self, time: float | None = None, threshold: float = PLASTIC_THRESHOLD
    ) -> npt.NDArray[np.bool_]:
        """Which points are soil with an equivalent plastic strain above a threshold, shape (n,).

        At `time` (s), or in the end when it is None. The default threshold of 1 % is above the
        elastic strains of the study's soil, about 0.5 %, and far below those in a sliding band.
        """
        state = self.state(time)
        limit = _check.not_negative("threshold", threshold)
        zone: npt.NDArray[np.bool_] = (state.plastic_strain > limit) & (
            state.points.material == _SOIL
        )
        return zone

    def plot_energy(self, ax: Axes | None = None) -> Axes:
        """Kinetic energy of the slide against time."""
        return self.energy.plot(ax)

    def plot_speed(
        self, time: float, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the speed at `time` (s); its colours end at `largest` (m/s) where given."""
        from . import figures

        return figures.speed(self, time, ax, largest=largest)

    def plot_plastic_zone(
        self, time: float, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the equivalent plastic strain at `time` (s)."""
        from . import figures

        return figures.plastic_zone(self, time, ax, largest=largest)

    def plot_displacement(
        self, time: float | None = None, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the displacement since the trigger at `time` (s), or in the end."""
        from . import figures

        return figures.displacement(self, time, ax, largest=largest)

    def __repr__(self) -> str:
        return f"<Run {self.path.name!r}: {self.status}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{name.replace('_', ' ')}</th><td>{value}</td></tr>"
            for name, value in readable(self.summary).items()
        )
        title = escape(f"{self.path.name}: {self.status}")
        return f"<table><caption>{title}</caption>{rows}</table>"

    def _snapshot(self, number: int) -> Snapshot:
        times = self.times
        self._refuse_empty(times)
        arrays = hdf5.read_snapshot(self.path, number % len(times))
        return Snapshot(time=float(times[number]), points=self.points, **arrays)

    def _refuse_empty(self, times: FloatArray) -> None:
        if len(times) == 0:
            raise ValueError(f"the run must have snapshots, got none in {str(self.path)!r}")
