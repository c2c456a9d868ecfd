"""The room that stones have in an outline: who is too near to whom, and to the edge."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from ..._check import FloatArray
from ...outline import Outline
from . import reach
from .rounding import rounded

ROUNDING = 1e-9
_DIAGONAL = math.sqrt(2)

Flags = npt.NDArray[np.bool_]


class Near(NamedTuple):
    """Pairs that are too near: numbers (m,), by how much, m, (m,), and unit vectors (m, 2) from the
    first to the second; of an edge, `second` is its number. `measured` pairs were looked at."""

    first: reach.Numbers
    second: reach.Numbers
    lack: FloatArray
    direction: FloatArray
    measured: int


@dataclass(frozen=True, eq=False)
class Room:
    """An outline for n stones that have reaches (n, 256), m, and keep `gap` between each other and
    `margin` from the edge, m."""

    outline: Outline
    reaches: FloatArray
    gap: float
    margin: float

    def pairs(
        self, places: FloatArray, numbers: reach.Numbers, leeway: float = 0.0
    ) -> reach.Numbers:
        """Pairs of the stones of these numbers that may be too near at places (n, 2), or once all
        have moved along x and y by up to `leeway`, m, by number, shape (2, m)."""
        boxes = self._boxes(places, numbers, self.gap / 2 + leeway)
        rows = shapely.STRtree(boxes).query(boxes)
        rows = rows[:, rows[0] < rows[1]]
        pairs: reach.Numbers = numbers[rows[:, np.lexsort(rows[::-1])]]
        return pairs

    def beside_edges(
        self, places: FloatArray, numbers: reach.Numbers, leeway: float = 0.0
    ) -> reach.Numbers:
        """The same of stones and edges of the outline."""
        rows = self._edge_tree.query(self._boxes(places, numbers, self.margin + leeway))
        rows = rows[:, np.lexsort(rows[::-1])]
        pairs = np.stack([numbers[rows[0]], rows[1]])
        apart, _ = self._from_edges(places, pairs, -np.inf)
        return pairs[:, apart < self.margin + _DIAGONAL * leeway]

    def near_stones(self, places: FloatArray, pairs: reach.Numbers) -> Near:
        """Those of the pairs (2, m) that are too near at places (n, 2)."""
        offset = places[pairs[1]] - places[pairs[0]]
        close = np.hypot(*offset.T) < self._radii[pairs].sum(axis=0) + self.gap
        pairs, offset = pairs[:, close], offset[close]
        reaches, kinds = self._kinds
        first, second = kinds[pairs]
        apart, direction = reach.between(reaches, first, second, offset, self.gap)
        return _near(pairs, self.gap - apart, direction)

    def near_edges(self, places: FloatArray, pairs: reach.Numbers) -> Near:
        """Those of the pairs (2, m) of stones and edges that are too near at places (n, 2)."""
        apart, direction = self._from_edges(places, pairs, self.margin)
        return _near(pairs, self.margin - apart, direction)

    @property
    def inner_point(self) -> FloatArray:
        """Some point inside the outline, m, shape (2,)."""
        point = self.outline.polygon.point_on_surface()
        return rounded((point.x, point.y), self.outline)

    def random_points(self, rng: np.random.Generator, n: int) -> FloatArray:
        """Random points in the bounding box of the outline, m, shape (n, 2)."""
        low, high = np.reshape(self.outline.bounds, (2, 2))
        return rounded(low + rng.random((n, 2)) * (high - low), self.outline)

    @cached_property
    def _kinds(self) -> tuple[FloatArray, reach.Numbers]:
        """Reaches, and which of them each stone has: the first, near at hand, if all are alike."""
        n = len(self.reaches)
        alike = (self.reaches == self.reaches[0]).all()
        return self.reaches, np.zeros(n, dtype=np.int64) if alike else np.arange(n)

    @cached_property
    def _radii(self) -> FloatArray:
        radii: FloatArray = self.reaches.max(axis=1)
        return radii

    @cached_property
    def _edges(self) -> tuple[FloatArray, FloatArray]:
        corners = self.outline.vertices
        return corners, np.roll(corners, -1, axis=0)

    @cached_property
    def _edge_tree(self) -> shapely.STRtree:
        return shapely.STRtree(shapely.linestrings(np.stack(self._edges, axis=1)))

    def _boxes(
        self, places: FloatArray, numbers: reach.Numbers, wider: float
    ) -> npt.NDArray[np.object_]:
        right, top, left, bottom = self.reaches[numbers[:, np.newaxis], reach.QUARTERS].T + wider
        x, y = places[numbers].T
        boxes: npt.NDArray[np.object_] = shapely.box(x - left, y - bottom, x + right, y + top)
        return boxes

    def _from_edges(
        self, places: FloatArray, pairs: reach.Numbers, enough: float
    ) -> tuple[FloatArray, FloatArray]:
        number, edge = pairs
        start, end = (corner[edge] - places[number] for corner in self._edges)
        reaches, kinds = self._kinds
        return reach.to_edges(reaches, kinds[number], start, end, enough)


def _near(pairs: reach.Numbers, lack: FloatArray, direction: FloatArray) -> Near:
    near = lack > ROUNDING
    return Near(pairs[0, near], pairs[1, near], lack[near], direction[near], len(near))
