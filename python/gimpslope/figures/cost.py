"""Errors against what the runs cost."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from .._check import FloatArray
from .canvas import new_axes

MARKERS = ("o", "s", "^", "D", "v", "P", "X")
"""Of the grids, coarse to fine."""

_MARGIN = 0.25  # of the axis, so that a tick or two lie in a narrow one
_FEW, _MORE = (1,), (1, 2, 5)  # ticks in a decade
_WIDE = 100  # from low to high, so that more ticks would run into each other


def error_against_cost(
    cost: FloatArray,
    error: FloatArray,
    ax: Axes | None = None,
    *,
    label: str,
    colour: str,
    known_to: float | None = None,
) -> Axes:
    """The errors (%) of results on several grids against their cost (core-seconds of processor
    time), log-log: a line, a marker of its own for each grid. What is not finite, or no error at
    all, is left out.

    Parameters
    ----------
    cost, error : coarse to fine, shape (k,)
    ax : to draw on; None: a new one
    label : of the line
    colour : of line and markers
    known_to : uncertainty of what the errors are told against (%), dotted across: errors below it
        are not known
    """
    ax = ax or new_axes()
    shown = np.isfinite(cost) & (error > 0)
    ax.loglog(cost[shown], error[shown], "-", color=colour, linewidth=1.5, label=label)
    for place in np.flatnonzero(shown):
        marker = MARKERS[place % len(MARKERS)]
        ax.plot(cost[place], error[place], marker, color=colour, markersize=6.5)
    if known_to:
        ax.axhline(known_to, color=colour, linestyle=":", linewidth=1.2)
    ax.set(xlabel="core-seconds (processor)", ylabel="error (%)")
    ax.margins(_MARGIN)
    for axis in (ax.xaxis, ax.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=_FEW if high > _WIDE * low else _MORE))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    ax.grid(alpha=0.3)
    return ax


def grid_markers(ax: Axes, cells: Sequence[float]) -> None:
    """The markers of the grids (m, coarse to fine), and the dotted line, for a legend."""
    for cell, marker in zip(cells, MARKERS, strict=False):
        ax.plot([], [], marker, color="0.4", markersize=6.5, label=f"h = {cell:g} m")
    ax.plot([], [], ":", color="0.4", linewidth=1.2, label="uncertainty of the limit")
