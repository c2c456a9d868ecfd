"""`gimpslope stability`: measure where methods fail."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from ..studies import stability
from ..studies.stability import report
from . import checked
from .commands import Commands


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("stability", help="measure where methods fail")
    parser.set_defaults(prepare=_prepare, full=stability.MODES.full)
    parser.add_argument(
        "names", nargs="*", metavar="MODE", help=f"all, or some of {', '.join(stability.NAMES)}"
    )
    parser.add_argument(
        "--quick",
        dest="full",
        action="store_false",
        help="fewer places and coarser grids, in a minute or two",
    )
    parser.add_argument(
        "--output",
        metavar="DIR",
        help="write the atlas (Markdown, HTML, JSON) and its figures",
    )


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    return checked.prepare(options, stability.MODES, report.text, report.write, "atlas")
