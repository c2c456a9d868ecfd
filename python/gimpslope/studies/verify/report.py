"""What the problems came to, as text, Markdown and JSON."""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

from ...kernel import instruction_sets
from .. import page, plain_data
from ..check import Check
from ..checked import verdict
from . import Solved

_COLUMNS = ("problem", "quantity", "expected", "got", "error", "order", "holds", "time")


def text(solved: Sequence[Solved]) -> str:
    """The table in lines of text, and the number of checks that hold."""
    rows = [_COLUMNS, *(row for one in solved for row in _rows(one))]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_COLUMNS))]
    left = {0, 1, 6}
    lines = [
        "  ".join(
            cell.ljust(width) if column in left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    lines.insert(1, "-" * max(map(len, lines)))
    return "\n".join([*lines, "", verdict(solved)])


def markdown(solved: Sequence[Solved], *, full: bool) -> str:
    """The table with the reason of each tolerance, and the figures where they lie beside it."""
    kind = "full" if full else "quick"
    lines = [
        "# Verification",
        "",
        f"gimpslope {version('gimpslope')}, the {kind} set of `gimpslope verify`. "
        + verdict(solved)
        + f" Times are of one core, {platform.machine()}, instructions {instruction_sets()[-1]}.",
    ]
    for one in solved:
        lines += [
            "",
            f"## {one.case.title}",
            "",
            f"`{one.case.name}`, {one.seconds:.1f} s",
            "",
            "| quantity | expected | got | error | order | holds | reason of the tolerance |",
            "|---|---|---|---|---|---|---|",
        ]
        for check, row in zip(one.result.checks, _rows(one), strict=True):
            lines.append(page.markdown_row([*row[1:7], check.why]))
        lines += ["", f"![{one.case.title}]({one.picture})"]
    return "\n".join(lines) + "\n"


def data(solved: Sequence[Solved], *, full: bool) -> dict[str, Any]:
    """The same as plain data."""
    return {
        "gimpslope_version": version("gimpslope"),
        "set": "full" if full else "quick",
        "problems": [
            {
                "name": one.case.name,
                "title": one.case.title,
                "seconds": one.seconds,
                "holds": one.holds,
                "checks": [_plain(check) for check in one.result.checks],
            }
            for one in solved
        ],
    }


def write(solved: Sequence[Solved], directory: str | PathLike[str], *, full: bool) -> None:
    """Write verification.md and verification.json into a directory."""
    folder = Path(directory)
    (folder / "verification.md").write_text(markdown(solved, full=full))
    (folder / "verification.json").write_text(plain_data.dumps(data(solved, full=full)))


def _rows(one: Solved) -> list[tuple[str, ...]]:
    """A row of text a check; name and time of the problem in the first."""
    first = [(one.case.name, f"{one.seconds:.1f} s")]
    heads = first + [("", "")] * (len(one.result.checks) - 1)
    return [
        (
            name,
            check.quantity,
            _expected(check),
            _number(check.got),
            "" if check.error is None else f"{check.error:+.1e}",
            "" if check.order is None else f"{check.order:.2f}",
            "yes" if check.holds else "NO",
            seconds,
        )
        for (name, seconds), check in zip(heads, one.result.checks, strict=True)
    ]


def _expected(check: Check) -> str:
    if check.bound is not None:
        return f"{check.bound} {_number(check.expected)}"
    below, above = check.expected - check.low, check.high - check.expected
    if math.isclose(below, above):
        return f"{_number(check.expected)} ± {above:.2g}"
    return f"{_number(check.expected)} -{below:.2g} +{above:.2g}"


def _number(value: float) -> str:
    return f"{value:.6g}"


def _plain(check: Check) -> dict[str, Any]:
    return asdict(check) | {"error": check.error, "holds": check.holds}
