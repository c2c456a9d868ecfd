"""Percentiles by mass, which single flying points do not move."""

from __future__ import annotations

import numpy as np

from .. import _check
from .._check import FloatArray

_ROUNDING = 1e-12


def mass_percentile(values: FloatArray, mass: FloatArray, percentile: float) -> float:
    """The least of the values up to which the points hold `percentile` % of the mass.

    Parameters
    ----------
    values, mass : one a point, shape (n,)
    percentile : %, in (0, 100]; 100 gives the largest value

    Raises
    ------
    TypeError, ValueError
        If the percentile is not a number in its range.
    """
    percentile = _check.in_range("percentile", percentile, 0, 100, "(]")
    order = np.argsort(values, kind="stable")
    held = np.cumsum(mass[order])
    wanted = percentile / 100 * held[-1] * (1 - _ROUNDING)
    return float(values[order[np.searchsorted(held, wanted)]])
