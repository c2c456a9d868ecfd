"""Connected components of a graph, by minimal labels and pointer jumping."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

IntArray = npt.NDArray[np.int64]

EDGES = ((1, 0), (0, 1))
CORNERS = (*EDGES, (1, -1), (1, 1))
"""Steps, in columns and rows, to one half of the cells that share an edge, or edge or corner."""


def components(count: int, pairs: IntArray) -> IntArray:
    """The component of each of `count` things that `pairs` (k, 2) join, shape (count,).

    Components are named by the least number in them. Each round hangs every root that has a smaller
    neighbour under it, then flattens the trees (Shiloach & Vishkin 1982, J. Algorithms 3:57).
    """
    root = np.arange(count)
    while True:
        ends = root[pairs]
        if (ends[:, 0] == ends[:, 1]).all():
            return root
        least = ends.min(axis=1)
        np.minimum.at(root, ends[:, 0], least)
        np.minimum.at(root, ends[:, 1], least)
        while (root != root[root]).any():
            root = root[root]


def neighbours(cells: IntArray, steps: tuple[tuple[int, int], ...]) -> IntArray:
    """Pairs (k, 2) of numbers of distinct cells (n, 2), columns and rows, that are a step apart.

    `steps` are `EDGES` or `CORNERS`; each pair is given once.
    """
    low = cells.min(axis=0, initial=0) - 1
    column, row = (cells - low).T
    width = int(row.max(initial=0)) + 2  # one more than rows, so that none wraps round
    key = column * width + row
    order = np.argsort(key)
    pairs = []
    for columns, rows in steps:
        wanted = key + columns * width + rows
        place = np.searchsorted(key, wanted, sorter=order)
        found = order[np.minimum(place, len(order) - 1)] if len(order) else order
        joined = key[found] == wanted
        pairs.append(np.column_stack([np.flatnonzero(joined), found[joined]]))
    return np.concatenate(pairs)
