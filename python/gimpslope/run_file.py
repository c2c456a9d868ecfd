"""A run file opened for reading: its parameters, energies and states."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any, Literal

import numpy as np

from . import _check
from ._check import FloatArray
from .energy import Energy, energy_of
from .io import hdf5
from .ledger import LedgerRows, ledger_of
from .method import Method
from .recording import Recording
from .rigid_stones import RigidStoneRows, rigid_stones_of
from .scene import Scene
from .setup import Setup
from .snapshot import PointsAtStart, Snapshot
from .stages import Stages

Moment = float | Literal["peak"]
"""A time since the trigger, s, or "peak": when the kinetic energy so far was largest."""

_TIME_TOLERANCE = 0.01


class RunFile:
    """What a run file holds.

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

    @cached_property
    def setup(self) -> Setup:
        """All of these and what was recorded: `run.setup.simulate("again.h5")` repeats the run."""
        recording = Recording.from_dict(self.attributes["recording"])
        return Setup(self.scene, self.method, self.stages, recording)

    @property
    def trigger(self) -> dict[str, float]:
        """energy_released (J/m), settling_time (s), settling_ratio (kinetic over potential energy)
        and settling_unbalanced (forces over weight); empty before the trigger."""
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
    def rigid_stones(self) -> RigidStoneRows:
        """Motion of the stones of rigid material in the slide, and the forces on them, a row each
        of `energy`."""
        return rigid_stones_of(self.path, "slide")

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
            times = self._snapshot_times()
            return self._snapshot(len(times) - 1, times, self.points)
        time, arrays = found
        return Snapshot(time=time, points=self.points, **arrays)

    def snapshot(self, time: Moment) -> Snapshot:
        """The snapshot nearest to `time` (s, or "peak": of the largest kinetic energy so far).

        Raises
        ------
        TypeError, ValueError
            If the time is no number, or more than 1 % of the largest interval between snapshots
            before the first or after the last of them.
        """
        times = self._snapshot_times()
        wanted = self.energy.peak.time if time == "peak" else _check.finite("time", time)
        tolerance = _TIME_TOLERANCE * np.max(np.diff(times), initial=0.0)
        if not times[0] - tolerance <= wanted <= times[-1] + tolerance:
            raise ValueError(
                f"time must be a number in [{times[0]:.6g}, {times[-1]:.6g}], "
                f"the times of the snapshots, got {wanted!r}"
            )
        return self._snapshot(int(np.argmin(np.abs(times - wanted))), times, self.points)

    def snapshots(self) -> Iterator[Snapshot]:
        """All snapshots in order, read one by one.

        Raises `ValueError` if none are written yet.
        """
        times, points = self._snapshot_times(), self.points
        return (self._snapshot(number, times, points) for number in range(len(times)))

    def state(self, time: Moment | None = None) -> Snapshot:
        """The snapshot nearest to `time` (s, or "peak"), or the last state when it is None."""
        return self.final if time is None else self.snapshot(time)

    def _snapshot(self, number: int, times: FloatArray, points: PointsAtStart) -> Snapshot:
        arrays = hdf5.read_snapshot(self.path, number)
        return Snapshot(time=float(times[number]), points=points, **arrays)

    def _snapshot_times(self) -> FloatArray:
        times = self.times
        if len(times) == 0:
            raise ValueError(f"the run must have snapshots, got none in {str(self.path)!r}")
        return times
