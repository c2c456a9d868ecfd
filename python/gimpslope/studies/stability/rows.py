"""Rows and blocks of points at some place on the grid, in units of cell, density and stiffness.

In such units a wave crosses a cell in a time of one, so that time steps are Courant numbers.
"""

from __future__ import annotations

import numpy as np

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape

BETWEEN_ROLLERS = gs.Walls(gs.Free(), gs.Free(), gs.Roller(), gs.Roller())
FAR = 64.0  # of sides without a wall


def material(poisson: float = 0.0) -> gs.Elastic:
    """Elastic, of density 1 and wave speed 1."""
    stiff = gs.Elastic(1.0, 1.0, poisson).wave_speed ** 2
    return gs.Elastic(1.0, 1.0 / stiff, poisson)


def points(
    cells: tuple[int, int], per_side: int, offset: tuple[float, float] = (0.0, 0.0)
) -> gs.Points:
    """Points that fill so many cells, `per_side` a cell and direction, from `offset` on."""
    x, y = (
        (np.arange(n * per_side) + 0.5) / per_side + start
        for n, start in zip(cells, offset, strict=True)
    )
    place = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    n = len(place)
    area = np.full(n, per_side**-2.0)
    half = np.full((n, 2), 0.5 / per_side)
    return gs.Points(place, half, area, area, np.zeros(n, dtype=np.int32))


def solver(
    of: gs.Points, law: gs.Material, method: gs.Method, *, row: bool, velocity: FloatArray
) -> gs.Solver:
    """Of a free block, or of a row one cell high between rollers."""
    return gs.Solver(
        of,
        [law],
        cell=1.0,
        walls=BETWEEN_ROLLERS if row else gs.Walls(*[gs.Free()] * 4),
        wall_positions=(-FAR, FAR, 0.0, 1.0),
        velocity=velocity,
        method=method,
    )


def along(
    shape: Shape, place: FloatArray, half_length: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Shape functions along a row and their slopes, shape (n, nodes); nodes without a point are
    left out.

    Parameters
    ----------
    place, half_length : cells, shape (n,)
    """
    level = np.full_like(place, 0.5)
    nodes, values, gradients = gs.kernel.shape_functions(
        shape, np.column_stack([place, level]), np.column_stack([half_length, level]), cell=1.0
    )
    columns = nodes[..., 0] - nodes[..., 0].min()
    dense, slope = np.zeros((2, len(place), int(columns.max()) + 1))
    number = np.arange(len(place))[:, None]
    np.add.at(dense, (number, columns), values)
    np.add.at(slope, (number, columns), gradients[..., 0])
    held = dense.sum(axis=0) > 0
    return dense[:, held], slope[:, held]
