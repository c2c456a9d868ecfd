"""How far a stone reaches in each of 256 directions, and from that how far stones are apart.

The reach h(n) = max n.x over the points x of a body about its origin tells how far the tangents
across n of two bodies are apart; that is never more than their distance. So what is found here by
looking in 256 directions only errs to the safe side: by d / 13,000 for round stones whose centres
are d apart, and less than twice that of the radius of curvature for others. A polygon counts as its
convex hull.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from ..._check import FloatArray
from ..ellipse import Ellipse
from ..stone import Shape

_STRIDE = 8
_N = 32 * _STRIDE
_TURNS = 2 * np.pi / _N * np.arange(_N)
DIRECTIONS = np.stack([np.cos(_TURNS), np.sin(_TURNS)], axis=1)
QUARTERS = np.arange(0, _N, _N // 4)
_COARSE = np.arange(0, _N, _STRIDE)
_FINE = np.arange(-_STRIDE, _STRIDE + 1)

Numbers = npt.NDArray[np.int64]


def reach(shape: Shape) -> FloatArray:
    """Reach of a shape about the origin, m, shape (256,)."""
    corners = shape.half_axes.T if isinstance(shape, Ellipse) else shape.vertices
    along = corners[:, :1] * DIRECTIONS[:, 0] + corners[:, 1:] * DIRECTIONS[:, 1]
    reaches: FloatArray = np.hypot(*along) if isinstance(shape, Ellipse) else along.max(axis=0)
    return reaches


def between(
    reaches: FloatArray, first: Numbers, second: Numbers, offset: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Distance of bodies, m, shape (m,), and the unit vectors (m, 2) from the first to the second.

    Negative where they overlap: how far to push them apart along the vector.

    Parameters
    ----------
    reaches : of all bodies, m, shape (n, 256)
    first, second : numbers of the bodies, shape (m,)
    offset : from the first origin to the second, m, shape (m, 2)
    """

    def apart(columns: Numbers) -> FloatArray:
        opposite = (columns + _N // 2) % _N
        along = _along(offset, columns)
        return along - reaches[first[:, None], columns] - reaches[second[:, None], opposite]

    return _widest(apart, len(offset))


def to_edges(
    reaches: FloatArray, number: Numbers, start: FloatArray, end: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The same for bodies and edges, whose ends (m, 2) are given from the origins of the bodies."""

    def apart(columns: Numbers) -> FloatArray:
        nearer = np.minimum(_along(start, columns), _along(end, columns))
        return nearer - reaches[number[:, None], columns]

    return _widest(apart, len(start))


def _along(vector: FloatArray, columns: Numbers) -> FloatArray:
    direction = DIRECTIONS[columns]
    return direction[..., 0] * vector[:, :1] + direction[..., 1] * vector[:, 1:]


def _widest(apart: Callable[[Numbers], FloatArray], n: int) -> tuple[FloatArray, FloatArray]:
    """The largest value over every eighth direction, then over those around the best of these."""
    rows = np.arange(n)
    best = _STRIDE * np.argmax(apart(np.tile(_COARSE, (n, 1))), axis=1)
    columns = (best[:, np.newaxis] + _FINE) % _N
    found = apart(columns)
    place = np.argmax(found, axis=1)
    return found[rows, place], DIRECTIONS[columns[rows, place]]
