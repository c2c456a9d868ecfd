"""The page: of each slope its figures on each grid with order, limit and error, whether models of
stones meet, how far final surfaces lie apart, and what the runs cost."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np

from ..._check import FloatArray
from .. import reference
from ..reproduce.quantities import Quantity
from ..reproduce.tables import shown, table
from ..richardson import Extrapolation
from . import limits
from .quantities import QUANTITIES, Measured
from .series import Series
from .study import Convergence

EXPLANATION = (
    "*Orders* are those of each three grids in a row, a dash where their two changes differ in "
    "sign. What the last three grids do follows: *converges* with an order between 0.5 and 2.1, "
    "and then the limit by Richardson's extrapolation with its uncertainty (1.25 times the "
    "extrapolated difference, or with a fourth grid twice what the limit moved by the last one, if "
    "that is less, but a third of it at least); *order not settled* outside of that (three times "
    "the spread); *oscillates*; or *diverges*, the last change being the larger one; *too few "
    "grids* where not all of the three finest have a value. *Errors* are parts of the limit on "
    "each grid: of the model's own, or of the surest of those that agree with it; where a model "
    "has none, of the surest of the other models. *Not reached*: the kinetic energy still grows in "
    "the end, or the slope has not come to rest. Shares are parts of the drop in potential "
    "energy.\n"
)
_OF_STONES = (
    "Means over draws of the stones, ±: one standard deviation between draws. Each draw has the "
    "same stones on each grid; deformable ones closer than two cells act as one.\n"
)
_SURFACES = (
    "Root of the mean square of the vertical distance between final surfaces, m, over columns of "
    "{width:g} m.\n"
)
_COSTS = (
    "Core-seconds are the processor time of all threads while stepping (of run files from before "
    "that was kept, the wall time times the threads), of each draw.\n"
)


def markdown(study: Convergence) -> str:
    """The section of a slope, without its pictures."""
    parts = [f"## Slope {reference.title(study.slope)}, reading `{study.reading}`\n"]
    if study.missing:
        parts += [f"Missing: {'; '.join(study.missing)}.\n"]
    if study.has_stones:
        parts += [f"Seeds of the stones: {', '.join(map(str, study.seeds))}. {_OF_STONES}"]
    parts += [_figures(study)]
    if len(study.series) > 1:
        parts += ["Limits agree where they differ by no more than their uncertainties allow.\n"]
        parts += [_meetings(study)]
    parts += [_SURFACES.format(width=2 * study.cells[0]), _surfaces(study), _COSTS, _costs(study)]
    return "\n".join(parts)


def _grids(study: Convergence) -> list[str]:
    return [f"h = {cell:g} m" for cell in study.cells]


def _figures(study: Convergence) -> str:
    stones = ["stones"] if study.has_stones else []
    head = ["quantity", *stones, *_grids(study), "orders", "limit", "", "errors, %"]
    rows = []
    for quantity in QUANTITIES:
        for model, series in study.series.items():
            row = [quantity.label, *([model] if stones else []), *_values(series, quantity)]
            rows.append([*row, *_limit(series, quantity), _errors(study, quantity, model)])
    return table(head, rows)


def _values(series: Series, quantity: Quantity) -> list[str]:
    return [
        shown(draws, quantity) if complete else "missing"
        for draws, complete in zip(series.values(quantity.figure), series.complete, strict=True)
    ]


def _limit(series: Series, quantity: Quantity) -> tuple[str, str, str]:
    """Orders, limit and behaviour."""
    found = series.limit(quantity.figure)
    if found is None:
        return ("-", "-", "too few grids")
    orders = ", ".join("-" if math.isnan(order) else f"{order:.1f}" for order in found.orders)
    limit = "none" if math.isnan(found.limit) else _with_uncertainty(found, quantity)
    return (orders, limit, found.behaviour)


def _with_uncertainty(found: Extrapolation, quantity: Quantity) -> str:
    return f"{quantity.shown(found.limit)} ± {_short(found.uncertainty)}"


def _short(value: float) -> str:
    """Two digits, or all before the point."""
    return f"{value:.2g}" if value < 100 else f"{value:.0f}"


def _errors(study: Convergence, quantity: Quantity, model: str) -> str:
    found = study.errors(quantity.figure, model)
    if found is None:
        return "-"
    each = ", ".join("-" if math.isnan(error) else _short(100 * error) for error in found.values)
    whose = found.against.model
    return each if whose == model else f"{each} (of the limit of {whose})"


def _meetings(study: Convergence) -> str:
    rows = []
    for quantity in QUANTITIES:
        found = study.limits(quantity.figure)
        for pair in combinations(study.series, 2):
            told = [
                _with_uncertainty(found[model], quantity) if model in found else "none"
                for model in pair
            ]
            names = [f"{model} {limit}" for model, limit in zip(pair, told, strict=True)]
            both = [found[model] for model in pair if model in found]
            rows.append([quantity.label, *names, *_meeting(both, quantity)])
    return table(["quantity", "limit", "limit", "apart", "allowed", "agree"], rows)


def _meeting(found: Sequence[Extrapolation], quantity: Quantity) -> tuple[str, str, str]:
    """Difference, what the uncertainties allow, and whether two limits agree."""
    if len(found) < 2:
        return ("-", "-", "cannot tell")
    first, second = found
    apart = quantity.shown(abs(first.limit - second.limit))
    allowed = _short(limits.allowed(first, second))
    return (apart, allowed, "yes" if limits.meet(first, second) else "**no**")


def _surfaces(study: Convergence) -> str:
    rows = [
        [f"{model}, to that of the finest grid", *map(_metres, series.off_finest())]
        for model, series in study.series.items()
    ]
    rows += [
        [f"{one} to {other}", *map(_metres, study.series[one].apart(study.series[other]))]
        for one, other in combinations(study.series, 2)
    ]
    return table(["surface", *_grids(study)], rows)


def _metres(draws: FloatArray) -> str:
    if np.isnan(draws).any():
        return "-"
    spread = f" ± {draws.std(ddof=1):.3f}" if len(draws) > 1 else ""
    return f"{draws.mean():.3f}{spread}"


def _costs(study: Convergence) -> str:
    rows = []
    for model, series in study.series.items():
        seconds = _draws(series, lambda one: f"{one.core_seconds:.1f}")
        steps = _draws(series, lambda one: f"{one.point_steps / 1e9:.3f}")
        rows += [[f"core-seconds, {model}", *seconds], [f"1e9 point-steps, {model}", *steps]]
    alike = _of_any_model(study)
    rows.append(["points", *_draws(alike, lambda one: f"{one.points:,}")])
    if study.has_stones:
        gaps = _draws(alike, lambda one: f"{one.gap:.2f}")
        rows.append(["smallest gap between stones, cells", *gaps])
    return table(["runs", *_grids(study)], rows)


def _draws(series: Series, text: Callable[[Measured], str]) -> list[str]:
    """Of each grid, draw by draw."""
    return [
        ", ".join("missing" if one is None else text(one) for one in draws)
        for draws in series.grids
    ]


def _of_any_model(study: Convergence) -> Series:
    """Of each draw on each grid the first model that is there."""
    grids = zip(*(series.grids for series in study.series.values()), strict=True)
    return Series(
        tuple(
            tuple(next((one for one in same if one), None) for same in zip(*models, strict=True))
            for models in grids
        )
    )
