"""The matrix by which one step multiplies a small motion of a row of elastic points.

With S and G the shape functions and slopes of points at nodes, m_i the nodes' masses, all points
alike, A = m_i^-1 S^T m brings velocities to the nodes and F = -m_i^-1 G^T V accelerations. A FLIP
step of length C, in the time that a wave takes for a cell, is then

    USF    s += C G A v          v += C S F s
    USL    w = A v + C F s       v += C S F s    s += C G w
    MUSL   v += C S F s          s += C G A v

(the orders of Bardenhagen 2002, J. Comput. Phys. 180, 383). USF and MUSL do the same in turn, begun
at another place: their matrices have the same eigenvalues. A step is stable while none is above 1.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..._check import FloatArray

HIGHEST = 1.005  # eigenvalue that passes for stable: a motion grows by a thousand in 1,400 steps
LIMITS = (0.03, 4.0)  # of the C that are looked at
FINENESS = 1.01  # of a limit that is found


def matrix(values: FloatArray, slopes: FloatArray, scheme: str, courant: float) -> FloatArray:
    """That of velocities and stresses, shape (2 n, 2 n).

    Parameters
    ----------
    values, slopes : S and G, shape (n, nodes)
    scheme : "usf", "usl" or "musl"
    courant : C
    """
    n = len(values)
    one, none = np.eye(n), np.zeros((n, n))
    held = values.sum(axis=0)[:, None]
    bring, push = values.T / held, -slopes.T / held
    strain, moved = courant * slopes @ bring, courant * values @ push
    if scheme == "usl":
        return np.block([[one, moved], [strain, one + courant**2 * slopes @ push]])
    stress_part = np.block([[one, none], [strain, one]])
    motion_part = np.block([[one, moved], [none, one]])
    first, last = (stress_part, motion_part) if scheme == "usf" else (motion_part, stress_part)
    return np.asarray(last @ first)


def limit(values: FloatArray, slopes: FloatArray, scheme: str) -> float:
    """The largest stable C."""

    def unstable(courant: float) -> bool:
        by = np.linalg.eigvals(matrix(values, slopes, scheme, courant))
        return bool(np.abs(by).max() > HIGHEST)

    return first_unstable(unstable)


def first_unstable(unstable: Callable[[float], bool]) -> float:
    """The C up to which a motion is stable, by bisection; an end of `LIMITS` where that is all."""
    low, high = LIMITS
    if unstable(low):
        return low
    while high / low > FINENESS:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return low
