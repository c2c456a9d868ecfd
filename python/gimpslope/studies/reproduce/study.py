"""The runs of the study: planned, made, measured, and written down."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from ... import _check
from ...figures import study as figures
from ...run import Run
from ...setup import Setup
from ...solver import Solver
from .. import parallel, plain_data, planned, reference
from ..planned import Planned
from . import report
from .claims import Claim, judge
from .judging import STONES, Judgement
from .measures import Measures, measure
from .sample import has_own_spread, spread

SEEDS = (1,)
_DPI = 120


@dataclass(frozen=True)
class Slope:
    """One slope of the study in one reading, with one run a draw of its stones."""

    reading: str
    name: str
    planned: tuple[Planned, ...]


@dataclass(frozen=True)
class Study:
    """The study in one reading.

    Attributes
    ----------
    reading : of the paper, see `reference.READINGS`
    runs : of each slope, those of its draws, the first of which is shown in figures
    measures : the figures of these runs
    judgements : each claim of the paper, and what the runs say of it
    """

    reading: str
    runs: Mapping[str, tuple[Run, ...]]
    measures: Mapping[str, tuple[Measures, ...]]
    judgements: Sequence[tuple[Claim, Judgement]]


def plan(
    directory: str | PathLike[str],
    *,
    readings: Sequence[str] = tuple(reference.READINGS),
    cell: float = 0.1,
    stone_modulus: float = reference.STONE_MODULUS,
    seeds: Sequence[int] = SEEDS,
    duration: float = 10.0,
    time_step: float | None = None,
    overwrite: bool = False,
) -> list[Slope]:
    """The runs that the study needs, and those that are there already; writes nothing.

    Parameters
    ----------
    directory : for the run files. Finished runs of the same setup and version are taken as they are
    readings : some of `reference.READINGS`
    cell : side of a grid cell, m
    stone_modulus : Young's modulus of the stones, Pa
    seeds : of the draws of stones, each another one
    duration : of the slides, s
    time_step : fixed, s; None: a Courant number of 0.4
    overwrite : replace files of those names that hold other runs

    Raises
    ------
    TypeError, ValueError
        If a parameter is refused.
    FileExistsError
        If a file of those names holds something else and may not be replaced.
    """
    if not seeds or len(set(seeds)) < len(seeds):
        raise ValueError(f"seeds must be one or more different numbers, got {list(seeds)}")
    for seed in seeds:
        _check.whole("seed", seed, 0)
    slopes = []
    for reading in readings:
        for name in reference.SLOPES:
            draws = []
            for seed in seeds if name != "soil" else seeds[:1]:
                setup = reference.setup(
                    name,
                    reading=reading,
                    cell=cell,
                    duration=duration,
                    seed=seed,
                    stone_modulus=stone_modulus,
                    time_step=time_step,
                )
                _check_step(setup)
                drawn = "" if name == "soil" else f"_{seed}"
                path = Path(directory) / f"{reading}_{name}{drawn}.h5"
                draws.append(planned.plan(path, setup, overwrite=overwrite))
            slopes.append(Slope(reading, name, tuple(draws)))
    return slopes


def _check_step(setup: Setup) -> None:
    """Refuse a time step above the stable limit now, and not in a process after hours."""
    if setup.method.time_step is not None:
        Solver.of(setup.scene, setup.method)


def study(slopes: Sequence[Slope], *, jobs: int = 1, progress: bool = True) -> list[Study]:
    """Run what was planned, at most `jobs` runs at a time, and judge the claims of the paper: one
    study a reading. Raises `parallel.RunFailed` if a run does not reach its end."""
    # The longest runs first, so that none is left alone at the end.
    wanted = sorted(
        (one for slope in slopes for one in slope.planned),
        key=lambda one: len(one.setup.scene.stones) == 0,
    )
    runs = {run.path: run for run in parallel.run_all(wanted, jobs=jobs, progress=progress)}
    studies = []
    for reading in dict.fromkeys(slope.reading for slope in slopes):
        of_reading = {
            slope.name: tuple(runs[one.path] for one in slope.planned)
            for slope in slopes
            if slope.reading == reading
        }
        measures = {name: tuple(map(measure, draws)) for name, draws in of_reading.items()}
        studies.append(Study(reading, of_reading, measures, judge(measures)))
    return studies


def write(studies: Sequence[Study], directory: str | PathLike[str]) -> None:
    """Write a summary (Markdown and HTML), what was measured (JSON), and in a directory for each
    reading figures 3 to 8 and, of enough draws, their spread (JSON), into a directory."""
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    for one in studies:
        shown = {_title(name): draws[0] for name, draws in one.runs.items()}
        paper = {_title(name): reference.PAPER[name] for name in one.runs}
        (folder / one.reading).mkdir(exist_ok=True)
        for number, figure in figures.figures(shown, paper).items():
            figure.savefig(folder / report.picture(one.reading, number), dpi=_DPI)
    (folder / "figures.json").write_text(plain_data.dumps(_figures(studies)))
    for one in studies:
        drawn = [one.measures[name] for name in STONES]
        if has_own_spread(drawn):
            known = {"from": report.settings_of(one), "spread": spread(drawn)}
            (folder / one.reading / "spread.json").write_text(plain_data.dumps(known))
    text = report.markdown(studies)
    (folder / "summary.md").write_text(text)
    (folder / "summary.html").write_text(report.html(text))


def _title(name: str) -> str:
    """As the paper names its slopes: A soil, B arbitrary and so on."""
    return f"{reference.SLOPES[name]} {name}"


def _figures(studies: Sequence[Study]) -> dict[str, dict[str, dict[str, float]]]:
    """What was measured, by reading, run file and figure."""
    return {
        one.reading: {
            run.path.stem: measures.to_dict()
            for name, draws in one.runs.items()
            for run, measures in zip(draws, one.measures[name], strict=True)
        }
        for one in studies
    }
