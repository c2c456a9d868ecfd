"""Studies of convergence from values that are made up, for the tests of what is said of them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gimpslope.studies.converge.quantities import QUANTITIES, Measured
from gimpslope.studies.converge.series import Series
from gimpslope.studies.converge.study import Convergence

CELLS = (0.4, 0.2, 0.1)


def power(limit: float, scale: float, order: float) -> list[float]:
    """limit + scale h^order on the grids."""
    return [limit + scale * cell**order for cell in CELLS]


def measured(value: float, cell: float, seconds: float = 1.0) -> Measured:
    """A run all figures of which have one value, with a surface of that height."""
    return Measured(
        figures=dict.fromkeys((one.figure for one in QUANTITIES), value),
        surface=None if math.isnan(value) else np.full(10, value),
        gap=0.1 / cell,
        points=round(100 / cell**2),
        point_steps=10**9,
        core_seconds=seconds,
    )


def series(*draws: Sequence[float | None]) -> Series:
    """Draws with values on each grid, None where a run is missing; each grid costs eight times the
    one before."""
    return Series(
        tuple(
            tuple(None if one is None else measured(one, cell, 8.0**number) for one in same)
            for number, (cell, *same) in enumerate(zip(CELLS, *draws, strict=True))
        )
    )


def study(missing: Sequence[str] = (), **models: Series) -> Convergence:
    """Round stones by model."""
    return Convergence("identified", "round", CELLS, (1, 2), models, tuple(missing))
