"""Single pieces of the compiled kernel, for tests and teaching."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _check, _core
from ._check import FloatArray
from .materials import DruckerPrager, Material
from .method import GIMP, Shape


class ShapeFunctions(NamedTuple):
    """Shape functions of n points at the k nodes each of them reaches.

    Attributes
    ----------
    nodes : column and row of the node, counted from the origin, shape (n, k, 2)
    values : S, shape (n, k)
    gradients : dS/dx and dS/dy, 1/m, shape (n, k, 2)
    """

    nodes: npt.NDArray[np.int64]
    values: FloatArray
    gradients: FloatArray


class NewStress(NamedTuple):
    """Stresses xx, yy, zz, xy, Pa, shape (n, 4), and the equivalent plastic strain added on the
    way, shape (n,)."""

    stress: FloatArray
    plastic_strain: FloatArray


def shape_functions(
    shape: Shape,
    position: npt.ArrayLike,
    half_length: npt.ArrayLike | None = None,
    *,
    cell: float,
    origin: npt.ArrayLike = (0.0, 0.0),
) -> ShapeFunctions:
    """Shape functions and gradients of points (Front. Earth Sci. 2022, 10:968250, eqs. 8, 15, 16),
    far from any wall.

    Parameters
    ----------
    shape : one of `shapes()`; "ugimp" and "cpgimp" are one function of the half-length
    position : m, shape (n, 2)
    half_length : half the sides of the points' domains, m, shape (n, 2), at most 1.5 cells;
        needed with "ugimp" and "cpgimp" alone
    cell : side of a grid cell, m
    origin : a node of the grid, m

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type, shape or range.
    """
    _check.one_of("shape", shape, shapes())
    points = _check.array("position", position, ("n", 2))
    if half_length is None and shape in GIMP:
        raise ValueError(f"half_length must be given with shape {shape!r}, got None")
    halves = np.zeros_like(points) if half_length is None else half_length
    halves = _check.array("half_length", halves, (len(points), 2))
    at = _check.array("origin", origin, (2,)).tolist()
    side = _check.positive("cell", cell)
    return ShapeFunctions(*_core.shape_functions(shape, points, halves, side, (at[0], at[1])))


def second_moment(shape: Shape, half_length: float, *, cell: float) -> float:
    """Mean, over the places of a point in a cell, of the second moment of its shape functions about
    it, m2: h2/6 for hats, h2/6 + l2/3 for domains of half-length l. A share alpha of PIC in each
    step of length dt acts as the viscosity alpha times it over dt.

    Parameters
    ----------
    shape : one of `shapes()`
    half_length : of the domain of a point that has one, m
    cell : side of a grid cell, m
    """
    reach = half_length / cell
    ends = np.unique([0.0, reach % 1, 0.5, -reach % 1, 1.0])  # between them it is a polynomial
    root, share = np.polynomial.legendre.leggauss(4)
    x = (ends[:-1, None] + np.diff(ends)[:, None] * (root + 1) / 2).ravel()
    weight = (np.diff(ends)[:, None] * share / 2).ravel()
    place = cell * np.column_stack([x, np.full_like(x, 0.5)])
    nodes, values, _ = shape_functions(shape, place, np.full_like(place, half_length), cell=cell)
    apart = nodes[..., 0] * cell - place[:, :1]
    return float(weight @ (values * apart**2).sum(axis=1))


def return_mapping(material: DruckerPrager, stress: npt.ArrayLike) -> NewStress:
    """Trial stresses returned to the yield surface of a material.

    On the cone the return follows the flow rule, beyond the tension limit it goes to the plane of
    that mean stress or to the apex (de Souza Neto, Peric and Owen 2008, section 8.3).

    Parameters
    ----------
    material : with its cone
    stress : trial stresses xx, yy, zz, xy, tension positive, Pa, shape (n, 4)

    Raises
    ------
    TypeError, ValueError
        If the material has no yield surface, or the stresses are of the wrong shape.
    """
    _check.instance("material", material, DruckerPrager, "a DruckerPrager")
    trial = _check.array("stress", stress, ("n", 4))
    return NewStress(*_core.return_mapping(material.to_core(), trial))


def update_stress(
    material: Material,
    stress: npt.ArrayLike,
    velocity_gradient: npt.ArrayLike,
    time_step: float,
    steps: int = 1,
) -> NewStress:
    """Stresses of points that are driven through a given motion: each step turns the stress by the
    exact rotation, adds the elastic increment of the Jaumann rate, and returns it to the yield
    surface (Front. Earth Sci. 2022, 10:968250, eqs. 24-25).

    Parameters
    ----------
    material : the same for all points
    stress : at the start, xx, yy, zz, xy, tension positive, Pa, shape (n, 4)
    velocity_gradient : dv_i/dx_j at [:, i, j], 1/s, the same in every step, shape (n, 2, 2)
    time_step : s, > 0
    steps : number of steps, >= 0

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type, shape or range.
    """
    _check.instance("material", material, Material, "a material")
    start = _check.array("stress", stress, ("n", 4))
    gradient = _check.array("velocity_gradient", velocity_gradient, (len(start), 2, 2))
    return NewStress(
        *_core.update_stress(
            material.to_core(),
            start,
            gradient.reshape(-1, 4),
            _check.positive("time_step", time_step),
            _check.whole("steps", steps, 0),
        )
    )


def shapes() -> list[str]:
    """Names of the shape functions that this build holds."""
    return _core.shapes()


def instruction_sets() -> list[str]:
    """Instruction sets that this build holds and this processor runs, the fastest last."""
    return _core.instruction_sets()


def has_threads() -> bool:
    """Whether this build has threads; without them `Method(threads=...)` must be 1."""
    return _core.has_threads
