"""What was measured of a slope with stones of one model, from grid to grid."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..._check import FloatArray
from ..richardson import Extrapolation, extrapolate_means
from .quantities import Measured
from .surfaces import distance

Draws = tuple[Measured | None, ...]
"""One a seed; None for a run that is missing."""


@dataclass(frozen=True, eq=False)
class Series:
    """One model on all grids.

    Attributes
    ----------
    grids : coarse to fine, each of as many draws
    """

    grids: tuple[Draws, ...]

    @property
    def complete(self) -> npt.NDArray[np.bool_]:
        """On which grids all draws are there, shape (grids,)."""
        return np.array([None not in draws for draws in self.grids])

    def values(self, figure: str) -> FloatArray:
        """A figure, shape (grids, draws); NaN where it is missing or not reached."""
        return self._each(lambda one: one.figures[figure])

    @property
    def core_seconds(self) -> FloatArray:
        """Of each run, s, shape (grids, draws); NaN where it is missing."""
        return self._each(lambda one: one.core_seconds)

    def limit(self, figure: str) -> Extrapolation | None:
        """The limit of the means over draws, as `extrapolate_means` says, of the grids up to the
        finest on which all draws are there."""
        there = np.flatnonzero(self.complete)
        return extrapolate_means(self.values(figure)[: there.max(initial=-1) + 1])

    def off_finest(self) -> FloatArray:
        """Distance (m) of the final surface to that of the finest grid on which all draws are
        there, shape (grids, draws); NaN where there is none."""
        there = np.flatnonzero(self.complete)
        finest = self.grids[there.max(initial=0)]
        return np.array([_distances(draws, finest) for draws in self.grids])

    def apart(self, other: Series) -> FloatArray:
        """Distance (m) of the final surfaces of two models on each grid, shape (grids, draws)."""
        pairs = zip(self.grids, other.grids, strict=True)
        return np.array([_distances(one, another) for one, another in pairs])

    def _each(self, number: Callable[[Measured], float]) -> FloatArray:
        return np.array(
            [[math.nan if one is None else number(one) for one in draws] for draws in self.grids]
        )


def _distances(first: Draws, second: Draws) -> list[float]:
    return [
        math.nan
        if one is None or other is None or one.surface is None or other.surface is None
        else distance(one.surface, other.surface)
        for one, other in zip(first, second, strict=True)
    ]
