"""When a slide has come to rest."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping

import numpy as np

from ._check import FloatArray
from .stages import Slide

_SAMPLES = 10  # of the figures in the time of rest
_ROUNDING = 1e-9


class Rest:
    """Looks at a slide row by row, and from time to time at its points.

    Parameters
    ----------
    slide : says what rest is
    position : gives the positions of the points now, m, shape (n, 2)
    """

    def __init__(self, slide: Slide, position: Callable[[], FloatArray]) -> None:
        self._slide, self._position = slide, position
        self._start = position()
        self._peak = self._calm_since = 0.0
        self._sampled: deque[tuple[float, FloatArray]] = deque(maxlen=_SAMPLES + 1)

    def reached(self, row: Mapping[str, float]) -> bool:
        """Whether the slope rests, as the next row of energy and its points now have it."""
        slide, time = self._slide, row["time"]
        self._peak = max(self._peak, row["kinetic"])
        if not slide.rests(row["kinetic"], self._peak, row["max_speed"]):
            self._calm_since = time
            self._sampled.clear()
            return False
        still = slide.rest_change is None or self._keeps(slide.rest_change, time)
        return still and time - self._calm_since >= slide.rest_time

    def _keeps(self, share: float, time: float) -> bool:
        """Whether no figure is about to change by more than that share of itself; at the moments
        when it is looked at."""
        interval = self._slide.rest_time / _SAMPLES
        if self._sampled and time - self._sampled[-1][0] < interval * (1 - _ROUNDING):
            return False
        self._sampled.append((time, self._figures()))
        if len(self._sampled) <= _SAMPLES:
            return False
        # The range, for a front may swing as it settles, and end where it began.
        values = np.array([figures for _, figures in self._sampled])
        rate = np.ptp(values, axis=0) / (time - self._sampled[0][0])
        change = rate * (self._slide.duration - time)
        return bool((change <= share * np.abs(values[-1])).all())

    def _figures(self) -> FloatArray:
        """Largest displacements in all, sideways, up or down, and run-out, m, shape (4,)."""
        now = self._position()
        moved = now - self._start
        run_out = now[:, 0].max() - self._start[:, 0].max()
        return np.array([np.hypot(*moved.T).max(), *np.abs(moved).max(axis=0), run_out])
