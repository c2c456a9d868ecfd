"""Holes: what no point reaches though points are all around it."""

from __future__ import annotations

import numpy as np

from .._check import FloatArray
from .components import IntArray
from .islands import islands

_FINENESS = 4


def holes(position: FloatArray, reach: float) -> int:
    """Number of holes in the union of squares around points.

    The squares are taken on cells of two ninths of `reach`, and are a ninth smaller or larger as
    their points lie: a hole is twice the reach wide, give or take as much.

    Parameters
    ----------
    position : of the points, m, shape (n, 2)
    reach : half the side of a square, m, > 0
    """
    cells = np.floor(position * ((_FINENESS + 0.5) / reach)).astype(np.int64)
    for axis in (0, 1):
        cells = _spread(cells, axis)
    return len(islands(cells))


def _spread(cells: IntArray, axis: int) -> IntArray:
    """The distinct cells that lie at most so many along an axis from the given ones."""
    steps = np.zeros((2 * _FINENESS + 1, 2), dtype=np.int64)
    steps[:, axis] = np.arange(-_FINENESS, _FINENESS + 1)
    spread = (cells[:, np.newaxis] + steps).reshape(-1, 2)
    low = spread.min(axis=0)
    column, row = (spread - low).T
    rows = int(row.max()) + 1
    distinct: IntArray = np.column_stack(np.divmod(np.unique(column * rows + row), rows)) + low
    return distinct
