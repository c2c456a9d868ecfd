"""Shapes about the origin, before they have places."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ..._check import FloatArray
from ...outline import Outline
from ..ellipse import Ellipse
from ..rows import for_each
from ..stone import Shape
from . import irregular, spread
from .rounding import rounded
from .spread import Spread

MOST_ASPECT = 100.0
"""Beyond this a stone is a needle, and distances that err to the safe side err too much."""

_DECIMALS_OF_ANGLE = 6


def angles(angle: npt.ArrayLike | None, rng: np.random.Generator, n: int) -> FloatArray:
    """One angle for all, those of an array (n,) or any in [0, 180), degrees, shape (n,)."""
    if angle is None:
        random: FloatArray = np.round(180 * rng.random(n), _DECIMALS_OF_ANGLE)
        return random
    return for_each("angle", angle, n, ())


def irregular_polygons(
    sizes: FloatArray,
    directions: FloatArray,
    corners: int | tuple[int, int],
    roundness: Spread,
    aspect: Spread,
    outline: Outline,
    rng: np.random.Generator,
) -> list[Outline]:
    """An `irregular.outline` for each size (m) and direction (degrees), rounded to the digits that
    lengths have in the outline of the slope; all else as in `polygons`."""
    n = len(sizes)
    looks = (
        spread.whole_numbers("corners", corners, 3, rng, n).tolist(),
        spread.numbers("roundness", roundness, 0, 1, rng, n),
        spread.numbers("aspect", aspect, 1, MOST_ASPECT, rng, n),
    )
    made = []
    for size, direction, *look in zip(sizes, directions, *looks, strict=True):
        vertices = math.sqrt(math.pi / 4) * size * irregular.outline(rng, *look)
        made.append(Outline(rounded(_turned(vertices, direction), outline)))
    return made


def moved(shape: Shape, place: FloatArray, factor: float = 1.0) -> Shape:
    """A shape scaled by a factor, at a place (2,), m."""
    if isinstance(shape, Ellipse):
        x, y = place.tolist()
        return Ellipse((x, y), (factor * shape.axes[0], factor * shape.axes[1]), shape.angle)
    return Outline(factor * shape.vertices + place)


def _turned(vertices: FloatArray, angle: float) -> FloatArray:
    turn = math.radians(angle)
    cos, sin = math.cos(turn), math.sin(turn)
    x, y = vertices.T
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
