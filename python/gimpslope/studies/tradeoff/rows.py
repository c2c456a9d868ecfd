"""The file of what was measured: a line of JSON a run, so that a sweep that was stopped goes on."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from .plan import Case

NAME = "runs.jsonl"


@dataclass(frozen=True)
class Row:
    """One run.

    Attributes
    ----------
    case : what was run
    round : which of the rounds through all cases it belongs to, from 1
    error : a part of what is known; infinite where the run failed
    core_seconds : processor time of the steps; NaN where the run failed
    failure : why it failed, in words
    """

    case: Case
    round: int
    error: float
    core_seconds: float
    failure: str = ""

    def to_line(self) -> str:
        """As JSON, with a line break."""
        results = {"error": self.error, "core_seconds": self.core_seconds}
        finite = {name: one if math.isfinite(one) else None for name, one in results.items()}
        key = {**_run(self.case), "round": self.round}
        return json.dumps({**key, **finite, "failure": self.failure}) + "\n"


def append(folder: Path, row: Row) -> None:
    """Write a run down at once, on a line of its own."""
    path = folder / NAME
    cut_off = path.exists() and not path.read_bytes().endswith(b"\n")
    with path.open("a") as file:
        file.write("\n" * cut_off + row.to_line())


def read(folder: Path, cases: Sequence[Case]) -> list[Row]:
    """The runs of these cases that are there already, made by this version with these methods."""
    wanted = {_text(_run(case)): case for case in cases}
    rows = []
    for data in _lines(folder / NAME):
        error, seconds = data.pop("error"), data.pop("core_seconds")
        number, failure = data.pop("round"), data.pop("failure")
        if (case := wanted.get(_text(data))) is not None:
            rows.append(Row(case, number, _number(error, math.inf), _number(seconds), failure))
    return rows


def _lines(path: Path) -> Iterator[dict[str, Any]]:
    """A line that was cut off, where a sweep was killed, is left out."""
    if path.exists():
        for line in path.read_text().splitlines():
            if line.endswith("}"):
                yield json.loads(line)


def _run(case: Case) -> dict[str, Any]:
    """All that a run follows from."""
    return {
        "version": version("gimpslope"),
        "problem": case.problem,
        "cell": case.cell,
        "model": case.model,
        "method": case.method.to_dict(),
    }


def _text(data: dict[str, Any]) -> str:
    return json.dumps(data, sort_keys=True)


def _number(value: float | None, otherwise: float = math.nan) -> float:
    return otherwise if value is None else value
