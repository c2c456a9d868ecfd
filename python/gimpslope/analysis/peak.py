"""Where the kinetic energy is highest, between the rows and through their noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..energy import Energy

_NEAR = 0.99
_LEAST_ROWS = 5


class SmoothPeak(NamedTuple):
    """A peak of the kinetic energy.

    Attributes
    ----------
    time : s since the trigger
    kinetic : J/m
    max_speed : of the fastest point then, m/s
    """

    time: float
    kinetic: float
    max_speed: float


def smooth_peak(energy: Energy) -> SmoothPeak | None:
    """The peak by a parabola, and the speed by a line, through the rows around it within 1 % of it.

    Waves make the top of the curve rough by more than fine grids differ, and the fastest point is
    now one, now another. None while the kinetic energy still grows in the last row.
    """
    time, kinetic = energy.time, energy.kinetic
    top = int(np.argmax(kinetic))
    if top == len(time) - 1:
        return None
    low = np.flatnonzero(kinetic < _NEAR * kinetic[top])
    start = int(low[low < top].max(initial=-1)) + 1
    end = int(low[low > top].min(initial=len(time)))
    if end - start < _LEAST_ROWS:
        return SmoothPeak(float(time[top]), float(kinetic[top]), float(energy.max_speed[top]))
    since = time[start:end] - time[top]
    a, b, c = np.polyfit(since, kinetic[start:end], 2)
    if a >= 0 or not since[0] <= -b / (2 * a) <= since[-1]:
        return SmoothPeak(float(time[top]), float(kinetic[top]), float(energy.max_speed[top]))
    shift = -b / (2 * a)
    speed = np.polyval(np.polyfit(since, energy.max_speed[start:end], 1), shift)
    return SmoothPeak(float(time[top] + shift), float(c - b**2 / (4 * a)), float(speed))
