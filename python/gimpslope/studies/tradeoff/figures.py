"""Charts of error against core-seconds, with the cases that are worth their cost."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator

from ... import kernel
from ...figures.cost import MARKERS
from . import words
from .measure import Measured
from .pareto import front, held
from .problem import Problem
from .problems import PROBLEMS
from .ranking import ByProblem

_TOP = 300.0  # %, errors above it are no results
_COLUMNS = 4
_NEAR = 20.0  # pixels, in which numbers would run into each other
_DEFAULT, _FRONT = "black", "C3"
_SHADES = ("C4", "C0", "C2", "C1", "C6", "C5", "C8", "C9")


def chart(problem: Problem, measured: Sequence[Measured]) -> Figure:
    """All cases of a problem: colour by shape function, or by model where there are stones, marker
    by grid; the front with its numbers, told beside it; the default as a line of stars."""
    figure = Figure(figsize=(11.0, 6.0), layout="constrained")
    ax, beside = figure.subplots(1, 2, width_ratios=(1.25, 1))
    shown = [one for one in measured if math.isfinite(one.error)]
    _cases(ax, shown)
    _default(ax, shown)
    best = front(shown)
    _front(ax, shown, best)
    _finish(ax, problem, shown)
    _numbers(ax, shown, best)
    failed = f", {len(measured) - len(shown)} more failed" * (len(measured) > len(shown))
    ax.set_title(f"{problem.title}: {len(shown)} cases{failed}")
    ax.set(xlabel="core-seconds (processor)", ylabel="error (%)")
    _told(beside, shown, best)
    beside.legend(
        handles=_legend(problem, shown), loc="lower left", fontsize="small", ncols=2, frameon=False
    )
    return figure


def overview(by_problem: ByProblem) -> Figure:
    """All problems, a small panel each."""
    rows = math.ceil((len(by_problem) + 1) / _COLUMNS)
    figure = Figure(figsize=(3.3 * _COLUMNS, 3.0 * rows), layout="constrained")
    panels = figure.subplots(rows, _COLUMNS, squeeze=False).ravel()
    for ax, (problem, measured) in zip(panels, by_problem, strict=False):
        shown = [one for one in measured if math.isfinite(one.error)]
        _cases(ax, shown)
        _default(ax, shown)
        _front(ax, shown, front(shown))
        _finish(ax, problem, shown)
        ax.set_title(problem.title, fontsize="medium")
        if len(problem.models) > 1:
            ax.legend(handles=_handles(problem.models), loc="lower left", fontsize="x-small")
    for ax in panels[::_COLUMNS]:
        ax.set_ylabel("error (%)")
    for ax in panels[len(by_problem) :]:
        ax.set_axis_off()
    for ax in panels[max(0, len(by_problem) - _COLUMNS) : len(by_problem)]:
        ax.set_xlabel("core-seconds (processor)")
    panels[len(by_problem)].legend(handles=[*_shape_handles(), *_line_handles()], loc="center")
    return figure


def _cases(ax: Axes, shown: Sequence[Measured]) -> None:
    """Each case; hollow where a finer grid takes its small error back."""
    errors, cells = held(shown), _cells(shown)
    for one in shown:
        colour = _colour(one)
        lucky = errors[one] > one.error
        ax.plot(
            one.core_seconds,
            100 * one.error,
            MARKERS[cells.index(one.case.cell) % len(MARKERS)],
            markersize=4.5,
            markeredgecolor=colour,
            markerfacecolor="none" if lucky else colour,
            markeredgewidth=0.7,
            alpha=0.65,
        )


def _default(ax: Axes, shown: Sequence[Measured]) -> None:
    """The default on all grids, with the range of its times."""
    some = sorted((one for one in shown if one.case.is_default), key=lambda one: -one.case.cell)
    cost = np.array([one.core_seconds for one in some])
    ranges = [[one.core_seconds - one.fastest for one in some]]
    ranges += [[one.slowest - one.core_seconds for one in some]]
    errors = [100 * one.error for one in some]
    ax.errorbar(cost, errors, xerr=ranges, fmt="*-", color=_DEFAULT, ms=9, lw=1.2, zorder=4)


def _front(ax: Axes, shown: Sequence[Measured], best: Sequence[Measured]) -> None:
    """What no cheaper case comes near, as steps, with ranges of times."""
    errors = held(shown)
    cost, heights = [one.core_seconds for one in best], [100 * errors[one] for one in best]
    ax.step(cost, heights, where="post", color=_FRONT, linewidth=1.5, zorder=3)
    ranges = [[one.core_seconds - one.fastest for one in best]]
    ranges += [[one.slowest - one.core_seconds for one in best]]
    ax.errorbar(cost, heights, xerr=ranges, fmt="none", ecolor=_FRONT, elinewidth=0.8, zorder=3)


def _numbers(ax: Axes, shown: Sequence[Measured], best: Sequence[Measured]) -> None:
    """Numbers below the steps; above, where the one before is near."""
    errors = held(shown)
    places = [(one.core_seconds, 100 * errors[one]) for one in best]
    on_screen = ax.transData.transform(np.reshape(places, (-1, 2)))
    below_before = None
    for number, (place, pixels) in enumerate(zip(places, on_screen, strict=True), start=1):
        near = below_before is not None and np.abs(pixels - below_before).max() < _NEAR
        below_before = below_before if near else pixels
        ax.annotate(
            str(number),
            place,
            xytext=(4, 4) if near else (-4, -4),
            textcoords="offset points",
            ha="left" if near else "right",
            va="bottom" if near else "top",
            color=_FRONT,
            fontsize="small",
            weight="bold",
        )


def _finish(ax: Axes, problem: Problem, shown: Sequence[Measured]) -> None:
    """Scales, lines of equal slope, and what is not known."""
    ax.set(xscale="log", yscale="log")
    lowest = min(100 * one.error for one in shown)
    low, high = lowest / 2.5, min(_TOP, 2 * max(100 * one.error for one in shown))
    left, right = min(one.core_seconds for one in shown), max(one.slowest for one in shown)
    ax.set(xlim=(left / 2, right * 2), ylim=(low, high))
    _slopes(ax, problem)
    if problem.known_to:
        ax.axhspan(low, 100 * problem.known_to, color="0.92", zorder=0)
    for axis in (ax.xaxis, ax.yaxis):
        start, end = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1,) if end > 60 * start else (1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())


def _slopes(ax: Axes, problem: Problem) -> None:
    """Along a line the error falls as h or as h^2, the cost growing as 1 / h a dimension and once
    more for the step."""
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    cost = np.array([left, right])
    for order, style in ((1, ":"), (2, "--")):
        slope = order / (problem.dimensions + 1)
        reach = high * (right / left) ** slope
        for start in np.geomspace(low, reach, num=1 + math.ceil(math.log10(reach / low)))[1:]:
            line = start * (cost / left) ** -slope
            ax.plot(cost, line, style, color="0.8", linewidth=0.7, zorder=1)
    ax.set(xlim=(left, right), ylim=(low, high))


def _told(ax: Axes, shown: Sequence[Measured], best: Sequence[Measured]) -> None:
    """The front in words."""
    ax.set_axis_off()
    errors = held(shown)
    lines = [
        f"{number}  {words.case(one.case)}: {words.percent(errors[one])}, "
        f"{words.seconds(one.core_seconds)}"
        for number, one in enumerate(best, start=1)
    ]
    text = "\n".join(["worth their cost:", *lines])
    ax.text(0, 1, text, transform=ax.transAxes, va="top", fontsize="small", linespacing=1.5)


def _legend(problem: Problem, shown: Sequence[Measured]) -> list[Line2D]:
    grids = [
        Line2D([], [], color="0.4", marker=marker, linestyle="", ms=5, label=f"h = {cell:.3g} m")
        for cell, marker in zip(_cells(shown), MARKERS, strict=False)
    ]
    coloured = _handles(problem.models) if len(problem.models) > 1 else _shape_handles()
    return [*coloured, *grids, *_line_handles()]


def _shape_handles() -> list[Line2D]:
    return _handles([words.shape(name) for name in kernel.shapes()])


def _handles(labels: Sequence[str | None]) -> list[Line2D]:
    return [
        Line2D([], [], color=colour, marker="o", linestyle="", ms=5, label=label)
        for label, colour in zip(labels, _SHADES, strict=False)
    ]


def _line_handles() -> list[Line2D]:
    grey = "0.6"
    return [
        Line2D([], [], color=_DEFAULT, marker="*", ms=9, label="default"),
        Line2D([], [], color=_FRONT, label="worth their cost"),
        Line2D([], [], color=grey, linestyle=":", label="slope of first order in h"),
        Line2D([], [], color=grey, linestyle="--", label="slope of second order"),
        Line2D([], [], color="0.4", marker="o", mfc="none", ls="", ms=5, label="does not hold"),
        Line2D([], [], color="0.92", linewidth=7, label="below what is known"),
    ]


def _colour(one: Measured) -> str:
    models = PROBLEMS[one.case.problem].models
    names: Sequence[str | None] = models if len(models) > 1 else kernel.shapes()
    own = one.case.model if len(models) > 1 else one.case.method.shape
    return _SHADES[names.index(own) % len(_SHADES)]


def _cells(shown: Sequence[Measured]) -> list[float]:
    return sorted({one.case.cell for one in shown}, reverse=True)
