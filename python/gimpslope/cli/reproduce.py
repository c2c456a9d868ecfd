"""`gimpslope reproduce`: the whole reference study."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable

from ..planning import Target
from ..studies import reference, reproduce, within
from .commands import Commands
from .options import add_readings, add_stone_model
from .paths import make_directory

_BUDGET = 60.0  # s
_NOT_WITH_ERROR = {
    "cell": reproduce.CELL,
    "stone_model": None,
    "stone_modulus": None,
    "stone_friction": None,
    "duration": 10.0,
    "time_step": None,
    "convergence": None,
    "cells": None,
}
"""Options that a plan chooses or does not have, with their defaults."""


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser(
        "reproduce",
        help="run the four slopes of the reference study, and hold its claims against them",
        description="Runs that are finished are taken as they are, so that a study that was "
        "stopped goes on with the runs that are missing.",
    )
    parser.set_defaults(prepare=_prepare)
    add_readings(parser)
    parser.set_defaults(reading=None)
    parser.add_argument(
        "--cell",
        type=float,
        default=reproduce.CELL,
        metavar="H",
        help="m (default: %(default)s)",
    )
    add_stone_model(parser)
    parser.add_argument(
        "--seed",
        type=int,
        nargs="+",
        default=list(reproduce.SEEDS),
        metavar="N",
        help="of the stones; with five or more their own spread decides claims (default: 1)",
    )
    parser.add_argument(
        "--duration", type=float, default=10.0, metavar="S", help="of the slides, s (default: 10)"
    )
    parser.add_argument(
        "--time-step",
        type=float,
        metavar="S",
        help="fixed, s; the paper's is 1e-5 (default: by a Courant number of 0.4)",
    )
    parser.add_argument(
        "--convergence",
        nargs="*",
        choices=list(reference.SLOPES),
        metavar="SLOPE",
        help="run slopes on several grids too, with the first two seeds, and say which claims "
        f"survive refinement (of no name: {' and '.join(reproduce.REFINED)})",
    )
    parser.add_argument(
        "--cells",
        type=float,
        nargs="+",
        metavar="H",
        help="of --convergence, m, each half of the one before "
        f"(default: {' '.join(map(str, reproduce.CELLS))})",
    )
    parser.add_argument(
        "--error",
        type=float,
        metavar="E",
        help="in place of all that, plan each slope for its figures to that error, a share, and "
        f"run it so, of one reading (default: {next(iter(reference.READINGS))}) and seed, with "
        "volume strains averaged over cells",
    )
    parser.add_argument(
        "--budget",
        type=float,
        metavar="S",
        help="of --error, wall time in all, s, beyond which no more is begun than two pilots a "
        f"slope (default: {_BUDGET:g})",
    )
    parser.add_argument(
        "--jobs", type=int, metavar="N", help="runs at a time (default: as many as processors)"
    )
    parser.add_argument("--output", default="study", metavar="DIR", help="(default: %(default)s)")
    parser.add_argument(
        "--overwrite", action="store_true", help="replace files of other runs in the directory"
    )
    parser.add_argument("--quiet", action="store_true", help="tell of no progress")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    jobs = (os.cpu_count() or 1) if options.jobs is None else options.jobs
    if jobs < 1:
        raise ValueError(f"--jobs must be a whole number >= 1, got {jobs}")
    if options.cells is not None and options.convergence is None:
        raise ValueError(f"--cells must be given with --convergence, got {options.cells} alone")
    if options.error is not None:
        return _within(options, jobs)
    if options.budget is not None:
        raise ValueError(f"--budget must be given with --error, got {options.budget} alone")
    none_named = options.convergence == []
    plan = reproduce.plan(
        options.output,
        readings=list(dict.fromkeys(options.reading or reference.READINGS)),
        cell=options.cell,
        stone_model=options.stone_model or "deformable",
        stone_modulus=options.stone_modulus,
        stone_friction=options.stone_friction,
        seeds=options.seed,
        duration=options.duration,
        time_step=options.time_step,
        refined=reproduce.REFINED if none_named else options.convergence or (),
        cells=options.cells or reproduce.CELLS,
        overwrite=options.overwrite,
    )
    make_directory("--output", options.output)

    def command() -> int:
        studies = reproduce.study(plan, jobs=jobs, progress=not options.quiet)
        reproduce.write(studies, options.output)
        for reading, verdicts in reproduce.report.counts(studies).items():
            shown = ", ".join(f"{verdict}: {count}" for verdict, count in verdicts.items())
            print(f"claims of the paper, reading {reading}: {shown}")
        print(f"runs, figures and summary (summary.md, summary.html): {options.output}{os.sep}")
        return 0

    return command


def _within(options: argparse.Namespace, jobs: int) -> Callable[[], int]:
    for name, default in _NOT_WITH_ERROR.items():
        if (given := getattr(options, name)) != default:
            option = "--" + name.replace("_", "-")
            raise ValueError(f"{option} must be left out with --error, got {given!r}")
    readings = options.reading or list(reference.READINGS)[:1]
    for option, of_all in (("--reading", readings), ("--seed", options.seed)):
        if len(of_all) > 1:
            raise ValueError(f"{option} must be a single one with --error, got {of_all}")
    budget = _BUDGET if options.budget is None else options.budget
    target = Target(options.error, within.QUANTITIES, budget)
    make_directory("--output", options.output)

    def command() -> int:
        found = within.study(
            target,
            options.output,
            reading=readings[0],
            seed=options.seed[0],
            jobs=jobs,
            overwrite=options.overwrite,
            progress=not options.quiet,
        )
        within.write(found, options.output)
        print(within.markdown(found))
        print(f"runs and table (within.md): {options.output}{os.sep}")
        return 0

    return command
