"""Methods held against each other over all problems."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .measure import Measured
from .pareto import cheapest
from .plan import Changed, Plan
from .problem import Problem

ByProblem = Sequence[tuple[Problem, Sequence[Measured]]]
"""The problems, each with its cases."""


class Choice(NamedTuple):
    """A method over all problems: those in which it does not reach an error that another does, by
    title, and the geometric mean of its cost over that of the cheapest in the others."""

    changes: Changed
    missed: tuple[str, ...]
    slowdown: float


def of_each(plan: Plan, measured: Sequence[Measured]) -> ByProblem:
    """The problems, each with its cases."""
    return [
        (problem, [one for one in measured if one.case.problem == problem.name])
        for problem in plan.problems
    ]


def choices(by_problem: ByProblem, target: float) -> tuple[list[Choice], int]:
    """All methods, the best first, and the number of problems in which any reaches the error."""
    costs: dict[Changed, dict[str, float]] = {}
    reached_by_any = []
    for problem, some in by_problem:
        best = None if problem.known_to >= target else cheapest(some, target)
        if best is None:
            continue
        reached_by_any.append(problem.title)
        for changes in dict.fromkeys(one.case.changes for one in some):
            ratios = costs.setdefault(changes, {})
            own = cheapest([one for one in some if one.case.changes == changes], target)
            if own is not None:
                ratios[problem.title] = own.core_seconds / best.core_seconds
    found = [
        Choice(
            changes,
            tuple(title for title in reached_by_any if title not in ratios),
            float(np.exp(np.mean(np.log([*ratios.values()])))) if ratios else math.inf,
        )
        for changes, ratios in costs.items()
    ]
    order = sorted(found, key=lambda one: (len(one.missed), one.slowdown))
    return order, len(reached_by_any)
