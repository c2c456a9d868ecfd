"""Pictures of a study of convergence: figures against the cell, errors against core-seconds."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from ...figures.cost import error_against_cost, grid_markers
from ...figures.grids import against_cell, limits_beside
from .quantities import QUANTITIES
from .study import Convergence

_COLUMNS = 4
_COSTLY = ("peak_energy", "peak_time", "total", "run_out")


def values(study: Convergence) -> Figure:
    """Each figure that was reached against the cell: draws, their means, and the limits where there
    are any."""
    drawn = {
        quantity: {name: series.values(quantity.figure) for name, series in study.series.items()}
        for quantity in QUANTITIES
    }
    reached = {
        quantity: found
        for quantity, found in drawn.items()
        if any(np.isfinite(each).any() for each in found.values())
    }
    if not reached:
        return _nothing()
    rows = math.ceil(len(reached) / _COLUMNS)
    made = Figure(figsize=(3.3 * _COLUMNS, 2.4 * rows + 0.5), layout="constrained")
    models = list(study.series)
    for place, (quantity, found) in enumerate(reached.items(), start=1):
        ax = made.add_subplot(rows, _COLUMNS, place)
        against_cell(study.cells, found, ax, from_zero=False)
        limits = study.limits(quantity.figure)
        known = {model: (one.limit, one.uncertainty) for model, one in limits.items()}
        limits_beside(known, ax, models)
        ax.set_title(quantity.label, fontsize="medium")
    _legend(made, columns=2 * len(models))
    return made


def costs(study: Convergence) -> Figure:
    """Error against core-seconds of what matters most, a panel each."""
    made = Figure(figsize=(9.0, 7.0), layout="constrained")
    chosen = [one for name in _COSTLY for one in QUANTITIES if one.figure == name]
    for ax, quantity in zip(made.subplots(2, 2).flat, chosen, strict=True):
        ax.set_title(quantity.title, fontsize="medium")
        for number, (model, series) in enumerate(study.series.items()):
            found = study.errors(quantity.figure, model)
            if found is None:
                continue
            error_against_cost(
                series.core_seconds.mean(axis=1),
                100 * found.values,
                ax,
                label=model,
                colour=f"C{number}",
                known_to=100 * found.known_to if found.against.model == model else None,
            )
        if not ax.lines:
            ax.text(0.5, 0.5, "no limit", transform=ax.transAxes, ha="center", va="center")
            ax.set(xticks=[], yticks=[])
    grid_markers(made.axes[-1], study.cells)
    _legend(made, columns=4)
    return made


def _nothing() -> Figure:
    made = Figure(figsize=(6.0, 1.0))
    made.text(0.5, 0.5, "none of the figures was reached on any grid", ha="center", va="center")
    return made


def _legend(figure: Figure, columns: int) -> None:
    """One legend below all panels."""
    labels: dict[str, Artist] = {}
    for ax in figure.axes:
        handles, names = ax.get_legend_handles_labels()
        labels |= dict(zip(names, handles, strict=True))
    figure.legend(labels.values(), labels.keys(), loc="outside lower center", ncols=columns)
