"""One stone: a shape and what it is made of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .. import _check
from .._record import Record
from ..materials import Material
from ..outline import Outline
from .ellipse import Ellipse

Shape = Outline | Ellipse


@dataclass(frozen=True)
class Stone(Record):
    """A stone in a slope.

    Parameters
    ----------
    shape : an Outline or an Ellipse
    material : what it is made of; None: what the scene names for stones that do not say

    Raises
    ------
    TypeError
        If a parameter is of another type.
    """

    shape: Shape
    material: Material | None = None

    def __post_init__(self) -> None:
        _check.instance("shape", self.shape, Shape, "an Outline or an Ellipse")
        if self.material is not None:
            _check.instance("material", self.material, Material, "a material or None")

    @property
    def area(self) -> float:
        """Area, m2."""
        return self.shape.area

    @property
    def size(self) -> float:
        """Diameter of the circle of equal area, m."""
        return math.sqrt(4 / math.pi * self.area)

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre of gravity, m."""
        if isinstance(self.shape, Ellipse):
            return self.shape.centre
        centre = self.shape.polygon.centroid
        return centre.x, centre.y

    def contains(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether each of the points (n, 2), m, is inside or on the edge, shape (n,)."""
        return self.shape.contains(points)
