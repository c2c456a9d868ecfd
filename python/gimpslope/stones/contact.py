"""Whether shapes overlap or leave an outline, and how far they are apart, for many at a time.

Polygons by shapely, whatever has an ellipse in it by the ellipse's own equation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import shapely

from .._check import FloatArray
from ..outline import Outline
from .ellipse import Ellipse
from .separation import edge_distance, edge_scale, ellipse_distance, ellipse_scale
from .stone import Shape

_SLIVER = 1e-9

Flags = npt.NDArray[np.bool_]
Pair = tuple[Shape, Shape]


def overlap(pairs: Sequence[Pair]) -> Flags:
    """Whether the two shapes of each pair overlap, shape (k,).

    They may touch: up to 1e-9 of the smaller area is rounding; where one is an ellipse, up to 1e-9
    of its axes.
    """
    return _by_kind(pairs, _ellipses_overlap, _ellipses_meet, _polygons_overlap).astype(np.bool_)


def distance(pairs: Sequence[Pair]) -> FloatArray:
    """Distance of the two shapes of each pair, m, shape (k,); 0 where they overlap."""
    return _by_kind(pairs, _between_ellipses, _from_ellipses, _between_polygons)


def within(shapes: Sequence[Shape], outline: Outline) -> Flags:
    """Whether each of the shapes lies in the outline, but for 1e-9 of its area or axes, (n,)."""

    def ellipses(found: list[Ellipse]) -> Flags:
        centres = np.array([ellipse.centre for ellipse in found]).reshape(-1, 2)
        clear = _to_edges(edge_scale, found, [outline] * len(found)) >= 1 - _SLIVER
        return clear & outline.contains(centres)

    def polygons(found: list[Outline]) -> Flags:
        areas = shapely.area(_geometry(found))
        beyond = shapely.area(shapely.difference(_geometry(found), outline.polygon))
        return np.asarray(beyond <= _SLIVER * areas)

    return _by_shape(shapes, ellipses, polygons).astype(np.bool_)


def edge_distances(shapes: Sequence[Shape], outline: Outline) -> FloatArray:
    """Distance of each of the shapes from the edge of the outline, m, shape (n,); 0 where it
    crosses the edge."""

    def ellipses(found: list[Ellipse]) -> FloatArray:
        return _to_edges(edge_distance, found, [outline] * len(found))

    def polygons(found: list[Outline]) -> FloatArray:
        return np.asarray(shapely.distance(_geometry(found), outline.polygon.exterior))

    return _by_shape(shapes, ellipses, polygons)


def _by_shape(
    shapes: Sequence[Shape],
    ellipses: Callable[[list[Ellipse]], npt.NDArray[np.generic]],
    polygons: Callable[[list[Outline]], npt.NDArray[np.generic]],
) -> FloatArray:
    round_ones = np.array([isinstance(shape, Ellipse) for shape in shapes], dtype=np.bool_)
    result = np.empty(len(shapes))
    result[round_ones] = ellipses([shape for shape in shapes if isinstance(shape, Ellipse)])
    result[~round_ones] = polygons([shape for shape in shapes if isinstance(shape, Outline)])
    return result


def _by_kind(
    pairs: Sequence[Pair],
    ellipses: Callable[[Any, Any], npt.NDArray[np.generic]],
    mixed: Callable[[Any, Any], npt.NDArray[np.generic]],
    polygons: Callable[[Any, Any], npt.NDArray[np.generic]],
) -> FloatArray:
    """The results of three functions for the pairs of three kinds, in the order of the pairs."""
    result = np.empty(len(pairs))
    numbers: list[list[int]] = [[], [], []]
    for number, pair in enumerate(pairs):
        numbers[sum(isinstance(shape, Outline) for shape in pair)].append(number)
    for found, measure in zip(numbers, (ellipses, mixed, polygons), strict=True):
        # An ellipse comes before a polygon.
        ordered = [sorted(pairs[n], key=lambda s: isinstance(s, Outline)) for n in found]
        result[found] = measure(*([pair[side] for pair in ordered] for side in (0, 1)))
    return result


def _ellipses_overlap(first: list[Ellipse], second: list[Ellipse]) -> Flags:
    flags: Flags = ellipse_scale(*_axes_and_offset(first, second)) < 1 - _SLIVER
    return flags


def _ellipses_meet(ellipses: list[Ellipse], polygons: list[Outline]) -> Flags:
    centred = [p.contains([e.centre])[0] for e, p in zip(ellipses, polygons, strict=True)]
    cut = _to_edges(edge_scale, ellipses, polygons) < 1 - _SLIVER
    return cut | np.array(centred, dtype=np.bool_)


def _polygons_overlap(first: list[Outline], second: list[Outline]) -> Flags:
    smaller = np.minimum(shapely.area(_geometry(first)), shapely.area(_geometry(second)))
    shared = shapely.area(shapely.intersection(_geometry(first), _geometry(second)))
    return np.asarray(shared > _SLIVER * smaller)


def _between_ellipses(first: list[Ellipse], second: list[Ellipse]) -> FloatArray:
    return ellipse_distance(*_axes_and_offset(first, second))


def _from_ellipses(ellipses: list[Ellipse], polygons: list[Outline]) -> FloatArray:
    apart = _to_edges(edge_distance, ellipses, polygons)
    return np.where(_ellipses_meet(ellipses, polygons), 0, apart)


def _between_polygons(first: list[Outline], second: list[Outline]) -> FloatArray:
    return np.asarray(shapely.distance(_geometry(first), _geometry(second)))


def _to_edges(
    measure: Callable[[FloatArray, FloatArray, FloatArray], FloatArray],
    ellipses: Sequence[Ellipse],
    outlines: Sequence[Outline],
) -> FloatArray:
    """The least `measure` of each ellipse and the edges of the outline beside it, shape (k,)."""
    if not ellipses:
        return np.empty(0)
    counts = [len(outline.vertices) for outline in outlines]
    both = list(zip(ellipses, outlines, strict=True))
    start = np.concatenate([outline.vertices - e.centre for e, outline in both])
    end = np.concatenate([np.roll(outline.vertices, -1, axis=0) - e.centre for e, outline in both])
    axes = np.repeat([ellipse.half_axes for ellipse in ellipses], counts, axis=0)
    least: FloatArray = np.minimum.reduceat(measure(axes, start, end), np.cumsum([0, *counts[:-1]]))
    return least


def _axes_and_offset(
    first: list[Ellipse], second: list[Ellipse]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    axes = [np.array([e.half_axes for e in side]).reshape(-1, 2, 2) for side in (first, second)]
    centres = [np.array([e.centre for e in side]).reshape(-1, 2) for side in (first, second)]
    return axes[0], axes[1], centres[1] - centres[0]


def _geometry(outlines: Sequence[Outline]) -> npt.NDArray[np.object_]:
    return np.array([outline.polygon for outline in outlines], dtype=object)
