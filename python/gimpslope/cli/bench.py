"""`gimpslope bench`: how fast the kernel is."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path

from ..studies import bench, plain_data
from .commands import Commands
from .paths import check_file, make_directory


def add(commands: Commands) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("bench", help="measure the speed of the kernel on slope A")
    parser.set_defaults(prepare=_prepare)
    parser.add_argument(
        "--points",
        type=int,
        nargs="+",
        metavar="N",
        help=f"(default: {' '.join(map(str, bench.SIZES))})",
    )
    parser.add_argument(
        "--threads", type=int, nargs="+", metavar="N", help="(default: 1 and all processors)"
    )
    parser.add_argument("--json", metavar="FILE", help="write the measurements as JSON")
    parser.add_argument(
        "--output", metavar="DIR", help="for the table and the picture (default: bench)"
    )
    parser.add_argument(
        "--guard",
        action="store_true",
        help="fail if the kernel has become slow against the plain loop, and measure nothing else",
    )


def _prepare(options: argparse.Namespace) -> Callable[[], int]:
    if options.guard:
        return _guard(options)
    plan = bench.Plan(options.points, options.threads)
    check_file("--json", options.json)
    directory = "bench" if options.output is None else options.output
    make_directory("--output", directory)

    def command() -> int:
        results = bench.run(plan, lambda what: print(what, file=sys.stderr, flush=True))
        print(bench.report.text(results))
        if options.json is not None:
            Path(options.json).write_text(plain_data.dumps(results.to_dict()))
        bench.report.write(results, directory)
        print(f"table and picture: {directory}{os.sep}")
        return 0

    return command


def _guard(options: argparse.Namespace) -> Callable[[], int]:
    for name in ("points", "threads", "json", "output"):
        if (given := getattr(options, name)) is not None:
            raise ValueError(f"--{name} must be left out with --guard, got {given!r}")

    def command() -> int:
        ratios = bench.guard.ratios()
        print("\n".join(bench.guard.lines(ratios)))
        failures = bench.guard.failures(ratios)
        for failure in failures:
            print(f"gimpslope: {failure}", file=sys.stderr)
        return 1 if failures else 0

    return command
