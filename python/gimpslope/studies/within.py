"""The four slopes of the reference study by plans: each of its figures to an error asked for, or
what is known of it where that cannot be had."""

from __future__ import annotations

import sys
import time as clock
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from importlib.metadata import version
from os import PathLike
from pathlib import Path

from .. import planning
from ..planning import Estimate, Target
from . import plain_data, processes, reference

QUANTITIES = (
    "peak_kinetic_energy",
    "time_of_peak",
    "max_displacement_total",
    "max_displacement_horizontal",
    "max_displacement_vertical",
)
"""Those that the paper reports."""


@dataclass(frozen=True)
class Slope:
    """What a plan gave for a slope.

    Attributes
    ----------
    name : one of `reference.SLOPES`
    estimates : of each quantity, by all grids
    promised, reached : whether the plan held the error asked for, and whether the answer does
    points : of the finest grid
    steps : of all grids, the pilots included
    predicted : wall time of the run after the pilots, s
    seconds : wall time of it and of the pilots, s
    reasons : of the plan
    """

    name: str
    estimates: tuple[Estimate, ...]
    promised: bool
    reached: bool
    points: int
    steps: int
    predicted: float
    seconds: tuple[float, float]
    reasons: tuple[str, ...]


@dataclass(frozen=True)
class Study:
    """The slopes, and the wall time of all, s."""

    target: Target
    reading: str
    seed: int
    slopes: tuple[Slope, ...]
    seconds: float


def study(
    target: Target,
    directory: str | PathLike[str],
    *,
    reading: str = "identified",
    seed: int = 1,
    jobs: int = 1,
    overwrite: bool = False,
    progress: bool = True,
) -> Study:
    """Plan and run the slopes, at most `jobs` at a time; Ctrl-C or SIGTERM ends all.

    Parameters
    ----------
    target : its budget is that of all slopes together
    directory : for a run file a slope
    reading : one of `reference.READINGS`
    seed : of the stones
    jobs : processes, >= 1. A script that calls this needs `if __name__ == "__main__":`, for the
        processes import it
    overwrite : replace run files that are there
    progress : tell of each slope on standard error

    Raises
    ------
    FileExistsError
        If there is one and it may not be replaced.
    """
    start = clock.perf_counter()
    folder = Path(directory)
    files = [folder / f"{name}.h5" for name in reference.SLOPES]
    if not overwrite and (there := [str(file) for file in files if file.exists()]):
        raise FileExistsError(
            f"output must be a directory without other runs unless overwrite is set, got {there}"
        )
    folder.mkdir(parents=True, exist_ok=True)
    share = target.budget * min(jobs, len(files)) / len(files)
    make = partial(
        _slope,
        folder=folder,
        target=Target(target.error, target.quantities, share),
        reading=reading,
        seed=seed,
        progress=progress,
    )
    # Those with stones take longest; soil fills the gap that they leave.
    names = sorted(reference.SLOPES, key="soil".__eq__)
    outcomes = processes.run_all([partial(make, name) for name in names], jobs=jobs)
    made = dict(zip(names, outcomes, strict=True))
    slopes = tuple(made[name].value() for name in reference.SLOPES)
    return Study(target, reading, seed, slopes, clock.perf_counter() - start)


def _slope(
    name: str, *, folder: Path, target: Target, reading: str, seed: int, progress: bool
) -> Slope:
    def say(what: object) -> None:
        print(f"{reference.title(name)}: {what}", file=sys.stderr, flush=True)

    def tell(what: str) -> None:
        if progress:
            say(what)

    # The process is this slope's own: its warnings are lines of the study, without a place in code.
    warnings.showwarning = lambda message, *_, **__: say(message)
    tell("pilots")
    plan = planning.plan(
        reference.slope(name, reading, seed=seed),
        target.error,
        target.quantities,
        method=reference.method(reading, ledger=False, volumetric_strain=None),
        budget=target.budget,
        progress=False,
    )
    tell(f"{plan.pilot_seconds:.0f} s of pilots; a run of about {plan.seconds:.0f} s")
    answer = plan.run(folder / f"{name}.h5", overwrite=True)
    return Slope(
        name,
        tuple(answer.estimates.values()),
        plan.holds,
        answer.reached,
        answer.grids[-1].points,
        sum(grid.steps for grid in answer.grids),
        plan.seconds,
        (answer.seconds, plan.pilot_seconds),
        plan.reasons,
    )


def markdown(found: Study) -> str:
    """The study as a page: a table of the quantities, one of the cost, and why."""
    slopes = found.slopes
    titles = [reference.title(slope.name) for slope in slopes]
    lines = [
        f"# The four slopes to an error of {found.target.error:g}",
        "",
        f"gimpslope {version('gimpslope')}, `gimpslope reproduce --error {found.target.error:g}`: "
        f"reading `{found.reading}`, stones of seed {found.seed}, {found.seconds:.0f} s in all, of "
        f"a budget of {found.target.budget:g} s. Values are without grid where three grids "
        "converge, else of the finest; beside them their estimated error and, in brackets, what "
        "the finest grid itself has.",
        "",
        *_row(["", *titles]),
        "|" + "---|" * (len(titles) + 1),
    ]
    for number, name in enumerate(found.target.quantities):
        of_slopes = [_cell(slope.estimates[number]) for slope in slopes]
        lines += _row([planning.QUANTITIES[name].title, *of_slopes])
    lines += _row(["finest cell, m", *(f"{slope.estimates[0].cells[-1]:g}" for slope in slopes)])
    lines += _row(["points", *(f"{slope.points:,}" for slope in slopes)])
    lines += _row(["steps, pilots included", *(f"{slope.steps:,}" for slope in slopes)])
    lines += _row(["s, run and pilots", *("{:.1f} + {:.1f}".format(*s.seconds) for s in slopes)])
    lines += _row(["promised", *("yes" if slope.promised else "no" for slope in slopes)])
    lines += _row(["reached", *("yes" if slope.reached else "no" for slope in slopes)])
    for title, slope in zip(titles, slopes, strict=True):
        lines += ["", f"## {title}", "", *(f"- {reason}" for reason in slope.reasons)]
    return "\n".join(lines) + "\n"


def write(found: Study, directory: str | PathLike[str]) -> None:
    """Write within.md and within.json into a directory."""
    folder = Path(directory)
    (folder / "within.md").write_text(markdown(found))
    plain = [
        {
            "slope": slope.name,
            "promised": slope.promised,
            "reached": slope.reached,
            "quantities": {
                one.name: asdict(one) | {"value": one.value, "error": one.error}
                for one in slope.estimates
            },
            "steps": slope.steps,
            "seconds": slope.seconds,
        }
        for slope in found.slopes
    ]
    (folder / "within.json").write_text(plain_data.dumps(plain))


def _cell(one: Estimate) -> str:
    raw = one.raw[-1] / planning.QUANTITIES[one.name].scale
    return f"{one.shown}, {100 * one.error:.1f} % ({raw:.4g})"


def _row(cells: Sequence[str]) -> list[str]:
    return ["| " + " | ".join(cells) + " |"]
