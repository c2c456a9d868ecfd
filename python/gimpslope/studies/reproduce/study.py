"""The runs of the study: made, measured, and written down."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

from ...figures import study as figures
from ...run import Run
from .. import parallel, plain_data, reference
from . import report
from .claims import Claim, judge
from .judging import STONES, Judgement
from .measures import Measures, measure
from .plan import Plan, Slope
from .refinement import Refinement, refinement
from .refinement import figure as refinement_figure
from .sample import has_own_spread, spread, spread_of

T = TypeVar("T")

_DPI = 120


@dataclass(frozen=True)
class Study:
    """The study in one reading.

    Attributes
    ----------
    reading : of the paper, see `reference.READINGS`
    seeds : of each slope's draws
    runs : of each slope, those of its draws, the first of which is shown in figures
    measures : the figures of these runs
    judgements : each claim of the paper, and what the runs say of it
    refinement : what some of the slopes do on other grids, if they were run
    """

    reading: str
    seeds: Mapping[str, tuple[int, ...]]
    runs: Mapping[str, tuple[Run, ...]]
    measures: Mapping[str, tuple[Measures, ...]]
    judgements: Sequence[tuple[Claim, Judgement]]
    refinement: Refinement | None


def study(plan: Plan, *, jobs: int = 1, progress: bool = True) -> list[Study]:
    """Run what was planned, at most `jobs` runs at a time, and judge the claims of the paper: one
    study a reading. Raises `parallel.RunFailed` if a run does not reach its end."""
    made = parallel.run_all(plan.runs, jobs=jobs, progress=progress)
    runs = {run.path: run for run in made}
    measured = {run.path: measure(run) for run in made}
    studies = []
    for reading in dict.fromkeys(slope.reading for slope in plan.slopes):
        slopes = {slope.name: slope for slope in plan.slopes if slope.reading == reading}
        measures = {name: _of(slope, measured) for name, slope in slopes.items()}
        spread = spread_of([measures[name] for name in STONES])
        grids: dict[float, dict[str, tuple[Measures, ...]]] = {}
        gaps: dict[str, list[list[float]]] = {}
        for slope in plan.refined:
            if slope.reading == reading:
                grids.setdefault(slope.cell, {})[slope.name] = _of(slope, measured)
                apart = [run.summary["smallest_gap_in_cells"] for run in _of(slope, runs)]
                if there := [gap for gap in apart if gap is not None]:
                    gaps.setdefault(slope.name, []).append(there)
        studies.append(
            Study(
                reading,
                {name: slope.seeds for name, slope in slopes.items()},
                {name: _of(slope, runs) for name, slope in slopes.items()},
                measures,
                judge(measures, spread),
                refinement(grids, gaps, spread) if grids else None,
            )
        )
    return studies


def _of(slope: Slope, by_path: Mapping[Path, T]) -> tuple[T, ...]:
    return tuple(by_path[one.path] for one in slope.planned)


def write(studies: Sequence[Study], directory: str | PathLike[str]) -> None:
    """Write a summary (Markdown and HTML), what was measured (JSON), and in a directory for each
    reading figures 3 to 8 and, of enough draws, their spread (JSON), into a directory."""
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    for one in studies:
        shown = {reference.title(name): draws[0] for name, draws in one.runs.items()}
        paper = {reference.title(name): reference.PAPER[name] for name in one.runs}
        (folder / one.reading).mkdir(exist_ok=True)
        for number, figure in figures.figures(shown, paper).items():
            figure.savefig(folder / report.picture(one.reading, number), dpi=_DPI)
        if one.refinement:
            refinement_figure(one.refinement).savefig(
                folder / report.picture(one.reading, "grids"), dpi=_DPI
            )
    (folder / "figures.json").write_text(plain_data.dumps(_figures(studies)))
    for one in studies:
        drawn = [one.measures[name] for name in STONES]
        if has_own_spread(drawn):
            known = {"from": report.settings_of(one), "spread": spread(drawn)}
            (folder / one.reading / "spread.json").write_text(plain_data.dumps(known))
    text = report.markdown(studies)
    (folder / "summary.md").write_text(text)
    (folder / "summary.html").write_text(report.html(text))


def _figures(studies: Sequence[Study]) -> dict[str, dict[str, Any]]:
    """What was measured, by reading, run file and figure; on several grids by reading, cell, slope,
    draw and figure."""
    measured: dict[str, dict[str, Any]] = {
        one.reading: {
            run.path.stem: measures.to_dict()
            for name, draws in one.runs.items()
            for run, measures in zip(draws, one.measures[name], strict=True)
        }
        for one in studies
    }
    measured["grids"] = {
        one.reading: {
            f"{cell:g}": {name: [each.to_dict() for each in draws] for name, draws in grid.items()}
            for cell, grid in one.refinement.grids.items()
        }
        for one in studies
        if one.refinement
    }
    return measured
