"""The tables of the page: figures beside the paper's, claims with verdicts, figures by grid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..._check import FloatArray
from .. import reference
from .quantities import QUANTITIES, Quantity
from .refinement import Refinement

if TYPE_CHECKING:
    from .study import Study


def comparison(studies: Sequence[Study]) -> str:
    """Figures of each slope beside those of the paper, in each reading, with the difference."""
    head = ["slope", "figure", "paper"]
    head += [cell for one in studies for cell in (f"`{one.reading}`", "difference")]
    rows = []
    for name in reference.SLOPES:
        for quantity in QUANTITIES:
            row = [reference.title(name), quantity.label, quantity.shown_paper(name)]
            for one in studies:
                values = np.array([getattr(draw, quantity.figure) for draw in one.measures[name]])
                row += [shown(values, quantity), _difference(values.mean(), quantity, name)]
            rows.append(row)
    return table(head, rows)


def claims(studies: Sequence[Study]) -> str:
    """Each claim of the paper with its verdict and figures in each reading, and on finer grids."""
    head = ["section", "the paper says"]
    for one in studies:
        head.append(f"`{one.reading}`")
        if one.refinement:
            cells = ", ".join(f"{cell:g}" for cell in one.refinement.grids)
            slopes = ", ".join(one.refinement.slopes)
            head.append(f"`{one.reading}`, {slopes} at {cells} m")
    rows = []
    for number, (claim, _) in enumerate(studies[0].judgements):
        row = [claim.section, claim.text]
        for one in studies:
            _, judgement = one.judgements[number]
            row.append(_with_figures(*judgement))
            if one.refinement:
                row.append(_with_figures(*one.refinement.survivals[number]))
        rows.append(row)
    return table(head, rows)


def grids(found: Refinement) -> str:
    """Figures of some slopes on each grid, and what they do as the cell shrinks."""
    head = ["slope", "figure", "paper", *(f"h = {cell:g} m" for cell in found.grids)]
    rows = []
    for name in found.slopes:
        for quantity in QUANTITIES:
            row = [reference.title(name), quantity.label, quantity.shown_paper(name)]
            row += [shown(draws, quantity) for draws in found.values(name, quantity.figure)]
            rows.append([*row, _limit(found, name, quantity)])
        if name in found.gaps:
            gaps = [", ".join(f"{gap:.2f}" for gap in draws) for draws in found.gaps[name]]
            label = "smallest gap between stones of each draw, cells"
            rows.append([reference.title(name), label, "-", *gaps, "-"])
    return table([*head, "limit"], rows)


def _with_figures(verdict: str, figures: str) -> str:
    return f"**{verdict}**: {figures}" if figures else f"**{verdict}**"


def shown(draws: FloatArray, quantity: Quantity) -> str:
    """The mean over the draws, and their standard deviation where there are several."""
    mean = float(draws.mean())
    if len(draws) < 2 or np.isnan(mean):
        return quantity.shown(mean)
    return f"{quantity.shown(mean)} ± {draws.std(ddof=1):.{quantity.digits}f}"


def _difference(here: float, quantity: Quantity, slope: str) -> str:
    paper = quantity.paper(slope)
    if np.isnan(paper) or np.isnan(here):
        return "-"
    if quantity.is_bound and here > paper:
        return "above"
    return f"{here - paper:+.{quantity.digits}f}"


def _limit(found: Refinement, slope: str, quantity: Quantity) -> str:
    limit = None if quantity.counted else found.limit(slope, quantity.figure)
    if limit is None:
        return "-"
    if limit.behaviour != "converges":
        return limit.behaviour
    uncertainty = f"{limit.uncertainty:.{quantity.digits}f}"
    return f"{quantity.shown(limit.limit)} ± {uncertainty}"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """In Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
