"""Panels of maps: a row a run, a column a moment, at one scale of metres and of colours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .._check import FloatArray
from ..run import Run
from ..run_file import Moment
from ..snapshot import Snapshot
from .canvas import colour_bar, draw_outline
from .maps import draw_state, kinds
from .quantity import KIND, Quantity

WIDTH = 10.0  # inches
_MARGIN = 0.2  # m
_TICKS = 5  # steps along x at most, so that the labels of neighbours keep apart
_BESIDE = 1.3  # inches of the width that labels take
_ABOVE = 0.45  # inches of the height of each row that its titles and labels take
_BELOW = 1.1  # inches of the height that the colour bar takes


class Column(NamedTuple):
    """What a column shows, and when; None: in the end."""

    quantity: Quantity
    moment: Moment | None


class _Frame(NamedTuple):
    """Limits of the maps, m: of each column sideways, of all upwards."""

    x: list[tuple[float, float]]
    y: tuple[float, float]


def panels(runs: Mapping[str, Run], columns: Sequence[Column]) -> Figure:
    """The maps, with one colour bar a quantity; where a run has not reached a time they say so."""
    states = [[reached(run, moment) for _, moment in columns] for run in runs.values()]
    frame = _frame(list(runs.values()), states)
    figure, axes = _grid(len(runs), frame)
    norms = _norms(columns, states)
    for row, (name, run) in enumerate(runs.items()):
        for number, (column, state) in enumerate(zip(columns, states[row], strict=True)):
            ax = axes[row][number]
            _panel(ax, run, column, state, norms[column.quantity])
            label = tag(name, number + 1)
            ax.set_title(
                f"{label}   {_when(run, column.moment, state)}", loc="left", fontsize="medium"
            )
            ax.set(xlim=frame.x[number], ylim=frame.y)
            ax.locator_params(axis="x", nbins=_TICKS)
            ax.label_outer()
        axes[row][0].set_ylabel(f"{name}\ny (m)")
    _explain(axes, runs, columns, norms)
    return figure


def reached(run: Run, moment: Moment | None) -> Snapshot | None:
    """The state at a moment, or in the end; None where the run has not got there."""
    try:
        return run.state(moment)
    except ValueError:
        return None


def tag(name: str, number: int) -> str:
    """What a panel is called: "A2" for the second of a run named "A", or "A soil"."""
    first = (name.split() or [""])[0]
    return f"{first}{number}" if len(first) == 1 else f"{first} {number}"


def last_snapshot(run: Run) -> str:
    """How far the snapshots of a run go, in words."""
    times = run.times
    return f"the last snapshot is at {times[-1]:.2f} s" if len(times) else "there is no snapshot"


def _panel(ax: Axes, run: Run, column: Column, state: Snapshot | None, norm: Normalize) -> None:
    if state is not None:
        draw_state(ax, run, state, column.quantity, norm)
        return
    draw_outline(ax, run.scene.outline.vertices)
    text = f"not reached:\n{last_snapshot(run)}"
    ax.text(0.97, 0.95, text, transform=ax.transAxes, ha="right", va="top", fontsize="small")


def _explain(
    axes: Sequence[Sequence[Axes]],
    runs: Mapping[str, Run],
    columns: Sequence[Column],
    norms: Mapping[Quantity, Normalize],
) -> None:
    """Below all panels a colour bar for each quantity, in the first of the kinds a legend."""
    below = {"location": "bottom", "aspect": 40, "shrink": 0.6, "pad": 0.02}
    everywhere = [ax for row in axes for ax in row]
    for quantity, norm in norms.items():
        if quantity is not KIND:
            colour_bar(everywhere, norm, quantity.cmap, quantity.label, **below)
    for ax, column in zip(axes[0], columns, strict=True):
        if column.quantity is KIND:
            ax.legend(handles=kinds(runs.values()), loc="upper right", fontsize="small")


def _when(run: Run, moment: Moment | None, state: Snapshot | None) -> str:
    """The time that is shown, and when the peak is, where that is what was asked for."""
    wanted = "end" if moment is None else moment if moment == "peak" else f"{moment:.2f} s"
    shown = wanted if state is None else f"{state.time:.2f} s"
    if moment != "peak" or len(run.energy) == 0:
        return shown
    peak = run.phases().peak
    passed = "energy still grows" if peak is None else f"peak at {peak:.2f} s"
    return passed if state is None else f"{shown} ({passed})"


def _norms(
    columns: Sequence[Column], states: Sequence[Sequence[Snapshot | None]]
) -> dict[Quantity, Normalize]:
    shown: dict[Quantity, list[Snapshot]] = {column.quantity: [] for column in columns}
    for row in states:
        for column, state in zip(columns, row, strict=True):
            shown[column.quantity] += [state] if state is not None else []
    return {quantity: quantity.norm(quantity.largest(found)) for quantity, found in shown.items()}


def _frame(runs: Sequence[Run], states: Sequence[Sequence[Snapshot | None]]) -> _Frame:
    outlines = np.concatenate([run.scene.outline.vertices for run in runs])

    def corners(shown: Sequence[Snapshot | None]) -> tuple[FloatArray, FloatArray]:
        places = [state.position for state in shown if state is not None]
        everything = np.concatenate([outlines, *places])
        return everything.min(axis=0) - _MARGIN, everything.max(axis=0) + _MARGIN

    limits = [corners(column) for column in zip(*states, strict=True)]
    lows, highs = (np.array(ends) for ends in zip(*limits, strict=True))
    x = [(low, high) for low, high in zip(lows[:, 0], highs[:, 0], strict=True)]
    return _Frame(x, (lows[:, 1].min(), highs[:, 1].max()))


def _grid(rows: int, frame: _Frame) -> tuple[Figure, list[list[Axes]]]:
    """A figure of maps at one scale, as high as its width makes it."""
    spans = [right - left for left, right in frame.x]
    per_metre = (WIDTH - _BESIDE) / sum(spans)
    height = rows * ((frame.y[1] - frame.y[0]) * per_metre + _ABOVE) + _BELOW
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    axes = figure.subplots(
        rows,
        len(spans),
        sharex="col",
        sharey=True,
        squeeze=False,
        gridspec_kw={"width_ratios": spans},
    )
    return figure, axes.tolist()
