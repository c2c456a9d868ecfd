"""The floating-point operations that a point takes in a step, counted from its formulas.

One operation is the addition, subtraction, multiplication or division of two numbers, the larger or
smaller of two, or a square root. Signs, absolute values, conversions and whole numbers are none,
and what depends on the step alone is computed once. Not counted is what moves no point: the ledger,
the search for the largest speed, checks, sums that only fill up a vector, and what averaged strains
compute once more. The scheme is USF in two sweeps, the second of which computes the shape functions
anew; the law is Drucker-Prager.
"""

from __future__ import annotations

from types import MappingProxyType

from ... import _check
from ...method import Shape

NODES = MappingProxyType({"linear": 2, "ugimp": 3, "cpgimp": 3})
"""Nodes that a point reaches a direction, by shape functions."""

_POINTS_PER_NODE = 4  # as many as a cell has

# Along one axis: the place in cells of the point or its left edge, x / h - c, and what is left to
# the next node.
_PLACE = {"linear": 3, "ugimp": 3, "cpgimp": 3}
# Of a domain that is the point's own: 2 l / h, its half, which c takes up, its inverse and half of
# that.
_OWN_DOMAIN = {"linear": 0, "ugimp": 0, "cpgimp": 5}
# Linear: 1 - room. GIMP: a, b; w0, w2 and what they leave (4, 2, 2).
_VALUES = {"linear": 1, "ugimp": 10, "cpgimp": 10}
# GIMP: a / width, b / width and what they leave.
_DERIVATIVES = {"linear": 0, "ugimp": 3, "cpgimp": 3}

_STRAIN = 6  # dt L_xx, dt L_yy, dt (L_xy + L_yx) / 2 (2), dt (L_yx - L_xy) (2)
_VOLUME = 3  # V (1 + (e_xx + e_yy))
_ANGLE = 1 + 6 + 7  # its square, and three terms more of cosine and sine
_TURN = 4 + 3 + 3  # centre and half of the normal stresses; the half and the shear stress turned
_ELASTIC = 1 + 2 + 3 + 2 + 2  # tr(e), then centre, half, zz, xy
_RETURN = 2 + 1 + 7 + 3 + 3 + 1 + 2 + 1 + 2 + 7 + 2 + 3
# deviator of the centre, mean, sqrt(J2), overshoot, mean after the cone, tension limit, limit of
# sqrt(J2), its new value, scale; centre, zz, half, xy; the normal stresses; plastic strain
_FORCE = 4  # V / h times xx, yy, xy
_MOVE = 2 + 4  # x + dx; (1 - alpha) v + dv
_MOMENTUM = 2  # m v
_RESIZE = 3  # sqrt(V), times two references
_NODE = 3 + 20  # v = p / m; forces, v after the step, and what points take from both


def per_point_step(shape: Shape) -> float:
    """Operations of a point in a step, its share of the nodes' included.

    Parameters
    ----------
    shape : shape functions, one of `NODES`

    Raises
    ------
    TypeError, ValueError
        If these shape functions have not been counted.
    """
    return sum(by_part(shape).values())


def by_part(shape: Shape) -> dict[str, float]:
    """The same for each part of the step, in its order."""
    _check.one_of("shape", shape, list(NODES))
    n = NODES[shape]
    along_axis = _PLACE[shape] + _OWN_DOMAIN[shape] + _VALUES[shape]
    gather = 4 * (2 * n - 1) * (n + 1)  # four sums, over the nodes of each row, then over the rows
    return {
        "shape functions and derivatives": 2 * (along_axis + _DERIVATIVES[shape]),
        "velocity gradient": gather,
        "strain and volume": _STRAIN + _VOLUME,
        "rotation": _ANGLE + _TURN,
        "elastic trial": _ELASTIC,
        "return mapping": _RETURN,
        "forces to nodes": _FORCE + 4 * n + 8 * n**2,  # four products a row; multiplied and added
        "shape functions": 2 * along_axis,
        "change of place and velocity": gather,
        "move": _MOVE + (_RESIZE if shape == "cpgimp" else 0),
        "shape functions at the new place": 2 * along_axis,
        "mass and momentum to nodes": _MOMENTUM + 3 * n + 6 * n**2,
        "nodes": _NODE / _POINTS_PER_NODE,
    }
