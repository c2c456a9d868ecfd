"""Arrays of one row a stone: a single row may be given for all, and an empty list for none."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .. import _check
from .._check import FloatArray


def for_each(name: str, value: npt.ArrayLike, n: int, row: tuple[int, ...]) -> FloatArray:
    """The `n` rows of shape `row`, shape (n, *row), read-only."""
    return np.broadcast_to(one_or_all(name, value, row, n), (n, *row))


def one_or_all(
    name: str, value: npt.ArrayLike, row: tuple[int, ...], n: int | str = "n"
) -> FloatArray:
    """A single row of shape `row`, or `n` of them as in `all_rows`."""
    shape = _shape(value)
    if shape != (0,) and len(shape) == len(row):
        return _check.array(name, value, row)
    return all_rows(name, value, row, n)


def all_rows(
    name: str, value: npt.ArrayLike, row: tuple[int, ...], n: int | str = "n"
) -> FloatArray:
    """`n` rows of shape `row`, shape (n, *row), as many as there are where that is a letter."""
    given = np.empty((0, *row)) if _shape(value) == (0,) else value
    return _check.array(name, given, (n, *row))


def refuse_not_positive(name: str, values: FloatArray) -> None:
    """Refuse the first of the values that is not above zero, by its place: axes[3][1]."""
    for place in np.argwhere(values <= 0)[:1]:
        _check.positive(name + "".join(f"[{n}]" for n in place), values[tuple(place)])


def _shape(value: npt.ArrayLike) -> tuple[int, ...]:
    try:
        return np.shape(value)
    except ValueError:
        # Rows of different lengths, which the check of the array refuses by name.
        return ()
