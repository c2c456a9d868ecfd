"""Sections: the outline of a slope and its stones, out of the regions of an image or a mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from ... import _check
from ...materials import Material
from ...outline import Outline
from ..collection import Stones
from ..stone import Stone

Polygons = npt.NDArray[np.object_]

_MOST_SHOWN = 5


class Section(NamedTuple):
    """A slope cut open: `Scene(section.outline, soil, stones=section.stones, ...)`."""

    outline: Outline
    stones: Stones


def section(
    source: str, slope: Polygons, stones: Sequence[tuple[str, Polygons, Material | None]]
) -> Section:
    """The section whose slope has these pieces, m, with stones by groups of one material.

    In a group stones are numbered from the lowest up, and of two equally low from the left.
    `source` is the parameter that they come from, as refusals name it; they name the groups too.

    Raises
    ------
    ValueError
        If the slope is in several pieces or has holes, or if a stone has holes.
    """
    if len(slope) != 1:
        raise ValueError(
            f"{source} must show soil and stones in one piece, touching along edges, got "
            f"{len(slope)}: {_shown(slope)}"
        )
    _refuse_holes(f"{source} must show a slope without holes", slope)
    made = []
    for name, pieces, material in stones:
        _refuse_holes(f"{source} must show stones of {name} without anything inside", pieces)
        left, bottom = shapely.bounds(pieces).reshape(-1, 4).T[:2]
        ordered = pieces[np.lexsort((left, bottom))]
        made += [Stone(_outline(piece), material) for piece in ordered]
    return Section(_outline(slope[0]), Stones(made))


def materials_by_group(
    material: Material | Mapping[Any, Material] | None,
    groups: Sequence[int],
    number: Callable[[Any], int],
) -> list[Material | None]:
    """The material of each group of stones, where it is given for all or in a mapping by group.

    `number` gives the number of what the mapping has as a key, or refuses it.

    Raises
    ------
    TypeError, ValueError
        If something is no material, or is the material of what is no group of stones.
    """
    allowed = "a material, a mapping of groups of stones to materials, or None"
    _check.instance("material", material, Material | Mapping | None, allowed)
    if not isinstance(material, Mapping):
        return [material] * len(groups)
    found: dict[int, Material | None] = dict.fromkeys(groups)
    for group, kind in material.items():
        if found.get(number(group), kind) is not None:
            raise ValueError(
                f"material must have groups of stones, each once, got one of {group!r}"
            )
        found[number(group)] = _check.instance(f"material[{group!r}]", kind, Material, "a material")
    return list(found.values())


def _refuse_holes(allowed: str, pieces: Polygons) -> None:
    holed = pieces[shapely.get_num_interior_rings(pieces) > 0]
    if len(holed):
        rings = [ring for piece in holed for ring in piece.interiors]
        raise ValueError(f"{allowed}, got {_shown(shapely.polygons(rings))}")


def _shown(pieces: Polygons) -> str:
    """The largest pieces in words."""
    largest = sorted(pieces, key=shapely.area, reverse=True)
    words = [
        f"{piece.area:.3g} m2 near ({at.x:.4g}, {at.y:.4g})"
        for piece, at in zip(largest, shapely.point_on_surface(largest), strict=True)
    ]
    return ", ".join(words[:_MOST_SHOWN]) + (", ..." if len(words) > _MOST_SHOWN else "")


def _outline(piece: shapely.Polygon) -> Outline:
    return Outline(shapely.get_coordinates(piece))
