"""The problems: set-ups and errors are those of `verify`, slopes those of `slopes`."""

from __future__ import annotations

from ...method import Method
from .. import reference
from ..verify import aluminium_bars, bar, cantilever, column, manufactured
from . import slopes
from .problem import Changes, Problem, Solution

AMPLITUDE = 0.1
"""Of the manufactured solution, m: strains of 31 %."""

BAR_STRAIN = bar.SPEED / (bar.YOUNG / bar.DENSITY) ** 0.5
"""Largest of the bar: the second term of ln(1 + e), which the exact solution leaves out, is half of
it in parts of the first."""

SLOPE_A = slopes.Figures(164.34e3, 1.623, 5.348)
UNCERTAINTY_A = slopes.Figures(0.87e3, 0.024, 0.034)
"""Limits on finer grids and their uncertainties (`gimpslope converge`, to a cell of 0.05 m)."""

WITH_STONE = slopes.Figures(5842.0, 0.9118, 1.607)
UNCERTAINTY_WITH_STONE = slopes.Figures(253.0, 0.0266, 0.0276)
"""The same of the small slope with a stone: of the limits that agree with those of the full model,
stones of 20 GPa, the surest (`pytest -m slow tests/unit/test_tradeoff_reference.py`)."""


def _column(cell: float, method: Method, _: str | None) -> Solution:
    rest = column.press(column.SOFT, round(column.SOFT.height / cell), method)
    return Solution(rest.error, rest.core_seconds)


def _bar(cell: float, method: Method, _: str | None) -> Solution:
    swing = bar.swing(round(bar.LENGTH / cell), method)
    return Solution(swing.error, swing.core_seconds)


def _manufactured(cell: float, method: Method, _: str | None) -> Solution:
    swing = manufactured.swing(round(1 / cell), AMPLITUDE, method)
    return Solution(swing.error / AMPLITUDE, swing.core_seconds)


def _cantilever(cell: float, method: Method, _: str | None) -> Solution:
    swing = cantilever.swing(3, cell, method)
    return Solution(swing.off(cantilever.published("fem")) / cantilever.DEPTH, swing.core_seconds)


def _aluminium_bars(cell: float, method: Method, _: str | None) -> Solution:
    heap = aluminium_bars.collapse(cell, method)
    off = aluminium_bars.distance(heap, aluminium_bars.measured("surface"))
    return Solution(off / aluminium_bars.HEIGHT, heap.core_seconds)


def _slope_a(cell: float, method: Method, _: str | None) -> Solution:
    slid = slopes.slope_a(cell, method)
    return Solution(slopes.off(slid.figures, SLOPE_A), slid.core_seconds)


def _with_stone(cell: float, method: Method, model: str | None) -> Solution:
    slid = slopes.with_stone(cell, method, model or reference.STONE_MODELS[0])
    return Solution(slopes.off(slid.figures, WITH_STONE), slid.core_seconds)


_SHORTER: Changes = {"courant": 0.2}
_LONGER: Changes = {"courant": 0.8}
_LOCKING: Changes = {"volumetric_strain": "point"}
_CONVECTED: Changes = {"shape": "cpgimp", "domain_update": "stretch"}

_ALL = (
    Problem(
        "column",
        "Column under its own weight",
        "mean error of the stress over the largest, exact",
        (2.0, 1.0, 0.5, 0.25),
        _column,
        fine=(0.125,),
        dimensions=1,
    ),
    Problem(
        "bar",
        "Vibrating bar",
        "RMS error of the displacement in ten periods, exact for small motions",
        (5.0, 2.5, 1.25, 0.625),
        _bar,
        fine=(0.3125,),
        known_to=BAR_STRAIN / 2,
        dimensions=1,
    ),
    Problem(
        "manufactured",
        "Manufactured solution in a square",
        "largest error of a displacement over the amplitude, exact",
        (1 / 8, 1 / 16, 1 / 32, 1 / 64),
        _manufactured,
        dear={1 / 128: (_CONVECTED, {**_CONVECTED, **_SHORTER})},
    ),
    Problem(
        "cantilever",
        "Cantilever",
        "RMS distance of the tip from that of finite elements over its fall",
        (0.5, 0.25),
        _cantilever,
        fine=(0.125,),
        known_to=cantilever.SHARE,
    ),
    Problem(
        "aluminium_bars",
        "Collapse of aluminium rods",
        "RMS distance of the surface from the measured one over the height",
        (0.02, 0.01),
        _aluminium_bars,
        fine=(0.005,),
        method=aluminium_bars.CURED,
        yields=True,
        known_to=aluminium_bars.ROD / aluminium_bars.HEIGHT,
        dear={0.0025: ({}, _LONGER, _LOCKING, {**_LOCKING, **_LONGER})},
    ),
    Problem(
        "slope_a",
        "Slope A",
        "RMS of the errors of peak energy, its time and vertical displacement, by their limits",
        (0.8, 0.4),
        _slope_a,
        fine=(0.2,),
        method=reference.method(slopes.READING, ledger=False, volumetric_strain="cell_average"),
        yields=True,
        known_to=slopes.known_to(SLOPE_A, UNCERTAINTY_A),
        dear={0.1: ({}, _LONGER, _LOCKING)},
    ),
    Problem(
        "with_stone",
        "Slope with a stone",
        "RMS of the errors of peak energy, its time and displacement, by limits of the full model",
        (0.2, 0.1),
        _with_stone,
        method=Method(viscosity=slopes.VISCOSITY, volumetric_strain="cell_average"),
        yields=True,
        known_to=slopes.known_to(WITH_STONE, UNCERTAINTY_WITH_STONE),
        dear={0.05: (_LONGER, {**_LOCKING, **_LONGER})},
        only=({}, _LONGER, _LOCKING, {**_LOCKING, **_LONGER}),
        models=reference.STONE_MODELS,
    ),
)
PROBLEMS = {problem.name: problem for problem in _ALL}
"""By name: elastic ones first, then plastic and frictional ones."""
