"""Rigid stones: where they are, how they move, and what pushes them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _check
from ._check import FloatArray
from .io import hdf5


@dataclass(frozen=True, eq=False)
class RigidStones:
    """The m rigid stones of a solver as they are.

    Attributes
    ----------
    number : of the stone, as `points.stone` counts, shape (m,)
    states : columns as the attributes below have them, angles in radians, shape (m, 9)
    """

    number: npt.NDArray[np.int32]
    states: FloatArray

    def __len__(self) -> int:
        return len(self.number)

    def __repr__(self) -> str:
        return f"{type(self).__name__}(m={len(self)})"

    @property
    def centre(self) -> FloatArray:
        """Of mass, m, shape (m, 2)."""
        return self.states[..., 0:2]

    @property
    def angle(self) -> FloatArray:
        """Counter-clockwise since the points were given, degrees, whole turns counted, shape
        (m,)."""
        return np.degrees(self.states[..., 2])

    @property
    def velocity(self) -> FloatArray:
        """Of the centre, m/s, shape (m, 2)."""
        return self.states[..., 3:5]

    @property
    def spin(self) -> FloatArray:
        """Counter-clockwise, radians a second, shape (m,)."""
        return self.states[..., 5]

    @property
    def impulse(self) -> FloatArray:
        """Of all but gravity since the clock was last set to zero, N s/m, shape (m, 2)."""
        return self.states[..., 6:8]

    @property
    def angular_impulse(self) -> FloatArray:
        """The same about the centre, N m s/m, shape (m,)."""
        return self.states[..., 8]


class Unsettled(NamedTuple):
    """Steps whose impulses on rigid stones had not settled when the iterations for them ended.

    Attributes
    ----------
    steps : their number; those whose last change moves nothing by a millionth of a cell do not
        count
    largest, sum : how far the last change of a speed moves a stone against what it touches, m, in
        one of these steps at most and in all of them; of the worst stone or contact of each step,
        beyond which overlaps of a row of stones add up
    """

    steps: int
    largest: float
    sum: float


@dataclass(frozen=True, eq=False, repr=False)
class RigidStoneRows(RigidStones):
    """The m rigid stones over the k rows of one stage of a run: arrays of `RigidStones` with an
    axis of time in front.

    Attributes
    ----------
    time : s; in the slide from the trigger, shape (k,)
    """

    time: FloatArray

    @property
    def translation(self) -> FloatArray:
        """Displacement of the centre since the first row, m, shape (k, m, 2)."""
        moved: FloatArray = self.centre - self.centre[:1]
        return moved

    @property
    def rotation(self) -> FloatArray:
        """Angle since the first row, degrees, shape (k, m)."""
        turned: FloatArray = self.angle - self.angle[:1]
        return turned

    @property
    def contact_force(self) -> FloatArray:
        """Force of soil, walls and other stones, the mean since the row before, N/m, shape
        (k, m, 2); NaN in the first row."""
        return self._rate(self.impulse)

    @property
    def contact_moment(self) -> FloatArray:
        """Their moment about the centre, N m/m, shape (k, m); as `contact_force`."""
        return self._rate(self.angular_impulse)

    def _rate(self, impulse: FloatArray) -> FloatArray:
        rate = np.full_like(impulse, np.nan)
        rate[1:] = (np.diff(impulse, axis=0).T / np.diff(self.time)).T
        return rate


def rigid_stones_of(path: Path, stage: str) -> RigidStoneRows:
    """The rows of one stage in the run file at `path`; of a scene without rigid stones m is 0."""
    number = hdf5.STAGES.index(_check.one_of("stage", stage, hdf5.STAGES))
    stones, states = hdf5.read_rigid_stones(path)
    energies = hdf5.read_energy(path)
    count = min(len(energies["time"]), len(states))
    rows = energies["stage"][:count] == number
    return RigidStoneRows(stones, states[:count][rows], energies["time"][:count][rows])
