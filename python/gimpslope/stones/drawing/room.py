"""The room that stones have in an outline: who is too near to whom, and to the edge."""

from __future__ import annotations

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

Flags = npt.NDArray[np.bool_]


class Near(NamedTuple):
    """Pairs that are too near: numbers (m,), by how much, m, (m,), and unit vectors (m, 2) from the
    first to the second; of an edge, `second` is its number."""

    first: reach.Numbers
    second: reach.Numbers
    lack: FloatArray
    direction: FloatArray


@dataclass(frozen=True, eq=False)
class Room:
    """An outline for n stones that have reaches (n, 256), m, and keep `gap` between each other and
    `margin` from the edge, m."""

    outline: Outline
    reaches: FloatArray
    gap: float
    margin: float

    def near_stones(self, places: FloatArray, numbers: reach.Numbers) -> Near:
        """Pairs of the stones of these numbers, at places (n, 2), that are too near, by number."""
        boxes = self._boxes(places, numbers, self.gap / 2)
        rows = shapely.STRtree(boxes).query(boxes)
        rows = rows[:, rows[0] < rows[1]]
        rows = rows[:, np.lexsort(rows[::-1])]
        first, second = numbers[rows]
        offset = places[second] - places[first]
        close = np.hypot(*offset.T) < self._radii[first] + self._radii[second] + self.gap
        first, second, offset = first[close], second[close], offset[close]
        apart, direction = reach.between(self.reaches, first, second, offset)
        return self._near(first, second, self.gap - apart, direction)

    def near_edges(self, places: FloatArray, numbers: reach.Numbers) -> Near:
        """Stones of these numbers that are too near to edges of the outline, by number."""
        rows = self._edge_tree.query(self._boxes(places, numbers, self.margin))
        rows = rows[:, np.lexsort(rows[::-1])]
        number, edge = numbers[rows[0]], rows[1]
        start, end = (corner[edge] - places[number] for corner in self._edges)
        apart, direction = reach.to_edges(self.reaches, number, start, end)
        return self._near(number, edge, self.margin - apart, direction)

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
        right, top, left, bottom = self.reaches[numbers][:, reach.QUARTERS].T + wider
        x, y = places[numbers].T
        boxes: npt.NDArray[np.object_] = shapely.box(x - left, y - bottom, x + right, y + top)
        return boxes

    def _near(
        self,
        first: reach.Numbers,
        second: reach.Numbers,
        lack: FloatArray,
        direction: FloatArray,
    ) -> Near:
        near = lack > ROUNDING
        return Near(first[near], second[near], lack[near], direction[near])
