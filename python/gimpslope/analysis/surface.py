"""The surface of a slope: its profile and its roughness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import _check
from .._check import FloatArray
from ..snapshot import Snapshot

ROUGHNESS_LENGTH = 3.0
"""Length of the moving fit from which roughness is measured, m: a few stones of the study."""

_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Surface:
    """Height of a slope over columns of equal width.

    Attributes
    ----------
    width : of a column, m
    x : middle of each column, from the first to the last that holds points, m, shape (k,)
    y : top of the highest point domain in it, m, shape (k,); NaN in a column without points
    """

    width: float
    x: FloatArray
    y: FloatArray

    def between(self, left: float, right: float) -> Surface:
        """The part whose columns have their middle between two places, m.

        Raises `TypeError` or `ValueError` if these are no numbers or no column is between them.
        """
        left, right = _check.finite("left", left), _check.finite("right", right)
        part = (self.x >= left) & (self.x <= right)
        if not part.any():
            raise ValueError(
                f"left and right must have a column between them, got {left:.6g} and {right:.6g} m "
                f"with columns from {self.x[0]:.6g} to {self.x[-1]:.6g} m"
            )
        return Surface(self.width, self.x[part], self.y[part])

    def roughness(self, length: float = ROUGHNESS_LENGTH) -> float:
        """Root mean square deviation of the surface from its moving parabola, m.

        Around each column a parabola is fitted by least squares to the columns within half the
        `length` (m) on each side (Savitzky & Golay 1964, Anal. Chem. 36:1627); the deviation is
        the height of the column above the parabola there. The root of the mean of its square is
        the Rq of ISO 4287 with this mean line: slope and even curvature of the surface do not
        count, waves longer than the length hardly. Columns whose length reaches beyond the ends of
        the surface, or over a column without points, have no deviation.

        Raises
        ------
        TypeError, ValueError
            If the length is below four columns, or no unbroken part of the surface is as long.
        """
        length = _check.positive("length", length)
        half = int(length / 2 / self.width + _ROUNDING)
        if half < 2:
            raise ValueError(
                f"length must be at least four columns, {4 * self.width:.6g} m, got {length:.6g} m"
            )
        windows = self._windows(half)
        if len(windows) == 0:
            raise ValueError(
                f"length must fit into an unbroken part of the surface, got {length:.6g} m with a "
                f"surface from {self.x[0]:.6g} to {self.x[-1]:.6g} m"
            )
        return float(np.sqrt(np.mean((windows @ _deviation(half)) ** 2)))

    def _windows(self, half: int) -> FloatArray:
        """Heights of the columns around each that has all of them, shape (columns, 2 half + 1)."""
        count = 2 * half + 1
        if len(self.y) < count:
            return np.empty((0, count))
        windows = np.lib.stride_tricks.sliding_window_view(self.y, count)
        complete: FloatArray = windows[np.isfinite(windows).all(axis=1)]
        return complete


def surface_of(state: Snapshot, width: float, *, left: float = 0.0) -> Surface:
    """The surface over columns of the given `width`, m, one of which begins at `left`, m.

    A point is in the column that holds its middle; its domain is a square of its present volume.
    Raises `TypeError` or `ValueError` for a width that is no finite number > 0.
    """
    width, left = _check.positive("width", width), _check.finite("left", left)
    column = np.floor((state.position[:, 0] - left) / width).astype(np.int64)
    first = int(column.min())
    top = np.full(int(column.max()) - first + 1, np.nan)
    np.fmax.at(top, column - first, state.position[:, 1] + state.half_length[:, 1])
    x = left + (first + np.arange(len(top), dtype=np.float64) + 0.5) * width
    return Surface(width, x, top)


def _deviation(half: int) -> FloatArray:
    """Weights of 2 half + 1 heights that give the middle one less the parabola fitted to them."""
    place = np.arange(-half, half + 1) / half
    fit = np.linalg.pinv(np.vander(place, 3, increasing=True))[0]
    weights: FloatArray = (place == 0) - fit
    return weights
