"""Slopes of the study on several grids: how its figures and the claims judged by them depend on
the cell.

In one velocity field stones closer than two cells share nodes, and each acts about a cell larger
than it is, so that slopes with stones depend on the cell more than soil does.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from ..._check import FloatArray
from ...figures.grids import against_cell
from .. import reference
from ..richardson import Extrapolation, extrapolate_means
from .claims import judge
from .judging import DOES_NOT, HOLDS, NOT_REACHED, NOT_RUN, Draws
from .quantities import QUANTITIES

Gaps = Mapping[str, Sequence[Sequence[float]]]
"""Between the two nearest stones, in cells, by the name of the slope: rows of draws, one a grid."""

_PICTURED = ("peak_energy", "peak_time", "peak_speed", "total", "horizontal", "vertical")


class Survival(NamedTuple):
    """Whether a claim survives refinement, and the verdicts on each grid from which that follows.

    Attributes
    ----------
    verdict : "survives": it holds on the two finest grids; "does not survive": it holds on a
        coarser grid only; "fails too": it does not hold on the two finest; "appears": it holds on
        the finest alone; "cannot tell" or "not reached" what the finest decides; "not run" where
        it compares none of the slopes
    figures : the verdicts from coarse to fine, with the figures of the finest grid
    """

    verdict: str
    figures: str


@dataclass(frozen=True)
class Refinement:
    """Some slopes on several grids.

    Attributes
    ----------
    grids : the draws of each slope by its name, by the cell (m), coarse to fine
    gaps : of the slopes that have stones, coarse to fine
    survivals : of each claim, in the order of the paper
    """

    grids: Mapping[float, Draws]
    gaps: Gaps
    survivals: tuple[Survival, ...]

    @property
    def slopes(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(next(iter(self.grids.values())))

    def values(self, slope: str, figure: str) -> FloatArray:
        """A figure of a slope, shape (cells, draws)."""
        return np.array(
            [[getattr(one, figure) for one in draws[slope]] for draws in self.grids.values()]
        )

    def limit(self, slope: str, figure: str) -> Extrapolation | None:
        """What the mean over the draws does as the cell shrinks, as `extrapolate_means` says."""
        return extrapolate_means(self.values(slope, figure))


def refinement(grids: Mapping[float, Draws], gaps: Gaps, spread: Mapping[str, float]) -> Refinement:
    """Judge the claims on every grid, as far as they are about these slopes.

    Parameters
    ----------
    grids, gaps : as in `Refinement`
    spread : share by which chance moves each figure from draw to draw
    """
    by_cell = [judge(draws, spread) for draws in grids.values()]
    survivals = [
        _survival(dict(zip(grids, (judgement for _, judgement in claims), strict=True)))
        for claims in zip(*by_cell, strict=True)
    ]
    return Refinement(grids, gaps, tuple(survivals))


def _survival(judgements: Mapping[float, tuple[str, str]]) -> Survival:
    verdicts = [verdict for verdict, _ in judgements.values()]
    before, finest = verdicts[-2:]
    if finest == NOT_RUN:
        return Survival(NOT_RUN, "it compares other slopes")
    if finest == HOLDS:
        word = "survives" if before == HOLDS else "appears"
    elif finest == DOES_NOT:
        word = "does not survive" if HOLDS in verdicts else "fails too"
    else:
        word = NOT_REACHED if finest == NOT_REACHED else "cannot tell"
    shown = []
    for verdict, group in groupby(judgements, key=lambda cell: judgements[cell][0]):
        shown.append(f"{verdict} at {', '.join(f'{cell:g}' for cell in group)} m")
    *_, (_, figures) = judgements.values()
    return Survival(word, f"{'; '.join(shown)} ({figures})")


def figure(found: Refinement) -> Figure:
    """Figures of the slopes against the cell, with the paper's values."""
    quantities = [one for name in _PICTURED for one in QUANTITIES if one.figure == name]
    titles = {slope: reference.title(slope) for slope in found.slopes}
    made = Figure(figsize=(9.0, 5.4), layout="constrained")
    axes = made.subplots(2, len(quantities) // 2, sharex=True)
    labels: dict[str, Artist] = {}
    for ax, quantity in zip(axes.flat, quantities, strict=True):
        values = {title: found.values(slope, quantity.figure) for slope, title in titles.items()}
        paper = {title: quantity.paper(slope) for slope, title in titles.items()}
        paper = {title: value for title, value in paper.items() if not math.isnan(value)}
        published, bounds = ({}, paper) if quantity.is_bound else (paper, {})
        against_cell(tuple(found.grids), values, ax, reference=published, bounds=bounds)
        ax.set_title(quantity.label, fontsize="medium")
        if ax not in axes[-1]:
            ax.set_xlabel("")
        handles, names = ax.get_legend_handles_labels()
        labels |= dict(zip(names, handles, strict=True))
    columns = min(len(labels), 5)
    made.legend(labels.values(), labels.keys(), loc="outside lower center", ncols=columns)
    return made
