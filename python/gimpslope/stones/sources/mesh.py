"""Slopes with stones out of meshes: groups of cells become outlines along their sides."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import shapely

from ... import _check
from ...materials import Material
from .cells import GMSH, Cells, Group, read_cells
from .section import Polygons, Section, materials_by_group, section

if TYPE_CHECKING:
    import meshio

_ROUNDING = 1e-9
_SOIL, _NONE = -1, -2


def from_mesh(
    mesh: str | PathLike[str] | meshio.Mesh,
    *,
    soil: Group,
    stones: Group | Iterable[Group],
    cell_data: str = GMSH,
    material: Material | Mapping[Group, Material] | None = None,
) -> Section:
    """The outline of a slope and its stones from a mesh with groups of cells.

    Cells of one group that share sides are one stone; cells of different groups are different
    stones. Outlines follow the sides of the cells.

    Parameters
    ----------
    mesh : path of a file that meshio reads, or its mesh, of triangles and quads with straight
        sides in a plane of x and y, m, that meet side to side. Lines and vertices do not count
    soil : group of the soil: the name of a physical group or of a cell set, or a number in the
        cell data
    stones : group or groups of the stones; with the soil they have all the cells
    cell_data : name of the cell data that numbers the groups
    material : of all stones, or by group; stones without one are of what the scene names

    Raises
    ------
    FileNotFoundError, TypeError, ValueError
        If the mesh cannot be read or is none of these, if there is no such group, if a cell is in
        none of them or in several, if soil and stones together are not in one piece or have holes,
        or if there is anything inside a stone.
    """
    cells = read_cells(mesh, cell_data)
    _check.instance("stones", stones, str | int | np.integer | Iterable, "a group or some groups")
    kinds = [stones] if isinstance(stones, str | int | np.integer) else list(stones)
    kind_of_cell = _kind_of_cell(cells, soil, kinds)
    numbers = range(len(kinds))
    materials = materials_by_group(material, numbers, lambda group: _number(group, kinds))
    groups = [
        (f"group {kinds[n]!r}", _joined(cells.polygons[kind_of_cell == n]), materials[n])
        for n in numbers
    ]
    return section("mesh", _joined(cells.polygons), groups)


def _kind_of_cell(cells: Cells, soil: Group, kinds: list[Group]) -> npt.NDArray[np.intp]:
    """Number of the kind of stone that each cell is of, or -1 for soil, shape (n,)."""
    kind_of_cell = np.full(len(cells.polygons), _NONE)
    named = [("soil", soil), *((f"stones[{n}]", kind) for n, kind in enumerate(kinds))]
    for number, (parameter, group) in enumerate(named, start=_SOIL):
        members = cells.members(parameter, group)
        if shared := np.count_nonzero(kind_of_cell[members] != _NONE):
            raise ValueError(
                f"{parameter} must share no cell with the groups before it, got {group!r}, "
                f"{shared} of whose {np.count_nonzero(members)} cells are in them"
            )
        kind_of_cell[members] = number
    if left := np.count_nonzero(kind_of_cell == _NONE):
        raise ValueError(
            f"soil and stones must have all cells of the mesh, got {left} in neither; "
            f"its groups are {cells.shown}"
        )
    return kind_of_cell


def _number(group: Group, kinds: list[Group]) -> int:
    return kinds.index(group) if group in kinds else _NONE


def _joined(cells: Polygons) -> Polygons:
    """The pieces that the cells make up, m, joined along shared sides, shape (k,)."""
    try:
        union = shapely.coverage_union_all(cells)
    except shapely.GEOSException:
        union = shapely.MultiPolygon()
    cell_area = shapely.area(cells).sum()
    if not union.is_valid or abs(union.area - cell_area) > _ROUNDING * cell_area:
        raise ValueError(
            "mesh must be of cells that meet side to side without overlaps, "
            f"got {len(cells)} cells of {cell_area:.6g} m2 that do not"
        )
    pieces: Polygons = shapely.get_parts(union)
    return pieces
