"""Arrays of one row a stone, which may be given as a single row for all."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .. import _check
from .._check import FloatArray


def for_each(name: str, value: npt.ArrayLike, n: int, row: tuple[int, ...]) -> FloatArray:
    """The `n` rows of shape `row`, shape (n, *row), read-only."""
    shape = row if is_single(value, row) else (n, *row)
    return np.broadcast_to(_check.array(name, value, shape), (n, *row))


def is_single(value: npt.ArrayLike, row: tuple[int, ...]) -> bool:
    """Whether a value has the dimensions of a single row of this shape."""
    try:
        return np.ndim(value) == len(row)
    except ValueError:
        # Rows of different lengths, which the check of the array refuses by name.
        return False
