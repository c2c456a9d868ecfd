"""Problems with known answers: one module each, which reads like the problem statement."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module

from .problem import Check, Outcome, Problem

NAMES = (
    "column",
    "bar",
    "manufactured",
    "vortex",
    "shear",
    "wave",
    "disks",
    "inclusion",
    "cantilever",
    "translation",
    "biaxial",
    "return_mapping",
    "sliding_block",
    "aluminium_bars",
    "column_collapse",
    "footing",
    "pushed_disk",
    "safety_factor",
)
"""All problems: elastic ones first, then plastic and frictional ones."""

__all__ = ["NAMES", "Check", "Outcome", "Problem", "Solved", "problem", "solve"]


@dataclass(frozen=True)
class Solved:
    """A problem, what it came to, and the wall time it took, s."""

    problem: Problem
    outcome: Outcome
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether all of its checks hold."""
        return all(check.holds for check in self.outcome.checks)


def problem(name: str) -> Problem:
    """The problem of that name. Raises `ValueError` for a name not in `NAMES`."""
    if name not in NAMES:
        raise ValueError(f"problem must be one of {', '.join(NAMES)}, got {name!r}")
    found: Problem = import_module(f".{name}", __name__).PROBLEM
    return found


def solve(names: Sequence[str] = NAMES, *, full: bool = False) -> Iterator[Solved]:
    """Solve problems, by name, one after the other; each is given as soon as it is solved.

    Parameters
    ----------
    names : of the problems, each in `NAMES`
    full : with the finest grids and all cases, in minutes; otherwise quickly, in seconds

    Raises
    ------
    ValueError
        If there is no problem of a name; none is solved then.
    """
    chosen = [problem(name) for name in dict.fromkeys(names)]
    return (_solve(one, full) for one in chosen)


def _solve(one: Problem, full: bool) -> Solved:
    start = time.perf_counter()
    outcome = one.run(full)
    return Solved(one, outcome, time.perf_counter() - start)
