"""Regions of an array of numbers as polygons along the edges of its pixels."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import shapely

from .section import Polygons

Flags = npt.NDArray[np.bool_]
Numbers = npt.NDArray[np.intp]


def regions(numbers: Numbers) -> tuple[Polygons, Numbers]:
    """The regions of equal numbers, where pixels are neighbours that share an edge.

    Parameters
    ----------
    numbers : 0 or above, 0 for what is of no interest, rows from the top, shape (rows, columns)

    Returns
    -------
    polygons : shape (k,), in pixels, the lower left corner of the image at (0, 0), y upwards
    number : of each region, shape (k,)
    """
    upwards = numbers[::-1]
    around = np.pad(upwards, 1)
    level = around[1:, 1:-1] != around[:-1, 1:-1]  # (rows + 1, columns): edges below and above
    upright = around[1:-1, 1:] != around[1:-1, :-1]  # (rows, columns + 1): edges beside
    sides = np.concatenate([_sides(level, upright), _sides(upright.T, level.T)[..., ::-1]])
    faces = shapely.get_parts(shapely.polygonize(shapely.linestrings(sides.astype(np.float64))))
    inside = shapely.get_coordinates(shapely.point_on_surface(faces)).astype(np.intp)
    number = upwards[inside[:, 1], inside[:, 0]]
    return faces[number > 0], number[number > 0]


def _sides(along: Flags, across: Flags) -> Numbers:
    """Sides in x, shape (k, 2, 2): edges `along` joined up to where edges `across` meet them."""
    met = np.pad(across, [(1, 0), (0, 0)]) | np.pad(across, [(0, 1), (0, 0)])
    y, first = np.nonzero(along & met[:, :-1])
    _, last = np.nonzero(along & met[:, 1:])
    return np.stack([np.stack([first, y], axis=1), np.stack([last + 1, y], axis=1)], axis=1)
