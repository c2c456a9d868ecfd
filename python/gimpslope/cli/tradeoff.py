"""`gimpslope tradeoff`: error against cost."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from pathlib import Path

from tqdm import tqdm

from ..studies import tradeoff
from .commands import Commands
from .paths import make_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser(
        "tradeoff",
        help="chart error against core-seconds, over methods, grids and steps",
        description="Runs that were made before are taken as they are, so that a sweep that was "
        "stopped goes on with those that are missing.",
    )
    parser.set_defaults(prepare=_prepare)
    parser.add_argument(
        "problems",
        nargs="*",
        metavar="PROBLEM",
        help=f"all, or some of {', '.join(tradeoff.PROBLEMS)}",
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="the two coarsest grids, each choice alone",
    )
    parser.add_argument(
        "--jobs", type=int, metavar="N", help="runs at a time (default: as many as processors)"
    )
    parser.add_argument(
        "--output", default="tradeoff", metavar="DIR", help="(default: %(default)s)"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    jobs = (os.cpu_count() or 1) if options.jobs is None else options.jobs
    if jobs < 1:
        raise ValueError(f"--jobs must be a whole number >= 1, got {jobs}")
    plan = tradeoff.plan(options.problems or list(tradeoff.PROBLEMS), quick=options.quick)
    make_directory("--output", options.output)
    folder = Path(options.output)

    def command() -> int:
        missing = tradeoff.missing(plan, folder)
        with tqdm(desc="runs", total=missing, disable=options.quiet) as bar:
            for _ in tradeoff.sweep(plan, folder, jobs=jobs):
                bar.update()
        print(tradeoff.write(plan, folder))
        print(f"charts, table and summary: {options.output}{os.sep}")
        return 0

    return command
