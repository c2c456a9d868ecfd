"""The phases of a slide, by its kinetic energy: it accelerates, slows down and stays at rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _check
from ..energy import Energy

REST_SHARE = 0.01
"""Share of the largest kinetic energy below which a slide counts as stable."""


class Phases(NamedTuple):
    """When the phases of a slide end, s since the trigger; None for what the run has not reached.

    Attributes
    ----------
    peak : the kinetic energy is largest: end of the acceleration
    rest : from here on it stays at or below the share of the peak: end of the deceleration
    end : last row of energy
    """

    peak: float | None
    rest: float | None
    end: float

    @property
    def acceleration(self) -> float | None:
        """How long the slide accelerates, s."""
        return self.peak

    @property
    def deceleration(self) -> float | None:
        """How long the slide slows down, s."""
        return None if self.peak is None or self.rest is None else self.rest - self.peak

    @property
    def stable(self) -> float | None:
        """How long the slide was followed after it came to rest, s."""
        return None if self.rest is None else self.end - self.rest


def phases_of(energy: Energy, share: float = REST_SHARE) -> Phases:
    """The phases of a slide.

    The peak counts as reached when a row after it is lower, and rest when the last row is at or
    below the share of the peak; its time is interpolated linearly between two rows.

    Parameters
    ----------
    energy : rows of the slide
    share : of the largest kinetic energy, in (0, 1)

    Raises
    ------
    TypeError, ValueError
        If the share is not a number in its range, or there are no rows.
    """
    share = _check.in_range("share", share, 0, 1, "()")
    time, kinetic = energy.time, energy.kinetic
    peak = energy.peak
    limit = share * peak.value
    end = float(time[-1])
    if peak.time == end:
        return Phases(None, None, end)
    last = int(np.flatnonzero(kinetic > limit)[-1]) if peak.value > 0 else -1
    if last == len(time) - 1:
        return Phases(peak.time, None, end)
    if last < 0:
        return Phases(peak.time, peak.time, end)
    over, under = kinetic[last : last + 2]
    crossed = time[last] + (time[last + 1] - time[last]) * (over - limit) / (over - under)
    return Phases(peak.time, float(crossed), end)
