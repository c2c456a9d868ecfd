"""Irregular outlines: polygons of random corners, of given aspect and roundness, of unit area.

Nothing here calls a sine, a matrix product or a solver, whose last digits differ between machines,
so that the same random numbers give the same outline everywhere.
"""

from __future__ import annotations

import numpy as np

from ... import _check
from ..._check import FloatArray

_SHAKE = 0.3
_LEAST_RADIUS = 0.55
_ARC_SEGMENTS = 48
_SHORTEST_ARC = 1e-6


def outline(rng: np.random.Generator, corners: int, roundness: float, aspect: float) -> FloatArray:
    """A random outline of area 1 with its centroid at the origin and its long axis along x.

    One corner lies in each of `corners` sectors around a centre, at a random angle and distance, so
    that the polygon does not cross itself; dents are shallow. Each corner is then replaced by a
    quadratic Bezier arc that starts and ends at `roundness` / 2 of its two sides.

    Parameters
    ----------
    rng : its `random` is called, in the same way whatever the roundness and aspect
    corners : number of corners, >= 3
    roundness : share of each side that the arcs at its ends take up, in [0, 1]. At 0 the corners
        are sharp; at 1 the arcs join to the closed quadratic B-spline of the corners. Within 1e-6
        of 0 or 1 counts as such
    aspect : ratio of the principal radii of gyration, >= 1 and met exactly; that of an ellipse is
        the ratio of its axes, that of a rectangle the ratio of its sides

    Returns
    -------
    vertices counterclockwise, shape (k, 2); k is `corners` for sharp corners

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range.
    """
    _check.instance("rng", rng, np.random.Generator, "a numpy.random.Generator")
    corners = _check.whole("corners", corners, 3)
    roundness = _check.in_range("roundness", roundness, 0, 1)
    aspect = _check.finite("aspect", aspect, "a finite number >= 1")
    if aspect < 1:
        raise ValueError(f"aspect must be a finite number >= 1, got {aspect}")
    vertices = _corners(rng, corners)
    turn = _direction(rng.random(1))
    if roundness > _SHORTEST_ARC:
        vertices = _rounded(vertices, roundness)
    return _stretched(_isotropic(vertices), turn[0], aspect)


def _corners(rng: np.random.Generator, corners: int) -> FloatArray:
    """One corner in each sector, at a random angle and distance."""
    angle, distance = rng.random((2, corners))
    # A corner at cos(2 pi / n), about 1 - 20 / n^2, between two at 1 is level with them.
    least = max(_LEAST_RADIUS, 1 - 20 / corners**2)
    direction = _direction((np.arange(corners) + _SHAKE * (2 * angle - 1)) / corners)
    corner: FloatArray = direction * (least + (1 - least) * distance)[:, np.newaxis]
    return corner


def _direction(turn: FloatArray) -> FloatArray:
    """Unit vectors (n, 2), counterclockwise as `turn` goes from 0 to 1.

    They point at equal steps along the diamond |x| + |y| = 1, at most 4.1 degrees off equal angles.
    """
    quarters = 4 * (turn - np.floor(turn))
    y = 1 - np.abs(1 - quarters)
    y[quarters > 2] = np.abs(quarters[quarters > 2] - 3) - 1
    x = np.abs(quarters - 2) - 1
    direction: FloatArray = np.stack([x, y], axis=1) / np.sqrt(x * x + y * y)[:, np.newaxis]
    return direction


def _rounded(corners: FloatArray, roundness: float) -> FloatArray:
    """The polygon with an arc in place of each corner; where two arcs meet, the vertex is one."""
    before = corners + roundness / 2 * (np.roll(corners, 1, axis=0) - corners)
    after = corners + roundness / 2 * (np.roll(corners, -1, axis=0) - corners)
    segments = max(4, -(-_ARC_SEGMENTS // len(corners)))
    t = (np.arange(segments + (roundness < 1 - _SHORTEST_ARC)) / segments)[:, np.newaxis]
    arcs = (
        (1 - t) ** 2 * before[:, np.newaxis]
        + 2 * t * (1 - t) * corners[:, np.newaxis]
        + t**2 * after[:, np.newaxis]
    )
    return arcs.reshape(-1, 2)


def _isotropic(vertices: FloatArray) -> FloatArray:
    """The polygon moved and stretched to centroid 0, area 1 and equal second moments of area."""
    area, centroid, _ = _moments(vertices)
    vertices = vertices - centroid
    _, _, (xx, xy, yy) = _moments(vertices)
    # The inverse of the Cholesky factor of the second moments takes them to the unit matrix.
    shear, height = xy / xx, np.sqrt(yy - xy * xy / xx)
    x, y = vertices[:, 0] / np.sqrt(xx), (vertices[:, 1] - shear * vertices[:, 0]) / height
    isotropic: FloatArray = np.stack([x, y], axis=1) * np.sqrt(np.sqrt(xx) * height / area)
    return isotropic


def _moments(vertices: FloatArray) -> tuple[float, FloatArray, tuple[float, float, float]]:
    """Area, centroid and second moments of area of a polygon around the origin, by its edges.

    Green's theorem; e.g. Steger, "On the calculation of arbitrary moments of polygons" (1996).
    """
    x, y = vertices[:, 0], vertices[:, 1]
    following = np.roll(vertices, -1, axis=0)
    u, v = following[:, 0], following[:, 1]
    cross = x * v - u * y
    area = cross.sum() / 2
    centroid = np.array([((x + u) * cross).sum(), ((y + v) * cross).sum()]) / (6 * area)
    xx = ((x * x + x * u + u * u) * cross).sum() / 12
    yy = ((y * y + y * v + v * v) * cross).sum() / 12
    xy = ((2 * x * y + x * v + u * y + 2 * u * v) * cross).sum() / 24
    return area, centroid, (xx, xy, yy)


def _stretched(vertices: FloatArray, turn: FloatArray, aspect: float) -> FloatArray:
    """The polygon turned by the angle of a unit vector, then stretched along x by the aspect."""
    x = turn[0] * vertices[:, 0] - turn[1] * vertices[:, 1]
    y = turn[1] * vertices[:, 0] + turn[0] * vertices[:, 1]
    return np.stack([x * np.sqrt(aspect), y / np.sqrt(aspect)], axis=1)
