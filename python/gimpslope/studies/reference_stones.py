"""The stones of the reference study: rounds, ovals, and irregular ones of mixed size.

The paper (Frontiers in Earth Science 2022, 10:968250) gives

* the round stones' diameter of 0.54 m and the ovals' axes of 0.86 and 0.34 m,
* 4,400 points in stones, of a lattice of 0.05 m, as in 48 of the rounds or of the ovals,
* that the irregular stones are of mixed size, some of them small, at the same content, and
* that "the initial position of the blocks are the same as possible".

It gives neither places nor angles nor irregular shapes. Chosen here are random places by a seed, at
least 0.1 m from each other and from the edge of the slope; random angles; and irregular stones that
have the area of the rounds in all: 48 larger ones of about 0.36 to 0.66 m at the places of the
rounds and along the ovals, and 32 small ones of about 0.16 to 0.28 m between them.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from .. import _check
from .._check import FloatArray
from ..outline import Outline
from ..stones import Ellipse, Shape, Stones, Uniform
from ..stones.drawing.placing import place
from ..stones.drawing.reach import reach
from ..stones.drawing.room import Room
from ..stones.drawing.rounding import rounded
from ..stones.drawing.shapes import angles, irregular_polygons, moved

DIAMETER = 0.54
"""Of the rounds, m; the paper's."""

AXES = (0.86, 0.34)
"""Full axes of the ovals, m; the paper's."""

POINTS, SPACING = 4400, 0.05
"""Points in stones, of a lattice of this spacing (m); the paper's."""

TOLERANCE = 10
"""Points by which a draw may differ from these."""

GAP = 0.1
"""Least distance of stones from each other and from the edge of the slope, m."""

COUNT, N_SMALL = 48, 32
"""Number of stones that share their places, and of small irregular ones beside them."""

_SLOPE = Outline.slope()
_LARGE, _SMALL = Uniform(0.36, 0.66), Uniform(0.16, 0.28)
_CORNERS, _ROUNDNESS, _ASPECT = (5, 9), 0.3, (1.0, 2.0)
_SHIFTS = (0.0, 0.01, -0.01, 0.02, -0.02)
_TRIES, _DRAWS = 200, 100
_COARSEST = 0.1


def stones(kind: str, seed: int = 1) -> Stones:
    """Stones of the study's slope, `Outline.slope()`, for any material.

    Of one seed, all three kinds have their first 48 centres in common, but for rounding. The sizes
    of rounds and ovals are exact. Each stone holds a point of the lattice of 0.1 m, that of a cell
    of 0.2 m, so that the study can be run on such a grid.

    Parameters
    ----------
    kind : "arbitrary", "round" or "oval"
    seed : of the places, the angles and the irregular shapes, a whole number >= 0
    """
    _check.one_of("kind", kind, ("arbitrary", "round", "oval"))
    return _draw(_check.whole("seed", seed, 0))[kind]


@lru_cache(maxsize=16)
def _draw(seed: int) -> Mapping[str, Stones]:
    """The three kinds, moved together by less than a spacing so that all have their points.

    Where no such move does it, all is drawn anew by the random numbers that follow.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    for _ in range(_DRAWS):
        shapes = _shapes(rng)
        places = _places(shapes, rng)
        for shift in itertools.product(_SHIFTS, repeat=2):
            at = rounded(places + shift, _SLOPE)
            kinds = {
                kind: Stones([moved(shape, where) for shape, where in zip(some, at, strict=False)])
                for kind, some in shapes.items()
            }
            if all(_has_its_points(found) for found in kinds.values()):
                return MappingProxyType(kinds)
    raise RuntimeError(f"stones must hold {POINTS} points, got no such of {_DRAWS} draws by {seed}")


def _shapes(rng: np.random.Generator) -> dict[str, list[Shape]]:
    """Shapes about the origin; the first 48 of each kind share their places, the rest is small."""
    large, small = _LARGE.quantile(rng.random(COUNT)), _SMALL.quantile(rng.random(N_SMALL))
    sizes = np.concatenate([large, small])
    sizes *= np.sqrt(COUNT * DIAMETER**2 / np.square(sizes).sum())
    turns = angles(None, rng, len(sizes))
    return {
        "round": [Ellipse((0, 0), (DIAMETER, DIAMETER))] * COUNT,
        "oval": [Ellipse((0, 0), AXES, turn) for turn in turns[:COUNT].tolist()],
        "arbitrary": list(
            irregular_polygons(sizes, turns, _CORNERS, _ROUNDNESS, _ASPECT, _SLOPE, rng)
        ),
    }


def _places(shapes: Mapping[str, list[Shape]], rng: np.random.Generator) -> FloatArray:
    """Places (n, 2), m, of which the first 48 suit a stone of any kind."""
    reaches = np.array([reach(shape) for shape in shapes["arbitrary"]])
    for kind in ("round", "oval"):
        reaches[:COUNT] = np.maximum(reaches[:COUNT], [reach(shape) for shape in shapes[kind]])
    # Never less than the area of the convex shape of this reach, and in the order of their sizes.
    areas = np.pi * np.square(reaches).mean(axis=1)
    order = np.argsort(-areas, kind="stable")
    room = Room(_SLOPE, reaches[order], GAP, GAP + math.hypot(max(_SHIFTS), max(_SHIFTS)))
    places = np.empty((len(areas), 2))
    places[order] = place(room, areas[order], rng, _TRIES)
    return places


def _has_its_points(stones: Stones) -> bool:
    in_stones = int((stones.numbers(_lattice(SPACING)) >= 0).sum())
    held = np.unique(stones.numbers(_lattice(_COARSEST)))
    return abs(in_stones - POINTS) <= TOLERANCE and len(held[held >= 0]) == len(stones)


@lru_cache(maxsize=2)
def _lattice(spacing: float) -> FloatArray:
    return _SLOPE.lattice(spacing)
