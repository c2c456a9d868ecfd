"""Velocities between points and nodes: a blend of FLIP and PIC (paper eq. 26), APIC (Jiang et al.
2015, doi 10.1145/2766996) or XPIC (Hammerquist and Nairn 2017, doi 10.1016/j.cma.2017.01.035).

s is (n, nodes), velocities at the nodes are (nodes, 2).
"""

import numpy as np
from numpy.typing import NDArray

from .points import Points

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def momentum(points: Points, s: Array) -> Array:
    """That of the soil at the nodes."""
    return np.asarray(s.T @ (points.soft_mass[:, None] * points.velocity))


def affine_momentum(points: Points, s: Array, nodes: Array) -> Array:
    """What the affine motion about each point adds to it (APIC)."""
    arm, weighted = _arms(points, s, nodes)
    around = points.affine @ np.linalg.pinv(weighted @ arm) @ weighted
    return np.asarray(np.tensordot(points.mass, around, axes=1).T)


def take_blend(points: Points, s: Array, raw: Array, after: Array, alpha: float) -> None:
    """Velocities of the nodes (PIC) in a share alpha, else their change since the points brought
    `raw` (FLIP)."""
    pic, flip = s @ after, points.velocity + s @ (after - raw)
    points.velocity = alpha * pic + (1 - alpha) * flip


def take_affine(points: Points, s: Array, nodes: Array, after: Array) -> None:
    """Velocities of the nodes and their affine motion about each point (APIC)."""
    points.affine = np.swapaxes(_arms(points, s, nodes)[1] @ after, 1, 2)
    points.velocity = s @ after


def take_smooth(
    points: Points, s: Array, mass: Array, held: Mask, before: Array, after: Array, order: int
) -> None:
    """The change at the nodes, to velocities V without what no node sees, (1 - S S+)^order V
    (XPIC); `held` are the components (nodes, 2) that walls hold."""
    to_nodes = np.where(mass > 0, 1 / np.where(mass > 0, mass, 1.0), 0.0)[:, None]
    for axis in (0, 1):
        back = np.where(held[:, axis, None], 0.0, to_nodes * s.T * points.mass)
        noise = np.linalg.matrix_power(np.eye(len(s)) - s @ back, order)
        points.velocity[:, axis] -= noise @ points.velocity[:, axis]
    points.velocity = points.velocity + s @ (after - before)


def _arms(points: Points, s: Array, nodes: Array) -> tuple[Array, Array]:
    """From each point to the nodes, (n, nodes, 2), and times their weights, (n, 2, nodes)."""
    arm = nodes[None] - points.position[:, None]
    return arm, np.swapaxes(s[:, :, None] * arm, 1, 2)
