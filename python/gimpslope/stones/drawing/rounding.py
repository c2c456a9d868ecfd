"""Lengths rounded, so that the last digits of sines and logarithms, which differ between machines,
have no bearing on a draw."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ..._check import FloatArray
from ...outline import Outline

_DIGITS = 7


def rounded(lengths: npt.ArrayLike, outline: Outline) -> FloatArray:
    """Lengths, m, to a fixed number of digits of those of the outline: to 1e-6 m where its longer
    side is 10 to 100 m, to 1e-7 m from 1 m on, and so forth."""
    x_min, y_min, x_max, y_max = outline.bounds
    longest = math.floor(math.log10(max(x_max - x_min, y_max - y_min)))
    result: FloatArray = np.round(np.asarray(lengths), _DIGITS - longest)
    return result
