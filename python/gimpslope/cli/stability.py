"""`gimpslope stability`: measure where methods fail."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable

from ..studies import stability
from ..studies.stability import report
from .commands import Commands
from .paths import make_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("stability", help="measure where methods fail")
    parser.set_defaults(prepare=_prepare)
    parser.add_argument(
        "names", nargs="*", metavar="MODE", help=f"all, or some of {', '.join(stability.NAMES)}"
    )
    parser.add_argument(
        "--quick", action="store_true", help="fewer places and coarser grids, in a minute or two"
    )
    parser.add_argument(
        "--output",
        metavar="DIR",
        help="write the atlas (Markdown, HTML, JSON) and its figures",
    )


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    names, full = options.names or stability.NAMES, not options.quick
    for name in names:
        stability.mode(name)
    if options.output is not None:
        make_directory("--output", options.output)

    def command() -> int:
        surveyed: list[stability.Surveyed] = []
        try:
            for one in stability.survey(names, full=full):
                surveyed.append(one)
                print(report.line(one), file=sys.stderr, flush=True)
                if options.output is not None:
                    report.draw(one, options.output)
                    report.write(surveyed, options.output, full=full)
        finally:  # what is measured is shown, also when the rest is interrupted
            if surveyed:
                print(report.text(surveyed))
        if options.output is not None:
            print(f"atlas and figures: {options.output}{os.sep}")
        return 0 if all(one.holds for one in surveyed) else 1

    return command
