"""The triangles and quads of a mesh as polygons, and the groups that they are in."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from ... import _check
from .section import Polygons

if TYPE_CHECKING:
    import meshio

Group: TypeAlias = str | int
"""The name of a physical group or of a cell set, or a number in the cell data."""

Flags = npt.NDArray[np.bool_]

GMSH = "gmsh:physical"
"""The cell data that numbers the physical groups of gmsh."""

_KINDS = ("triangle", "quad")
_WITHOUT_AREA = ("vertex", "line")
_FLAT = 1e-9
_PLANE = 2


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of a mesh.

    Attributes
    ----------
    polygons : the cells, m, shape (n,)
    groups : which of the cells are in each of the groups, shape (n,) each; groups without any of
        these cells are left out
    """

    polygons: Polygons
    groups: Mapping[Group, Flags]

    @property
    def shown(self) -> str:
        """The groups in words."""
        return ", ".join(map(repr, self.groups)) or "none"

    def members(self, parameter: str, group: Group) -> Flags:
        """Which cells are in a group, given as `parameter`, shape (n,); refuses unknown groups."""
        allowed = f"a group of triangles and quads in the mesh ({self.shown})"
        _check.instance(parameter, group, str | int | np.integer, allowed)
        if group not in self.groups:
            raise ValueError(f"{parameter} must be {allowed}, got {group!r}")
        return self.groups[group]


def read_cells(mesh: str | PathLike[str] | meshio.Mesh, cell_data: str) -> Cells:
    """The cells of a file that meshio reads, or of its mesh, with groups by the named cell data.

    Raises
    ------
    FileNotFoundError, TypeError, ValueError
        If there is no such file, meshio cannot read it, there are no triangles or quads or there
        are cells of another kind, the mesh is not flat, or there is no such cell data.
    """
    import meshio

    if isinstance(mesh, str | PathLike):
        mesh = _read(Path(mesh))
    _check.instance("mesh", mesh, meshio.Mesh, "the path of a mesh or a meshio.Mesh")
    blocks = [n for n, block in enumerate(mesh.cells) if not block.type.startswith(_WITHOUT_AREA)]
    kinds = {mesh.cells[n].type for n in blocks}
    if not kinds or not kinds.issubset(_KINDS):
        raise ValueError(
            "mesh must be of triangles and quads with straight sides, "
            f"got {sorted(kinds) or 'none'}"
        )
    points = _check.array("mesh.points", mesh.points, ("n", mesh.points.shape[1]))
    z = points[:, 2:]
    if z.size and np.ptp(z) > _FLAT * np.ptp(points[:, :2]):
        raise ValueError(
            f"mesh must be in a plane of constant z, got {z.min():.6g} to {z.max():.6g} m"
        )
    polygons = np.concatenate([shapely.polygons(points[mesh.cells[n].data, :2]) for n in blocks])
    return Cells(polygons, _groups(mesh, blocks, cell_data))


def _read(path: Path) -> meshio.Mesh:
    import meshio

    if not path.exists():
        raise FileNotFoundError(f"mesh must be an existing file, got {str(path)!r}")
    # For some files meshio prints that they are not of another format; at bad ones it exits, or
    # its readers fail in any way.
    said = StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        reason = " ".join(said.getvalue().split()) or f"{type(error).__name__} {error}"
        raise ValueError(
            f"mesh must be a file that meshio reads, got {str(path)!r}: {reason}"
        ) from error


def _groups(mesh: meshio.Mesh, blocks: list[int], cell_data: str) -> dict[Group, Flags]:
    """The numbers in the cell data, the physical groups that name some of them, and cell sets."""
    if cell_data not in mesh.cell_data and cell_data != GMSH:
        raise ValueError(
            f"cell_data must name cell data of the mesh ({', '.join(map(repr, mesh.cell_data))}), "
            f"got {cell_data!r}"
        )
    lengths = [len(mesh.cells[n].data) for n in blocks]
    groups: dict[Group, Flags] = {}
    if cell_data in mesh.cell_data:
        numbers = np.concatenate([mesh.cell_data[cell_data][n] for n in blocks])
        if numbers.ndim != 1 or numbers.dtype.kind not in "iu":
            raise TypeError(
                f"cell_data must name whole numbers, one a cell, got {cell_data!r} of "
                f"{numbers.dtype} and shape {numbers.shape}"
            )
        groups |= {int(number): numbers == number for number in np.unique(numbers)}
        if cell_data == GMSH:
            named = {name: found for name, found in mesh.field_data.items() if np.size(found) == 2}
            groups |= {
                name: numbers == number
                for name, (number, dimension) in named.items()
                if dimension == _PLANE
            }
    for name, sets in mesh.cell_sets.items():
        if not name.startswith("gmsh:"):
            members = [np.isin(np.arange(k), sets[n]) for n, k in zip(blocks, lengths, strict=True)]
            groups[name] = np.concatenate(members)
    return {group: members for group, members in groups.items() if members.any()}
