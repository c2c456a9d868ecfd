"""Outlines: simple polygons, and the regular lattice of points inside one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import shapely

from . import _check
from ._check import FloatArray
from ._record import Record

_EDGE = 1e-9
_MOST_POINTS = 200_000_000


@dataclass(frozen=True, eq=False)
class Outline(Record):
    """A simple polygon: of a slope, or of a stone.

    Parameters
    ----------
    vertices : corners in order, either way round, shape (k, 2) with k >= 3, m; the first may be
        repeated at the end

    Raises
    ------
    TypeError, ValueError
        If the vertices are not an array of finite numbers of that shape, or the polygon crosses
        itself or has no area.
    """

    vertices: FloatArray

    def __post_init__(self) -> None:
        vertices = _check.array("vertices", self.vertices, ("k", 2))
        if len(vertices) > 1 and np.array_equal(vertices[0], vertices[-1]):
            vertices = vertices[:-1]
        if len(vertices) < 3:
            raise ValueError(f"vertices must be at least 3 distinct points, got {len(vertices)}")
        self._store(vertices=vertices)
        if not self.polygon.is_valid:
            reason = shapely.is_valid_reason(self.polygon)
            raise ValueError(f"vertices must form a simple polygon, got one with {reason}")

    @classmethod
    def slope(cls, height: float = 9.0, crest: float = 2.0, angle: float = 45.0) -> Outline:
        """A slope with a vertical left side at x = 0, its base at y = 0 and its face on the right.

        The default is the reference study's, identified from its number of points.

        Parameters
        ----------
        height : m, > 0
        crest : width of the level top, m, > 0
        angle : of the face with the base, degrees, in (0, 90]
        """
        height = _check.positive("height", height)
        crest = _check.positive("crest", crest)
        angle = _check.in_range("angle", angle, 0, 90, "(]")
        base = crest + height / math.tan(math.radians(angle))
        return cls(np.array([(0.0, 0.0), (base, 0.0), (crest, height), (0.0, height)]))

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """The outline as a shapely polygon, m."""
        polygon = shapely.Polygon(self.vertices)
        shapely.prepare(polygon)
        return polygon

    @property
    def area(self) -> float:
        """Area, m2."""
        return float(self.polygon.area)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box (x_min, y_min, x_max, y_max), m."""
        (x_min, y_min), (x_max, y_max) = self.vertices.min(axis=0), self.vertices.max(axis=0)
        return float(x_min), float(y_min), float(x_max), float(y_max)

    def contains(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether each of the points (n, 2), m, is inside or on the edge, shape (n,).

        A point counts as on the edge within 1e-9 of the longer side of the bounding box.
        """
        xy = _check.array("points", points, ("n", 2))
        x_min, y_min, x_max, y_max = self.bounds
        tolerance = _EDGE * max(x_max - x_min, y_max - y_min)
        low, high = np.subtract((x_min, y_min), tolerance), np.add((x_max, y_max), tolerance)
        inside: npt.NDArray[np.bool_] = np.all((xy >= low) & (xy <= high), axis=1)
        near = np.flatnonzero(inside)
        inside[near] = shapely.intersects_xy(self.polygon, xy[near])
        doubtful = near[~inside[near]]
        inside[doubtful] = shapely.dwithin(self.polygon, shapely.points(xy[doubtful]), tolerance)
        return inside

    def lattice(self, spacing: float) -> FloatArray:
        """The points of a regular lattice inside the outline, edge inclusive, shape (n, 2), m.

        They lie at ((i + 1/2) s + x_min, (j + 1/2) s + y_min), row by row from the bottom, each
        row from the left. `spacing` s in m, > 0, for at most 2e8 points in the bounding box.
        """
        spacing = _check.positive("spacing", spacing)
        x_min, y_min, x_max, y_max = self.bounds
        columns, rows = (math.ceil(side / spacing) for side in (x_max - x_min, y_max - y_min))
        if columns * rows > _MOST_POINTS:
            raise ValueError(
                f"spacing must be large enough for at most {_MOST_POINTS:,} points in the bounding "
                f"box, got {spacing:.6g} m, which gives {columns * rows:,}"
            )
        x = x_min + (np.arange(columns) + 0.5) * spacing
        y = y_min + (np.arange(rows) + 0.5) * spacing
        points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        return points[self.contains(points)]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Outline) and np.array_equal(self.vertices, other.vertices)

    def __hash__(self) -> int:
        return hash(tuple(self.vertices.ravel()))
