"""`gimpslope verify`: solve problems with known answers."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from ..studies import verify
from ..studies.verify import report
from . import checked
from .commands import Commands


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("verify", help="solve problems with known answers")
    parser.set_defaults(prepare=_prepare, full=verify.PROBLEMS.full)
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
    return checked.prepare(options, verify.PROBLEMS, report.text, report.write, "table")
