"""Shape functions as dense matrices over a fixed window of grid nodes."""

import numpy as np
from numpy.typing import NDArray

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


def weights(
    shape: str, position: Array, half_length: Array, lines: tuple[Array, Array], h: float
) -> tuple[Array, Array, Array]:
    """S, dS/dx and dS/dy, each (n_points, n_nodes), on the grid lines x (n_x,) and y (n_y,).

    Node (i, j) is column i * n_y + j.
    """
    value, slope = [], []
    for axis in (0, 1):
        z = position[:, axis, None] - lines[axis][None, :]
        l = half_length[:, axis, None]  # noqa: E741
        value.append(hat(z, h) if shape == "linear" else averaged_hat(z, l, h))
        slope.append(hat_slope(z, h) if shape == "linear" else averaged_slope(z, l, h))

    def product(x: Array, y: Array) -> Array:
        return (x[:, :, None] * y[:, None, :]).reshape(len(position), -1)

    return (
        product(value[0], value[1]),
        product(slope[0], value[1]),
        product(value[0], slope[1]),
    )
