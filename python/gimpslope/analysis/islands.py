"""Islands: what a region of cells goes around."""

from __future__ import annotations

import numpy as np

from .components import EDGES, IntArray, components, neighbours


def islands(cells: IntArray) -> IntArray:
    """Sizes, in cells, of the regions that distinct cells (n, 2), columns and rows, enclose, (k,).

    The cells around which one cannot go are those that share an edge or a corner; so those of an
    island share edges.
    """
    if len(cells) == 0:
        return np.empty(0, dtype=np.int64)
    column, row = (_closed_up(line) for line in cells.T)
    covered = np.zeros((column.max() + 2, row.max() + 2), dtype=bool)  # a rim outside of all cells
    covered[column, row] = True
    free = np.argwhere(~covered)
    region = components(len(free), neighbours(free, EDGES))
    sizes = np.bincount(region)
    enclosed = sizes[1:]  # the first free cell is one of the rim, which is all one region
    return enclosed[enclosed > 0]


def _closed_up(line: IntArray) -> IntArray:
    """Columns, or rows, counted from 1, with one empty one for each gap however wide.

    No island reaches into an empty one, and a single cell far away does not make the grid large.
    """
    used, number = np.unique(line, return_inverse=True)
    place = np.cumsum(np.minimum(np.diff(used, prepend=used[0] - 1), 2))
    return place[number]
