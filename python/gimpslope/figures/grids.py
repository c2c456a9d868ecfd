"""Results on several grids."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from .canvas import new_axes

_LIMIT_STEP = 0.04  # of the axis, between the limits of two slopes


def against_cell(
    cells: Sequence[float],
    values: Mapping[str, npt.ArrayLike],
    ax: Axes | None = None,
    *,
    reference: Mapping[str, float] | None = None,
    bounds: Mapping[str, float] | None = None,
    from_zero: bool = True,
) -> Axes:
    """A result against the side of the cell (m): the mean over draws as a line, each draw a point.

    Parameters
    ----------
    cells : m, shape (n,)
    values : by the name of the slope, shape (n, draws); without any that is finite it is left out
    ax : to draw on; None: a new one
    reference : published values by the name of the slope, drawn across
    bounds : published lower bounds by the name of the slope, dotted across
    from_zero : whether the results start at zero on their axis
    """
    ax = ax or new_axes()
    across = (("--", "the paper", reference or {}), (":", "the paper (more than)", bounds or {}))
    for number, (name, draws) in enumerate(values.items()):
        found, colour = np.asarray(draws, dtype=float), f"C{number}"
        if np.isfinite(found).any():
            ax.plot(cells, found.mean(axis=1), "-", color=colour, linewidth=1.8, label=name)
            ax.plot(cells, found, "o", color=colour, markersize=4.5, alpha=0.7)
        for style, whose, published in across:
            if name in published:
                label = f"{name}, {whose}"
                ax.axhline(published[name], color=colour, ls=style, linewidth=1.2, label=label)
    ax.set_xlabel("cell (m)")
    ax.set_xlim(0.0, 1.08 * max(cells))
    _, highest = ax.dataLim.intervaly
    if from_zero and highest > 0:
        ax.set_ylim(0.0, 1.1 * highest)
    ax.grid(alpha=0.3)
    return ax


def limits_beside(
    limits: Mapping[str, tuple[float, float]], ax: Axes, names: Sequence[str]
) -> None:
    """Limits as the cell shrinks, with their uncertainties, beside results that are drawn already.

    Parameters
    ----------
    limits : limit and uncertainty by the name of the slope
    ax : as `against_cell` leaves it
    names : of all slopes, in the order of their colours
    """
    _, right = ax.get_xlim()
    ax.set_xlim(left=-_LIMIT_STEP * right * (len(names) + 1))
    results = [*ax.dataLim.intervaly, *(limit for limit, _ in limits.values())]
    for number, name in enumerate(names):
        if name in limits:
            limit, uncertainty = limits[name]
            place = -_LIMIT_STEP * right * (number + 1)
            drawn = ax.errorbar(place, limit, uncertainty, fmt="s", color=f"C{number}", capsize=3)
            drawn.set_label(f"{name}, limit")
    bottom, top = ax.dataLim.intervaly
    if bottom > top:
        return  # nothing is drawn
    # A limit that is hardly known must not flatten all the rest.
    low, high = min(results), max(results)
    span = high - low or abs(high) or 1.0
    ax.set_ylim(max(bottom, low - span) - 0.05 * span, min(top, high + span) + 0.05 * span)
