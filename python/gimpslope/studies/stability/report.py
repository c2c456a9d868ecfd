"""The atlas as text, Markdown, HTML and JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any, get_args

from ...kernel import shapes
from ...method import Scheme
from .. import page, plain_data
from ..check import Check
from ..checked import verdict
from . import Surveyed
from .mode import Table

_TITLE = "Where methods fail"
_COLUMNS = ("", "quantity", "theory", "measured", "holds", "why there")


def text(surveyed: Sequence[Surveyed]) -> str:
    """All checks in lines of text, and how many hold."""
    lines = []
    for one in surveyed:
        lines += [f"{one.case.name}: {one.case.title}"]
        for kind, quantity, theory, measured, holds, _ in _rows(one):
            lines.append(f"  {kind:6}  {quantity}: {measured} ({theory}){_miss(holds)}")
    return "\n".join([*lines, "", verdict(surveyed)])


def blocks(surveyed: Sequence[Surveyed], *, full: bool) -> list[page.Block]:
    """The page: what holds, then each mode with its mechanism, boundary, advice and figure."""
    command = "gimpslope stability" + ("" if full else " --quick")
    parts: list[page.Block] = [
        page.Heading(_TITLE, level=1),
        page.Paragraph(
            f"gimpslope {version('gimpslope')}, `{command}`. {verdict(surveyed)} A row *fails* "
            "says that what is known to fail does, where theory has it; a row *stands* that "
            "another method does not: the default, unless it says otherwise. This build has the "
            f"shape functions {', '.join(shapes())} and the schemes {', '.join(get_args(Scheme))}."
        ),
    ]
    for one in surveyed:
        parts += _of_mode(one)
    return parts


def data(surveyed: Sequence[Surveyed], *, full: bool) -> dict[str, Any]:
    """The same as plain data."""
    return {
        "gimpslope_version": version("gimpslope"),
        "set": "full" if full else "quick",
        "modes": [
            {
                "name": one.case.name,
                "title": one.case.title,
                "mechanism": one.case.mechanism,
                "source": one.case.source,
                "advice": one.case.advice,
                "seconds": one.seconds,
                "holds": one.holds,
                "fails": [_plain(check) for check in one.result.fails],
                "stands": [_plain(check) for check in one.result.stands],
                "table": None if one.result.table is None else asdict(one.result.table),
            }
            for one in surveyed
        ],
    }


def write(surveyed: Sequence[Surveyed], directory: str | PathLike[str], *, full: bool) -> None:
    """Write atlas.md, atlas.html and atlas.json into a directory."""
    folder, parts = Path(directory), blocks(surveyed, full=full)
    (folder / "atlas.md").write_text(page.markdown(parts))
    (folder / "atlas.html").write_text(page.html(_TITLE, parts))
    (folder / "atlas.json").write_text(plain_data.dumps(data(surveyed, full=full)))


def _of_mode(one: Surveyed) -> list[page.Block]:
    of = one.case
    parts: list[page.Block] = [
        page.Heading(of.title, name=of.name),
        page.Paragraph(f"`{of.name}`, {one.seconds:.1f} s. {of.mechanism}"),
        page.Paragraph(of.source, begins="Source"),
        page.Grid(_COLUMNS, _rows(one)),
    ]
    if one.result.table is not None:
        parts.append(_grid(one.result.table))
    return [
        *parts,
        page.Paragraph(of.advice, begins="What to do"),
        page.Picture(one.picture, of.title),
    ]


def _rows(one: Surveyed) -> list[tuple[str, ...]]:
    kinds = (("fails", one.result.fails), ("stands", one.result.stands))
    return [
        (
            kind,
            check.quantity,
            _expected(check),
            _number(check.got),
            "yes" if check.holds else "NO",
            check.why,
        )
        for kind, checks in kinds
        for check in checks
    ]


def _expected(check: Check) -> str:
    if check.bound is not None:
        return f"{check.bound} {_number(check.expected)}"
    below, above = check.expected - check.low, check.high - check.expected
    if math.isclose(below, above, rel_tol=1e-3):
        return f"{_number(check.expected)} ± {above:.2g}"
    return f"{_number(check.expected)}, in {_number(check.low)} to {_number(check.high)}"


def _grid(table: Table) -> page.Grid:
    rows = [
        [_number(cell) if isinstance(cell, float) else str(cell) for cell in row]
        for row in table.rows
    ]
    return page.Grid(table.columns, rows)


def _number(value: float) -> str:
    return f"{value:.4g}"


def _miss(holds: str) -> str:
    return "" if holds == "yes" else "  DOES NOT HOLD"


def _plain(check: Check) -> dict[str, Any]:
    return asdict(check) | {"holds": check.holds}
