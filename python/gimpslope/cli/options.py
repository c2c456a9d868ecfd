"""Options that several commands have."""

from __future__ import annotations

import argparse

from ..studies import reference


def add_readings(parser: argparse.ArgumentParser) -> None:
    """`--reading`, one or more of the readings of the paper."""
    parser.add_argument(
        "--reading",
        nargs="+",
        choices=list(reference.READINGS),
        default=list(reference.READINGS),
        help="(default: both)",
    )
