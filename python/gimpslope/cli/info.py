"""`gimpslope info`: what this build can do."""

from __future__ import annotations

import argparse
import os
import platform
from collections.abc import Callable

import gimpslope as gs

from .commands import Commands


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("info", help="show version and instruction sets")
    parser.set_defaults(prepare=_prepare)


def _prepare(_: argparse.Namespace) -> Callable[[], int]:
    def command() -> int:
        print(
            f"gimpslope {gs.__version__}, Python {platform.python_version()}, {platform.machine()}"
        )
        print(f"instruction sets: {', '.join(gs.kernel.instruction_sets())} (the last is used)")
        print(
            f"threads: {'any number' if gs.kernel.has_threads() else 'one, for the build has none'}"
        )
        print(f"processors: {os.cpu_count()}")
        return 0

    return command
