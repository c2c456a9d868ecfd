"""`gimpslope verify`: solve problems with known answers."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable

from ..studies import verify
from ..studies.verify import report
from .commands import Commands
from .paths import make_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("verify", help="solve problems with known answers")
    parser.set_defaults(prepare=_prepare, full=False)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"all, or some of {', '.join(verify.NAMES)}"
    )
    size = parser.add_mutually_exclusive_group()
    size.add_argument(
        "--quick", dest="full", action="store_false", help="in a minute (the default)"
    )
    size.add_argument("--full", action="store_true", help="finest grids and all cases, in minutes")
    parser.add_argument(
        "--output", metavar="DIR", help="write the table (Markdown, JSON) and the figures"
    )


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    names = options.names or verify.NAMES
    for name in names:
        verify.problem(name)
    if options.output is not None:
        make_directory("--output", options.output)

    def command() -> int:
        solved: list[verify.Solved] = []
        try:
            for one in verify.solve(names, full=options.full):
                solved.append(one)
                print(report.line(one), file=sys.stderr, flush=True)
                if options.output is not None:
                    report.draw(one, options.output)
                    report.write(solved, options.output, full=options.full)
        finally:  # what is solved is shown, also when the rest is interrupted
            if solved:
                print(report.text(solved))
        if options.output is not None:
            print(f"table and figures: {options.output}{os.sep}")
        return 0 if all(one.holds for one in solved) else 1

    return command
