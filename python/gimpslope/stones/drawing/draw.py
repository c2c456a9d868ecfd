"""Random stones: ellipses, rounds and polygons that keep their distance, drawn by a seed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..._check import FloatArray
from ...materials import Material
from ...outline import Outline
from ..collection import Stones
from ..ellipse import Ellipse
from ..rows import one_or_all, refuse_not_positive
from . import spread
from .amount import Amount, Size
from .layout import Layout
from .rounding import rounded
from .shapes import MOST_ASPECT, angles, irregular_polygons
from .sizes import Law
from .spread import Spread


def ellipses(
    outline: Outline,
    axes: npt.ArrayLike | Law,
    *,
    seed: int,
    count: int | None = None,
    content: float | None = None,
    points: int | None = None,
    spacing: float | None = None,
    gap: float = 0.1,
    margin: float | None = None,
    aspect: Spread | None = None,
    angle: npt.ArrayLike | None = None,
    tries: int = 100,
    material: Material | None = None,
) -> Stones:
    """Ellipses at random places in an outline.

    How many is said by exactly one of `count`, `content` and `points`, or by a list of axes; 0 or
    an empty list is none. The largest are placed first, each at one of some random places. When
    stones find none free, all are pushed apart until they keep the gap. The same seed gives the
    same stones on any machine.

    Parameters
    ----------
    outline : of the slope
    axes : full lengths of both axes, m: (2,) for all, (n, 2) for each of n, or a law of sizes, the
        diameters of the circles of equal area
    seed : of the random numbers, a whole number >= 0
    count : number of stones
    content : share of the outline's area, in [0, 1), met as nearly as whole stones can
    points : number of lattice points in stones, met exactly or within one by scaling the last, the
        smallest stones alike by a factor of 0.95 to 1.05, as few of them as it takes
    spacing : of the lattice, m, > 0; with `points` only
    gap : least distance between stones, m, >= 0
    margin : least distance from the edge of the outline, m, >= 0; None: the gap
    aspect : ratio of the axes, >= 1; with a law of sizes, and only then
    angle : from the x axis counterclockwise to the first axis, degrees, for all or (n,); None: any
    tries : random places that each stone tries before stones are pushed apart
    material : of all; None: what the scene names for stones that do not say

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range, or a number of points out of reach.
    StonesDoNotFit
        A ValueError, if places are not found for all stones; it says for how many they were.
    """
    amount = Amount(count, content, points, spacing)
    layout = Layout(outline, seed, gap, margin, tries)
    lengths = _axes(axes, aspect, amount, layout)
    turns = angles(angle, layout.rng, len(lengths))
    rows = zip(lengths.tolist(), turns.tolist(), strict=True)
    shapes = [Ellipse((0, 0), pair, turn) for pair, turn in rows]
    return layout.stones(shapes, amount, material)


def rounds(
    outline: Outline,
    diameter: Size,
    *,
    seed: int,
    count: int | None = None,
    content: float | None = None,
    points: int | None = None,
    spacing: float | None = None,
    gap: float = 0.1,
    margin: float | None = None,
    tries: int = 100,
    material: Material | None = None,
) -> Stones:
    """Round stones of one diameter (m), of a list (n,) or of a law; all else as in `ellipses`."""
    amount = Amount(count, content, points, spacing)
    layout = Layout(outline, seed, gap, margin, tries)
    sizes = amount.sizes("diameter", diameter, outline, layout.rng)
    shapes = [Ellipse((0, 0), (size, size)) for size in sizes.tolist()]
    return layout.stones(shapes, amount, material)


def polygons(
    outline: Outline,
    size: Size,
    *,
    seed: int,
    count: int | None = None,
    content: float | None = None,
    points: int | None = None,
    spacing: float | None = None,
    gap: float = 0.1,
    margin: float | None = None,
    corners: int | tuple[int, int] = (5, 9),
    roundness: Spread = 0.3,
    aspect: Spread = (1.0, 2.0),
    angle: npt.ArrayLike | None = None,
    tries: int = 100,
    material: Material | None = None,
) -> Stones:
    """Irregular polygons, each an `irregular.outline`; all that is not said here as in `ellipses`.

    The gap is kept by their convex hulls.

    Parameters
    ----------
    size : diameter of the circle of equal area, m: one, a list (n,) or a law
    corners : number of corners, >= 3, or the least and the largest number
    roundness : share of the sides that the rounding of corners takes, in [0, 1]
    aspect : ratio of the principal radii of gyration, >= 1
    angle : from the x axis counterclockwise to the longer of these, degrees, as in `ellipses`
    """
    amount = Amount(count, content, points, spacing)
    layout = Layout(outline, seed, gap, margin, tries)
    sizes = amount.sizes("size", size, outline, layout.rng)
    directions = angles(angle, layout.rng, len(sizes))
    shapes = irregular_polygons(sizes, directions, corners, roundness, aspect, outline, layout.rng)
    return layout.stones(shapes, amount, material)


def _axes(
    axes: npt.ArrayLike | Law, aspect: Spread | None, amount: Amount, layout: Layout
) -> FloatArray:
    """Full axes of each ellipse, m, shape (n, 2)."""
    if isinstance(axes, Law):
        if aspect is None:
            raise ValueError("aspect must be given where axes is a law of sizes, got None")
        sizes = amount.sizes("axes", axes, layout.outline, layout.rng)
        root = np.sqrt(spread.numbers("aspect", aspect, 1, MOST_ASPECT, layout.rng, len(sizes)))
        return rounded(np.stack([sizes * root, sizes / root], axis=1), layout.outline)
    if aspect is not None:
        raise ValueError(f"aspect must be None where axes is no law of sizes, got {aspect!r}")
    listed = one_or_all("axes", axes, (2,))
    refuse_not_positive("axes", listed)
    size = np.sqrt(listed[..., 0] * listed[..., 1])
    n = len(amount.sizes("axes", size, layout.outline, layout.rng))
    return np.broadcast_to(listed, (n, 2))
