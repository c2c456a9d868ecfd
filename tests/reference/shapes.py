"""Shape functions as dense matrices over a fixed window of grid nodes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .walls import SIDES, Wall

Array = NDArray[np.float64]


def hat(z: Array, h: float) -> Array:
    """Linear hat of half-width h, centred at 0."""
    return np.maximum(0.0, 1.0 - np.abs(z) / h)


def hat_slope(z: Array, h: float) -> Array:
    """Derivative of the hat; at a kink the one from the right."""
    return np.where((-h <= z) & (z < 0), 1.0 / h, np.where((z >= 0) & (z < h), -1.0 / h, 0.0))


def hat_integral(z: Array, h: float) -> Array:
    """Integral of the hat from minus infinity to z."""
    z = np.clip(z, -h, h)
    return np.where(z < 0, (z + h) ** 2 / (2 * h), h - (h - z) ** 2 / (2 * h))


def averaged_hat(z: Array, half_length: Array, h: float) -> Array:
    """Mean of the hat over [z - l, z + l] (GIMP, Bardenhagen & Kober 2004).

    The hat is even, so -abs(z) does as well as z, and its small tail is then free of cancellation.
    """
    z, l = -np.abs(z), half_length  # noqa: E741
    return (hat_integral(z + l, h) - hat_integral(z - l, h)) / (2 * l)


def averaged_slope(z: Array, half_length: Array, h: float) -> Array:
    """Derivative of `averaged_hat` with respect to z."""
    return (hat(z + half_length, h) - hat(z - half_length, h)) / (2 * half_length)


def continue_behind_walls(
    values: Array, slopes: Array, axis: int, x: Array, lines: Array, h: float, walls: Sequence[Wall]
) -> None:
    """Let the line of nodes behind a wall go on from the two before it,
    v[wall + into] = 2 v[wall] - v[wall - into], in B-splines (n_points, n_lines) of points at x.
    What lies beyond the wall goes with the wall's own line."""
    for (normal, into), (kind, _, place) in zip(SIDES, walls, strict=True):
        if normal != axis or kind == "free":
            continue
        at, beyond = int(np.argmin(np.abs(lines - place))), into * (x - place)
        near = np.abs(beyond) <= h / 2
        for of in (values, slopes):
            behind = of[near, at + into]
            of[near, at] += 2 * behind
            of[near, at - into] -= behind
            of[near, at + into] = 0.0
        outside = near & (beyond > 0)
        values[outside] = slopes[outside] = 0.0
        values[outside, at] = 1.0


def weights(
    shape: str,
    position: Array,
    half_length: Array,
    lines: tuple[Array, Array],
    h: float,
    walls: Sequence[Wall] = (),
) -> tuple[Array, Array, Array]:
    """S, dS/dx and dS/dy, each (n_points, n_nodes), on the grid lines x (n_x,) and y (n_y,).

    Node (i, j) is column i * n_y + j. Walls on grid lines change quadratic B-splines.
    """
    value, slope = [], []
    for axis in (0, 1):
        z = position[:, axis, None] - lines[axis][None, :]
        l = half_length[:, axis, None]  # noqa: E741
        if shape == "quadratic_bspline":
            l = np.full_like(l, h / 2)  # noqa: E741
        value.append(hat(z, h) if shape == "linear" else averaged_hat(z, l, h))
        slope.append(hat_slope(z, h) if shape == "linear" else averaged_slope(z, l, h))
        if shape == "quadratic_bspline" and walls:
            x = position[:, axis]
            continue_behind_walls(value[axis], slope[axis], axis, x, lines[axis], h, walls)

    def product(x: Array, y: Array) -> Array:
        return (x[:, :, None] * y[:, None, :]).reshape(len(position), -1)

    return (
        product(value[0], value[1]),
        product(slope[0], value[1]),
        product(value[0], slope[1]),
    )
