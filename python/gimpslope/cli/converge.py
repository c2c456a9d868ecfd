"""`gimpslope converge`: slope A on finer and finer grids."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable

from ..studies import convergence
from .commands import Commands
from .options import add_readings
from .paths import make_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser(
        "converge", help="run slope A on finer and finer grids; finished runs are taken as they are"
    )
    parser.set_defaults(prepare=_prepare)
    add_readings(parser)
    parser.add_argument(
        "--cells",
        type=float,
        nargs="+",
        default=list(convergence.CELLS),
        metavar="H",
        help="m, each half of the one before (default: 0.4 0.2 0.1 0.05)",
    )
    parser.add_argument("--threads", type=int, default=1, metavar="N", help="(default: 1)")
    parser.add_argument(
        "--output", default="convergence", metavar="DIR", help="(default: %(default)s)"
    )
    parser.add_argument(
        "--overwrite", action="store_true", help="replace files of other runs in the directory"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress bars")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    plans = [
        convergence.plan(
            options.output,
            reading=reading,
            cells=options.cells,
            threads=options.threads,
            overwrite=options.overwrite,
        )
        for reading in options.reading
    ]
    make_directory("--output", options.output)

    def command() -> int:
        studies = [convergence.converge(grids, progress=not options.quiet) for grids in plans]
        print("\n".join(convergence.markdown(study) for study in studies))
        convergence.write(studies, options.output)
        print(f"runs, table and figures: {options.output}{os.sep}")
        return 0

    return command
