"""Stones scaled a little until a wanted number of lattice points is in stones."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from ..._check import FloatArray
from ..stone import Shape
from .shapes import moved

SCALE = 0.05
"""Share by which the last stones grow or shrink, at most, to meet a number of points."""

_STEPS = 50_000
_SIGMAS = 4


def n_scalable(areas: FloatArray, wanted: int, spacing: float) -> int:
    """How many of the last stones need room to grow if the points are to be met wherever they lie.

    With the areas in m2, shape (n,). The number of points of unit spacing in a circle of radius r
    varies with its place by a standard deviation of sqrt(0.676 r) (Kendall, Quart. J. Math. 19
    (1948) 1); four times that of all stones is allowed for.
    """
    radii = np.sqrt(areas / math.pi) / spacing
    lack = abs(wanted - areas.sum() / spacing**2) + _SIGMAS * math.sqrt(0.676 * radii.sum())
    within_reach = np.cumsum(areas[::-1]) * (1 - (1 - SCALE) ** 2) / spacing**2
    return min(len(areas), 1 + int(np.searchsorted(within_reach, lack)))


def factors(
    shapes: Sequence[Shape], places: FloatArray, lattice: FloatArray, held: int, wanted: int
) -> FloatArray:
    """Factors (n,) that take the points in stones from `held` to `wanted`, but for one.

    As few of the stones as it takes, from the first on, have the same factor of 0.95 to 1.05.

    Parameters
    ----------
    shapes : of the stones, about the origin
    places : of these, m, shape (n, 2)
    lattice : points of the outline, m, shape (k, 2)

    Raises
    ------
    ValueError
        If there are no such factors.
    """
    more = wanted - held
    if more == 0:
        return np.ones(len(shapes))
    inside = [_counter(*stone, lattice) for stone in zip(shapes, places, strict=True)]
    now, least, most = (
        np.array([count(scale) for count in inside]) for scale in (0, -_STEPS, _STEPS)
    )
    lowest, highest = np.cumsum(least - now), np.cumsum(most - now)
    for allowed in (0, 1):
        for last in np.flatnonzero((lowest <= more) & (more <= highest)):
            step, excess = _bisected(inside[: last + 1], more + int(now[: last + 1].sum()))
            if abs(excess) <= allowed:
                return np.where(np.arange(len(shapes)) <= last, 1 + step * SCALE / _STEPS, 1.0)
    raise ValueError(
        f"points must be within reach of scaling the last {len(shapes)} stones by {1 - SCALE} to "
        f"{1 + SCALE}, which gives {held + lowest[-1]} to {held + highest[-1]}, got {wanted}"
    )


def _counter(shape: Shape, place: FloatArray, lattice: FloatArray) -> Callable[[int], int]:
    """The number of points in a stone scaled by so many steps."""
    left, bottom, right, top = moved(shape, place, 1 + 2 * SCALE).bounds
    near = lattice[np.all((lattice >= (left, bottom)) & (lattice <= (right, top)), axis=1)]

    def count(step: int) -> int:
        return int(moved(shape, place, 1 + step * SCALE / _STEPS).contains(near).sum())

    return count


def _bisected(inside: Sequence[Callable[[int], int]], wanted: int) -> tuple[int, int]:
    """The step at which the points in all come nearest to those wanted, and how many are too many.

    The points at the least step are not more than those wanted, at the largest not fewer.
    """
    low, high = -_STEPS, _STEPS
    while high - low > 1:
        step = (low + high) // 2
        if sum(count(step) for count in inside) <= wanted:
            low = step
        else:
            high = step
    excess = {step: sum(count(step) for count in inside) - wanted for step in (low, high)}
    step = min(excess, key=lambda step: abs(excess[step]))
    return step, excess[step]
