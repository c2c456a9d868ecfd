"""Wall conditions on grid nodes. A wall is (kind, friction, position)."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Wall = tuple[str, float, float]

# what counts as the last motion of a node that had no mass: not zero, which is held or stuck
NO_MOTION = 1e-300

# left, right, bottom, top: the axis of the normal and the direction into the wall
SIDES = ((0, -1), (0, +1), (1, -1), (1, +1))


def _each(
    nodes: Array, walls: Sequence[Wall], cell: float
) -> Iterator[tuple[str, float, int, int, NDArray[np.bool_]]]:
    for (axis, into), (kind, friction, position) in zip(SIDES, walls, strict=True):
        if kind not in ("free", "roller", "fixed", "coulomb"):
            raise ValueError(f"wall is {kind!r}; allowed: free, roller, fixed, coulomb")
        touched = into * (nodes[:, axis] - position) >= -1e-9 * cell
        yield kind, friction, axis, into, touched


def hold_velocity(
    velocity: Array, before: Array, nodes: Array, walls: Sequence[Wall], cell: float
) -> Array:
    """Node velocity (n_nodes, 2) as the strain step sees it; `before` is that of the last step."""
    v = velocity.copy()
    for kind, _, axis, into, touched in _each(nodes, walls, cell):
        if kind == "fixed":
            v[touched] = 0.0
        elif kind == "roller":
            v[touched, axis] = 0.0
        elif kind == "coulomb":
            held = before[:, axis] == 0.0
            stuck = held & (before[:, 1 - axis] == 0.0)
            v[touched & (held | (into * v[:, axis] > 0)), axis] = 0.0
            v[touched & stuck, 1 - axis] = 0.0
    return v


def hold_momentum(momentum: Array, nodes: Array, walls: Sequence[Wall], cell: float) -> Array:
    """Node momentum (n_nodes, 2) after the impulse of the walls."""
    p = momentum.copy()
    for kind, friction, axis, into, touched in _each(nodes, walls, cell):
        if kind == "fixed":
            p[touched] = 0.0
        elif kind == "roller":
            p[touched, axis] = 0.0
        elif kind == "coulomb":
            pressed = touched & (into * p[:, axis] > 0)
            normal, along = np.abs(p[pressed, axis]), p[pressed, 1 - axis]
            p[pressed, axis] = 0.0
            p[pressed, 1 - axis] = np.sign(along) * np.maximum(0, np.abs(along) - friction * normal)
    return p
