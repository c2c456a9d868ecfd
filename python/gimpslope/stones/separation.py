"""Ellipses against ellipses and edges: how far to scale until they touch, how far they are apart.

An ellipse is given by its half axes as the columns of a matrix S; its reach along a direction n is
h(n) = |S^T n|, its point furthest that way S S^T n / h. The tangents of two convex shapes across a
unit vector n are some distance apart; the largest such distance is that of the shapes. It is found
by bisection, from a direction in which they are known to be apart, with an error of rounding.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .._check import FloatArray

_HALVINGS = 60


def ellipse_scale(first: FloatArray, second: FloatArray, offset: FloatArray) -> FloatArray:
    """The factor by which two ellipses grow about their centres until they touch, shape (m,).

    It is below 1 where they overlap, and 0 where they share their centre.

    Parameters
    ----------
    first, second : half axes, m, shape (m, 2, 2)
    offset : from the first centre to the second, m, shape (m, 2)
    """
    return _meeting(first, second, offset)[0]


def ellipse_distance(first: FloatArray, second: FloatArray, offset: FloatArray) -> FloatArray:
    """Distance of two ellipses, m, shape (m,), 0 where they overlap; takes what `ellipse_scale`
    takes."""
    factor, normal = _meeting(first, second, offset)
    apart = factor > 1
    first, second, offset = first[apart], second[apart], offset[apart]

    def between(n: FloatArray) -> FloatArray:
        return offset - _furthest(first, n) - _furthest(second, n)

    distance = np.zeros(len(factor))
    distance[apart] = _widest(between, normal[apart])
    return distance


def edge_scale(ellipse: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """The factor by which an ellipse about the origin grows until it touches an edge, shape (m,).

    Parameters
    ----------
    ellipse : half axes, m, shape (m, 2, 2)
    start, end : of the edges, m, shape (m, 2)
    """
    return _meeting_edge(ellipse, start, end)[0]


def edge_distance(ellipse: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Distance of an ellipse about the origin from an edge, m, shape (m,), 0 where the edge cuts
    it; takes what `edge_scale` takes."""
    factor, normal = _meeting_edge(ellipse, start, end)
    apart = factor > 1
    ellipse, start, end = ellipse[apart], start[apart], end[apart]

    def between(n: FloatArray) -> FloatArray:
        nearer = np.where((_dot(start, n) < _dot(end, n))[:, np.newaxis], start, end)
        return nearer - _furthest(ellipse, n)

    distance = np.zeros(len(factor))
    distance[apart] = _widest(between, normal[apart])
    return distance


def _meeting(
    first: FloatArray, second: FloatArray, offset: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The factor of `ellipse_scale`, and the normal (m, 2), of any length, where they then touch.

    With r the offset it is the largest r.n / (h1(n) + h2(n)) over n. The best n is C^-1 r, with
    C = (1 - l) S1 S1^T + l S2 S2^T, for the l in [0, 1] where the two grown ellipses meet, that is
    (1 - l) h1(n) = l h2(n) (Perram & Wertheim, J. Comput. Phys. 58 (1985) 409).
    """
    low, high = np.zeros(len(offset)), np.ones(len(offset))
    for _ in range(_HALVINGS):
        weight = (low + high) / 2
        normal = _solve(first, second, weight, offset)
        more = (1 - weight) * _reach(first, normal) > weight * _reach(second, normal)
        low, high = np.where(more, weight, low), np.where(more, high, weight)
    apart, width = _dot(offset, normal), _reach(first, normal) + _reach(second, normal)
    return np.divide(apart, width, out=np.zeros_like(apart), where=width > 0), normal


def _meeting_edge(
    ellipse: FloatArray, start: FloatArray, end: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The factor of `edge_scale`, and the normal (m, 2), of any length, where they then touch: the
    distance of the edge from the origin in the frame where the ellipse is the unit circle."""
    to_circle = ellipse / np.hypot(ellipse[:, :1], ellipse[:, 1:]) ** 2
    start, end = (_product(to_circle.swapaxes(1, 2), corner) for corner in (start, end))
    along = end - start
    share = np.clip(-_dot(start, along) / _dot(along, along), 0, 1)
    nearest = start + share[:, np.newaxis] * along
    return np.hypot(*nearest.T), _product(to_circle, nearest)


def _widest(between: Callable[[FloatArray], FloatArray], normal: FloatArray) -> FloatArray:
    """The largest n.v(n) over unit vectors n, where v leads from one shape's point furthest along n
    to the other's furthest against it, for shapes that `normal` separates.

    Where n.v > 0 it has a single maximum, and its slope as n turns is t.v with t across n.
    """
    normal = normal / np.hypot(*normal.T)[:, np.newaxis]
    across = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    across = across * np.where(_dot(across, between(normal)) < 0, -1, 1)[:, np.newaxis]
    low, high = np.zeros(len(normal)), np.full(len(normal), np.pi)
    for _ in range(_HALVINGS):
        turn = (low + high) / 2
        cos, sin = np.cos(turn)[:, np.newaxis], np.sin(turn)[:, np.newaxis]
        turned, tangent = cos * normal + sin * across, cos * across - sin * normal
        vector = between(turned)
        rising = (_dot(turned, vector) > 0) & (_dot(tangent, vector) > 0)
        low, high = np.where(rising, turn, low), np.where(rising, high, turn)
    cos, sin = np.cos(low)[:, np.newaxis], np.sin(low)[:, np.newaxis]
    best = cos * normal + sin * across
    return _dot(best, between(best))


def _solve(
    first: FloatArray, second: FloatArray, weight: FloatArray, right: FloatArray
) -> FloatArray:
    """C^-1 times the right side but for the determinant, which has no bearing on a direction."""
    weight = weight[:, np.newaxis, np.newaxis]
    matrix = (1 - weight) * _square(first) + weight * _square(second)
    x, y = right.T
    return np.stack(
        [
            matrix[:, 1, 1] * x - matrix[:, 0, 1] * y,
            matrix[:, 0, 0] * y - matrix[:, 0, 1] * x,
        ],
        axis=1,
    )


def _square(half: FloatArray) -> FloatArray:
    """S S^T, shape (m, 2, 2)."""
    return _dot(half[:, :, np.newaxis], half[:, np.newaxis])


def _reach(half: FloatArray, normal: FloatArray) -> FloatArray:
    reach: FloatArray = np.hypot(*_product(half.swapaxes(1, 2), normal).T)
    return reach


def _furthest(half: FloatArray, normal: FloatArray) -> FloatArray:
    along = _product(half.swapaxes(1, 2), normal)
    return _product(half, along / np.hypot(*along.T)[:, np.newaxis])


def _product(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    return _dot(matrix, vector[:, np.newaxis])


def _dot(first: FloatArray, second: FloatArray) -> FloatArray:
    product: FloatArray = np.sum(first * second, axis=-1)
    return product
