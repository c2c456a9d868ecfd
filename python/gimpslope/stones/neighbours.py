"""Which of many shapes overlap, and how far each is from the nearest other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import shapely

from .._check import FloatArray
from . import contact
from .stone import Shape

_ROUNDING = 1e-9

Pairs = npt.NDArray[np.int64]


def overlaps(shapes: Sequence[Shape]) -> Pairs:
    """Pairs of numbers of shapes that overlap, the smaller number first, in order, shape (k, 2)."""
    pairs = _near(shapes, 0.0)
    return pairs[contact.overlap(_shapes(shapes, pairs))]


def gaps(shapes: Sequence[Shape]) -> FloatArray:
    """Distance of each shape from the nearest other, m, shape (n,); infinite where it is alone."""
    nearest = np.full(len(shapes), np.inf)
    if len(shapes) < 2:
        return nearest
    # Its distance from any other bounds how far away the nearest can be.
    bound = np.zeros(len(shapes))
    pairs = _of_nearest_points(shapes)
    bound[pairs[:, 0]] = contact.distance(_shapes(shapes, pairs))
    pairs = _near(shapes, bound * (1 + _ROUNDING))
    found = contact.distance(_shapes(shapes, pairs))
    for column in pairs.T:
        np.minimum.at(nearest, column, found)
    return nearest


def _near(shapes: Sequence[Shape], reach: npt.ArrayLike) -> Pairs:
    """Pairs whose bounding boxes are within the reach, m, of one of both, (k, 2)."""
    boxes = shapely.box(*np.array([shape.bounds for shape in shapes]).reshape(-1, 4).T)
    pairs = shapely.STRtree(boxes).query(boxes, predicate="dwithin", distance=reach).T
    return np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)


def _of_nearest_points(shapes: Sequence[Shape]) -> Pairs:
    """Each shape and another that is near by a point in either, (k, 2).

    Those that share their point with all others, and so overlap them, are left out.
    """
    points = shapely.point_on_surface([shape.polygon for shape in shapes])
    pairs: Pairs = (
        shapely.STRtree(points).query_nearest(points, exclusive=True, all_matches=False).T
    )
    return pairs


def _shapes(shapes: Sequence[Shape], pairs: Pairs) -> list[contact.Pair]:
    return [(shapes[first], shapes[second]) for first, second in pairs.tolist()]
