"""Bars of the largest displacements."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.patches import Patch

from ..run import Run
from ..snapshot import MaxDisplacement
from .canvas import new_axes
from .paper import Paper, of_runs
from .quantity import PAPER_COLOUR

_WIDTH = 0.8
_SUMMARY_KEYS = {name: f"max_displacement_{name}" for name in MaxDisplacement._fields}


def displacement_bars(
    runs: Mapping[str, Run],
    reference: Mapping[str, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Bars of the largest displacement in the end (m): total, horizontal and vertical.

    `runs` are named as in the legend; `reference` holds values of the paper by the keys of a run's
    summary: max_displacement_total, max_displacement_horizontal and max_displacement_vertical, as
    many as the paper has.
    """
    ax = ax or new_axes()
    series = [
        (name, f"C{number}", run.max_displacement()._asdict())
        for number, (name, run) in enumerate(runs.items())
    ]
    paper = _of_paper(reference or {})
    if paper:
        series.append(("the paper", PAPER_COLOUR, paper))
    width = _WIDTH / len(series)
    for number, (name, colour, heights) in enumerate(series):
        places = [
            tick + (number - (len(runs) + (part in paper) - 1) / 2) * width
            for tick, part in enumerate(_SUMMARY_KEYS)
            if part in heights
        ]
        drawn = ax.bar(places, list(heights.values()), 0.92 * width, color=colour, label=name)
        ax.bar_label(drawn, fmt="%.2f", padding=2, fontsize="small")
    ax.set_xticks(range(len(_SUMMARY_KEYS)), list(_SUMMARY_KEYS))
    ax.set_ylabel("largest displacement (m)")
    ax.margins(y=0.25)
    ax.legend(loc="upper right")
    return ax


class _Bar(NamedTuple):
    name: str  # of the part of the displacement
    height: float
    paper: bool


def displacement_bars_by_run(
    runs: Mapping[str, Run],
    reference: Paper | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Bars of the largest displacement in the end (m), those of a run beside each other.

    Each bar is followed by the paper's, hatched, where `reference` gives its value: by the names of
    the runs, each by the keys of a run's summary. Raises `ValueError` for values by another name.
    """
    ax = ax or new_axes()
    paper = of_runs(reference, runs)
    groups = [_group(run, paper[name]) for name, run in runs.items()]
    width = _WIDTH / max(map(len, groups))
    for place, bars in enumerate(groups):
        for number, bar in enumerate(bars):
            x = place + (number - (len(bars) - 1) / 2) * width
            colour = f"C{list(_SUMMARY_KEYS).index(bar.name)}"
            style = {"color": colour} if not bar.paper else _paper_style(colour)
            drawn = ax.bar([x], [bar.height], 0.92 * width, **style)
            digits = "%g" if bar.paper else "%.2f"
            ax.bar_label(drawn, fmt=digits, padding=2, fontsize="small")
    ax.set_xticks(range(len(runs)), list(runs))
    ax.set_ylabel("largest displacement (m)")
    ax.margins(y=0.22)
    legend = [Patch(color=f"C{number}", label=name) for number, name in enumerate(_SUMMARY_KEYS)]
    if any(bar.paper for bars in groups for bar in bars):
        legend.append(Patch(label="the paper", **_paper_style("0.4")))
    ax.legend(handles=legend, loc="upper right", ncols=len(legend))
    return ax


def _group(run: Run, paper: Mapping[str, float]) -> list[_Bar]:
    bars, published = [], _of_paper(paper)
    for name, height in run.max_displacement()._asdict().items():
        bars.append(_Bar(name, height, paper=False))
        if name in published:
            bars.append(_Bar(name, published[name], paper=True))
    return bars


def _of_paper(paper: Mapping[str, float]) -> dict[str, float]:
    """The parts of the displacement that the paper has, by their names."""
    return {name: paper[key] for name, key in _SUMMARY_KEYS.items() if key in paper}


def _paper_style(colour: str) -> dict[str, Any]:
    return {"facecolor": "white", "edgecolor": colour, "hatch": "////"}
