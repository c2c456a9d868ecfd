"""`gimpslope export`: a run for other programs."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from ..io import vtk
from ..run import Run
from .commands import Commands
from .paths import make_empty_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("export", help="write the snapshots of a run for ParaView")
    parser.set_defaults(prepare=_prepare)
    parser.add_argument("run", metavar="RUN", help="a run file (.h5)")
    parser.add_argument(
        "--vtu", required=True, metavar="DIR", help="for one VTU a snapshot and a PVD of all"
    )
    parser.add_argument(
        "--times", type=float, nargs="+", metavar="S", help="s (default: of all snapshots)"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace files of an older export")


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    run = Run(options.run)
    run.snapshots()
    for time in options.times or ():
        run.snapshot(time)
    make_empty_directory("--vtu", options.vtu, overwrite=options.overwrite)

    def command() -> int:
        path = vtk.write_vtu_series(
            run, options.vtu, times=options.times, overwrite=options.overwrite
        )
        print(f"open in ParaView: {path}")
        return 0

    return command
