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
    reaches: FloatArray, first: Numbers, second: Numbers, offset: FloatArray, enough: float
) -> tuple[FloatArray, FloatArray]:
    """Distance of bodies, m, shape (m,), and the unit vectors (m, 2) from the first to the second.

    Negative where they overlap: how far to push them apart along the vector. Where it is `enough`,
    m, it may be told too small, but not below that.

    Parameters
    ----------
    reaches : of all bodies, m, shape (n, 256)
    first, second : numbers of the bodies, shape (m,)
    offset : from the first origin to the second, m, shape (m, 2)
    """

    def apart(rows: Numbers, columns: Numbers) -> FloatArray:
        opposite = (columns + _N // 2) % _N
        reach, other = reaches[first[rows, None], columns], reaches[second[rows, None], opposite]
        return _along(offset[rows], columns) - reach - other

    return _widest(apart, len(offset), enough)


def to_edges(
    reaches: FloatArray, number: Numbers, start: FloatArray, end: FloatArray, enough: float
) -> tuple[FloatArray, FloatArray]:
    """The same for bodies and edges, whose ends (m, 2) are given from the origins of the bodies."""

    def apart(rows: Numbers, columns: Numbers) -> FloatArray:
        nearer = np.minimum(_along(start[rows], columns), _along(end[rows], columns))
        return nearer - reaches[number[rows, None], columns]

    return _widest(apart, len(start), enough)


def _along(vector: FloatArray, columns: Numbers) -> FloatArray:
    direction = DIRECTIONS[columns]
    return direction[..., 0] * vector[:, :1] + direction[..., 1] * vector[:, 1:]


def _widest(
    apart: Callable[[Numbers, Numbers], FloatArray], n: int, enough: float
) -> tuple[FloatArray, FloatArray]:
    """The largest value over every eighth direction and, where that is not yet enough, over those
    around the best of these."""
    rows = np.arange(n)
    found = apart(rows, _COARSE)
    place = np.argmax(found, axis=1)
    widest, best = found[rows, place], _COARSE[place]
    near = np.flatnonzero(widest < enough)
    rows, columns = np.arange(len(near)), (best[near, None] + _FINE) % _N
    found = apart(near, columns)
    place = np.argmax(found, axis=1)
    widest[near], best[near] = found[rows, place], columns[rows, place]
    return widest, DIRECTIONS[best]
