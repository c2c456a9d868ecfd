"""The rigid motion of each stone that meets that of its points best."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._check import FloatArray


class RigidMotion(NamedTuple):
    """The rigid motion of s stones that meets that of their points best.

    Attributes
    ----------
    before, after : centre of mass, m, shape (s, 2)
    rotation : in (-180, 180], counterclockwise, degrees, shape (s,); NaN for a stone of one point
    misfit : root mean square distance, by mass, of the points from where the rigid motion takes
        them, m, shape (s,)
    """

    before: FloatArray
    after: FloatArray
    rotation: FloatArray
    misfit: FloatArray


def rigid_motion(
    stone: npt.NDArray[np.int32],
    mass: FloatArray,
    before: FloatArray,
    after: FloatArray,
    count: int,
) -> RigidMotion:
    """The rigid motions of `count` stones from `before` to `after`, by least squares over mass.

    In the plane the rotation about the centres of mass is atan2(sum m (a x b), sum m (a . b)), for
    arms a before and b after (Kabsch 1976, Acta Cryst. A 32:922).

    Parameters
    ----------
    stone : number of the stone of each point, -1 in none, shape (n,)
    mass : kg/m, shape (n,)
    before, after : positions, m, shape (n, 2)
    count : number of stones

    Raises
    ------
    ValueError
        If a stone has no point.
    """
    part = stone >= 0
    stone, mass = stone[part], mass[part]
    points = np.bincount(stone, minlength=count)
    if (points == 0).any():
        raise ValueError(
            f"stone must name each of the {count} stones for a point, got none in "
            f"stones[{np.argmin(points)}]"
        )
    whole = np.bincount(stone, mass, count)

    def mean(values: FloatArray) -> FloatArray:
        """Mean over each stone by mass."""
        averages: FloatArray = np.bincount(stone, mass * values, count) / whole
        return averages

    start, end = (np.column_stack([mean(x), mean(y)]) for x, y in (before[part].T, after[part].T))
    (ax, ay), (bx, by) = (before[part] - start[stone]).T, (after[part] - end[stone]).T
    angle = np.arctan2(mean(ax * by - ay * bx), mean(ax * bx + ay * by))
    cos, sin = np.cos(angle)[stone], np.sin(angle)[stone]
    misfit = np.sqrt(mean((bx - cos * ax + sin * ay) ** 2 + (by - sin * ax - cos * ay) ** 2))
    rotation = np.where(points > 1, np.degrees(angle), np.nan)
    return RigidMotion(start, end, rotation, misfit)
