"""Ellipses: the other shape of a stone, beside polygons."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import shapely

from .. import _check
from .._check import FloatArray
from .._record import Record

_EDGE = 1e-9
_CORNERS = 256


@dataclass(frozen=True)
class Ellipse(Record):
    """An ellipse.

    Parameters
    ----------
    centre : x and y, m
    axes : full lengths of its two axes, m, each > 0
    angle : from the x axis counterclockwise to the first axis, degrees

    Raises
    ------
    TypeError, ValueError
        If a parameter is not made of finite numbers, or an axis is not > 0.
    """

    centre: tuple[float, float]
    axes: tuple[float, float]
    angle: float = 0.0

    def __post_init__(self) -> None:
        x, y = _check.array("centre", self.centre, (2,)).tolist()
        first, second = _check.array("axes", self.axes, (2,)).tolist()
        self._store(
            centre=(x, y),
            axes=(_check.positive("axes[0]", first), _check.positive("axes[1]", second)),
            angle=_check.finite("angle", self.angle),
        )

    @property
    def half_axes(self) -> FloatArray:
        """Both half axes as vectors, the columns of a matrix that takes the unit circle to the
        ellipse about the origin, m, shape (2, 2)."""
        turn = math.radians(self.angle)
        cos, sin = math.cos(turn), math.sin(turn)
        return np.array([[cos, -sin], [sin, cos]]) * np.divide(self.axes, 2)

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """An inscribed polygon of 256 corners, m; its area is 1e-4 smaller."""
        turns = np.linspace(0, 2 * np.pi, _CORNERS, endpoint=False)
        circle = np.stack([np.cos(turns), np.sin(turns)])
        polygon = shapely.Polygon((self.half_axes @ circle).T + self.centre)
        shapely.prepare(polygon)
        return polygon

    @property
    def area(self) -> float:
        """Area, m2."""
        return math.pi / 4 * self.axes[0] * self.axes[1]

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre, m."""
        return self.centre

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box (x_min, y_min, x_max, y_max), m."""
        (x, y), (width, height) = self.centre, np.hypot(*self.half_axes.T).tolist()
        return x - width, y - height, x + width, y + height

    def contains(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether each of the points (n, 2), m, is inside or on the edge, shape (n,).

        On the edge means within 1e-9 of the longer axis.
        """
        x, y = (_check.array("points", points, ("n", 2)) - self.centre).T
        edge = _EDGE * max(self.axes)
        square = np.zeros_like(x)
        for (x_axis, y_axis), axis in zip(self.half_axes.T, self.axes, strict=True):
            square += ((x_axis * x + y_axis * y) / (axis / 2 * (axis / 2 + edge))) ** 2
        inside: npt.NDArray[np.bool_] = square <= 1
        return inside
