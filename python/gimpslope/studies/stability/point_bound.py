"""A step that is stable whatever the points' places: that of the stiffest single point.

The frequencies of an assembly with lumped masses are at most those of its stiffest part (Irons and
Treharne 1971; Hughes 1987, The Finite Element Method, section 9.1). The part of a point has the
stiffness V B^T D B and the masses m S_i: its squares of frequencies are the eigenvalues of
D B S^-1 B^T / rho, in a row those of c^2 sum G_i^2 / S_i. With linear hats there is no bound: near
a node S falls with the distance while G does not.
"""

from __future__ import annotations

import numpy as np

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape

PLACES = 41  # a direction of a cell


def bound(shape: Shape, per_side: int, poisson: float, dimensions: int) -> float:
    """The largest sure C = c dt / h, 2 / omega over all places in a cell.

    Parameters
    ----------
    shape : of points whose first domains fill the cell, `per_side` a direction
    poisson : Poisson's ratio; 0 in a row
    dimensions : 1 (a row) or 2
    """
    line = np.linspace(0, 1, PLACES)
    level = line if dimensions == 2 else np.array([0.5])
    place = np.stack(np.meshgrid(line, level), axis=-1).reshape(-1, 2)
    half = np.full_like(place, 0.5 / per_side)
    _, values, gradients = gs.kernel.shape_functions(shape, place, half, cell=1.0)
    squares = _squares(values, gradients, poisson) if dimensions == 2 else _row(values, gradients)
    return 2.0 / float(np.sqrt(squares.max()))


def _row(values: FloatArray, gradients: FloatArray) -> FloatArray:
    """sum G^2 / S along x: at half height two rows of nodes share both alike."""
    along, share = gradients[..., 0], values
    squares: FloatArray = _over(along**2, share).sum(axis=1)
    return squares


def _squares(values: FloatArray, gradients: FloatArray, poisson: float) -> FloatArray:
    """Largest square of a frequency of each point, in (c / h)^2."""
    law = gs.Elastic(1.0, 1.0, poisson)
    stiff = law.wave_speed**2
    soft, shear = law.bulk_modulus - 2 / 3 * law.shear_modulus, law.shear_modulus
    elastic = np.array([[stiff, soft, 0], [soft, stiff, 0], [0, 0, shear]]) / stiff
    dx, dy = np.moveaxis(gradients, 2, 0)
    none = np.zeros_like(dx)
    strain = np.stack(  # B: (points, xx yy xy, nodes and directions)
        [np.concatenate(pair, axis=1) for pair in ((dx, none), (none, dy), (dy, dx))], axis=1
    )
    twice = np.concatenate([values, values], axis=1)[:, None]
    compliance = np.einsum("pik,pjk->pij", _over(strain, twice), strain)
    squares: FloatArray = np.abs(np.linalg.eigvals(elastic @ compliance)).max(axis=1)
    return squares


def _over(values: FloatArray, share: FloatArray) -> FloatArray:
    return np.divide(values, share, out=np.zeros_like(values + share), where=share > 0)
