"""The command `gimpslope`: run slopes, hold the solver against known answers, measure its speed."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence

import gimpslope as gs

from ..studies.parallel import RunFailed
from . import bench, converge, export, info, reproduce, run, tradeoff, verify

_COMMANDS = (run, reproduce, export, verify, converge, tradeoff, bench, info)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code is 0, 2 for refused arguments, 1 for a failed run or a
    check that does not hold, and 130 for one that was interrupted."""
    options = _parser().parse_args(arguments)
    prepare: Callable[[argparse.Namespace], Callable[[], int]] = options.prepare
    try:
        command = prepare(options)
    except (ValueError, TypeError, OSError) as refused:
        print(f"gimpslope: {refused}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    try:
        return command()
    except (gs.Diverged, gs.NotSettledError, RunFailed, OSError) as failed:
        print(f"gimpslope: {failed}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("gimpslope: interrupted", file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="gimpslope", description=__doc__)
    parser.add_argument("--version", action="version", version=f"gimpslope {gs.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for command in _COMMANDS:
        command.add(commands)
    return parser
