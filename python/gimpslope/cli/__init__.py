"""The command `gimpslope`: run slopes, hold the solver against known answers, measure its speed."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import TextIO

import gimpslope as gs

from ..interrupts import terminable
from ..studies.parallel import RunFailed
from . import bench, converge, export, info, plan, reproduce, run, stability, tradeoff, verify

_COMMANDS = (
    run,
    plan,
    reproduce,
    export,
    verify,
    converge,
    tradeoff,
    stability,
    bench,
    info,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code is 0, 2 for refused arguments, 1 for a failed run or a
    check that does not hold, and 130 for one that was interrupted, by Ctrl-C or SIGTERM."""
    options = _parser().parse_args(arguments)
    try:
        with terminable():
            return _run(options)
    except KeyboardInterrupt:
        print("gimpslope: interrupted", file=sys.stderr)
        return 130


def _run(options: argparse.Namespace) -> int:
    prepare: Callable[[argparse.Namespace], Callable[[], int]] = options.prepare
    try:
        command = prepare(options)
    except (ValueError, TypeError, OSError) as refused:
        print(f"gimpslope: {refused}", file=sys.stderr)
        return 2
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _show
            return command()
    except (gs.Diverged, gs.NotSettledError, RunFailed, OSError) as failed:
        print(f"gimpslope: {failed}", file=sys.stderr)
        return 1


def _show(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """A warning as a line of the command's own, without the place in the code."""
    print(f"gimpslope: {message}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="gimpslope", description=__doc__)
    parser.add_argument("--version", action="version", version=f"gimpslope {gs.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for command in _COMMANDS:
        command.add(commands)
    return parser
