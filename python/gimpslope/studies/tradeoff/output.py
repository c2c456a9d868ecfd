"""A sweep, written down: the page, a table of all cases, and the charts."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from pathlib import Path

from . import figures, summary, words
from .measure import Measured, measured
from .pareto import front, held
from .plan import Plan
from .ranking import of_each

_DPI = 90
_COLUMNS = (
    *("cell_m", "stone_model", "method", "changes", "error", "error_that_holds", "core_seconds"),
    *("fastest", "slowest", "rounds", "on_front", "failure"),
)


def write(plan: Plan, folder: Path) -> str:
    """Write summary.md, and a table and a chart a problem, of the runs that are there; the page."""
    found = measured(plan, folder)
    page = summary.markdown(plan, found)
    (folder / "summary.md").write_text(page)
    by_problem = of_each(plan, found)
    for problem, some in by_problem:
        _table(folder / f"{problem.name}.csv", some)
        figures.chart(problem, some).savefig(folder / f"{problem.name}.png", dpi=_DPI)
    figures.overview(by_problem).savefig(folder / "overview.png", dpi=_DPI)
    return page


def _table(path: Path, some: Sequence[Measured]) -> None:
    errors, best = held(some), set(front(some))
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(_COLUMNS)
        for one in some:
            changed = dict(one.case.changes)
            rows.writerow(
                [
                    *(one.case.cell, one.case.model, words.changes(changed), json.dumps(changed)),
                    *(one.error, errors[one], one.core_seconds, one.fastest, one.slowest),
                    *(one.rounds, one in best, one.failure),
                ]
            )
