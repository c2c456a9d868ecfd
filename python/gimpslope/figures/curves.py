"""Curves against time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .. import _check
from ..energy import Energy
from ..ledger import LedgerRows
from .canvas import new_axes
from .paper import Paper, of_runs
from .quantity import PAPER_COLOUR

_AREAS = (
    ("plastic", "plastic work", "#8c2d04"),
    ("friction", "friction at walls", "#d94801"),
    ("impact", "impact at walls", "#f7a35c"),
    ("damping", "damping", "#7f7f7f"),
    ("rigidity", "rigidity of stones", "#b5651d"),
    ("transfer", "transfer between points and grid", "#6a51a3"),
    ("kinetic", "kinetic", "#2171b5"),
    ("elastic", "elastic", "#41ab5d"),
    ("potential", "potential, above its least", "#d9d9d9"),
)
_VISIBLE = 1e-3


def kinetic_energy(
    energy: Energy, ax: Axes | None = None, *, reference: Mapping[str, float] | None = None
) -> Axes:
    """Kinetic energy (kJ/m) against time (s), with its peak and the time of the paper's.

    `reference` holds values of the paper by the keys of a run's summary; time_of_peak is used here.
    """
    ax = ax or new_axes()
    ax.plot(energy.time, energy.kinetic / 1e3, color="C0", linewidth=1.8)
    if len(energy):
        time, value = energy.peak
        label = f"peak: {value / 1e3:.4g} kJ/m at {time:.2f} s"
        ax.plot([time], [value / 1e3], "o", color="C0", markersize=7, label=label)
    if reference and "time_of_peak" in reference:
        time = reference["time_of_peak"]
        label = f"time of the paper's peak: {time:g} s"
        ax.axvline(time, color=PAPER_COLOUR, linestyle="--", linewidth=1.2, label=label)
    _frame(ax)
    ax.margins(y=0.25)
    ax.set_ylim(bottom=0)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper right")
    return ax


def kinetic_energies(
    energies: Mapping[str, Energy],
    ax: Axes | None = None,
    *,
    until: float | None = None,
    reference: Paper | None = None,
) -> Axes:
    """Kinetic energies (kJ/m) of several runs against time (s), with their peaks.

    Parameters
    ----------
    energies : by the names in the legend
    until : end of the axis of time, s; None: of the longest run
    reference : values of the paper by the same names, each by the keys of a run's summary; a
        triangle on the axis marks time_of_peak where it is given

    Raises
    ------
    TypeError, ValueError
        If `until` is not a number > 0, or values of the paper are by a name that no run has.
    """
    ax = ax or new_axes()
    paper = of_runs(reference, energies)
    for number, (name, energy) in enumerate(energies.items()):
        ax.plot(energy.time, energy.kinetic / 1e3, color=f"C{number}", linewidth=1.6, label=name)
        if len(energy):
            time, value = energy.peak
            ax.plot([time], [value / 1e3], "o", color=f"C{number}", markersize=5)
    _frame(ax)
    ax.set_ylim(bottom=0)
    marks = [paper[name].get("time_of_peak", np.nan) for name in energies]
    shown = (
        np.nanmax([ax.get_xlim()[1], *marks]) if until is None else _check.positive("until", until)
    )
    ax.set_xlim(right=shown)
    for number, marked in enumerate(marks):
        if marked <= shown:
            ax.plot([marked], [0], "^", color=f"C{number}", markersize=8, clip_on=False, zorder=3)
    ax.legend(handles=[*ax.get_legend_handles_labels()[0], *_marks(paper)], loc="upper right")
    return ax


def _marks(paper: Paper) -> list[Line2D]:
    """What the legend says of the marks of all curves."""
    meant = {"o": "peak"}
    if any("time_of_peak" in values for values in paper.values()):
        meant["^"] = "time of the paper's peak"
    return [
        Line2D([], [], marker=mark, color="0.4", linestyle="none", label=label)
        for mark, label in meant.items()
    ]


def ledger(rows: LedgerRows, ax: Axes | None = None) -> Axes:
    """Stacked areas of all energies (kJ/m) against time (s): what there is, and where it went.

    Parts below a thousandth of the whole are left out, and so are negative parts; the two entries
    that may have either sign, the residue of the time step and that of the rate law, are one line.
    """
    ax = ax or new_axes()
    parts = {name: getattr(rows, name) / 1e3 for name, _, _ in _AREAS}
    parts["potential"] = parts["potential"] - parts["potential"].min(initial=np.inf)
    whole = float(np.sum(list(parts.values()), axis=0).max(initial=0.0))
    shown = [area for area in _AREAS if np.max(parts[area[0]], initial=0.0) > _VISIBLE * whole]
    ax.stackplot(
        rows.time,
        [np.maximum(parts[name], 0.0) for name, _, _ in shown],
        labels=[label for _, label, _ in shown],
        colors=[colour for _, _, colour in shown],
    )
    residue = (rows.integration + rows.hypoelastic) / 1e3
    ax.plot(rows.time, residue, "k--", linewidth=1.0, label="residues of step and rate law")
    ax.set(xlabel="time since the trigger (s)", ylabel="energy (kJ/m)")
    ax.set_xlim(np.min(rows.time, initial=0.0), np.max(rows.time, initial=0.0) or 1.0)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)
    return ax


def _frame(ax: Axes) -> None:
    ax.set(xlabel="time since the trigger (s)", ylabel="kinetic energy (kJ/m)")
    ax.set_xlim(left=0)
    ax.grid(alpha=0.3)
