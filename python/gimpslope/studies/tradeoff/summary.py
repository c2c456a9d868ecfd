"""One page: what to choose for how small an error, computed from what was measured."""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np

from ...kernel import instruction_sets
from . import words
from .measure import Measured
from .pareto import cheapest, held
from .plan import Plan
from .problem import Problem

TARGETS = (0.1, 0.02, 0.005)
"""Errors, as parts of what is known."""

_EXPLANATION = (
    "Error against core-seconds (processor time of the steps alone, of slopes also of loading and "
    "output), median of {rounds} rounds through all cases. An error counts as reached where it "
    "holds on that grid and on all finer ones that were measured with the same method: smaller "
    "errors on coarse grids are luck. The default is uGIMP, USF, a Courant number C of 0.4, and an "
    "alpha of 0.01 or the viscosity of the problem; methods are named by what they change of it.\n"
)

Changed = tuple[tuple[str, Any], ...]
ByProblem = Sequence[tuple[Problem, Sequence[Measured]]]


class Choice(NamedTuple):
    """A method over all problems: in how many it reaches an error, and the geometric mean of its
    cost over that of the cheapest there."""

    changes: Changed
    reached: int
    slowdown: float


def markdown(plan: Plan, measured: Sequence[Measured]) -> str:
    """The page."""
    by_problem = of_each(plan, measured)
    head = (
        f"# Speed against accuracy\n\ngimpslope {version('gimpslope')}, `gimpslope tradeoff`, "
        f"{platform.machine()}, instructions {instruction_sets()[-1]}.\n"
    )
    parts = [head, _EXPLANATION.format(rounds=plan.rounds), "![overview](overview.png)\n"]
    parts += ["## Overall\n", *(_overall(by_problem, target) for target in TARGETS)]
    for problem, some in by_problem:
        parts += [f"## {problem.title}\n", _of_problem(problem, some)]
    return "\n".join(parts)


def of_each(plan: Plan, measured: Sequence[Measured]) -> ByProblem:
    """The problems, each with its cases."""
    return [
        (problem, [one for one in measured if one.case.problem == problem.name])
        for problem in plan.problems
    ]


def choices(by_problem: ByProblem, target: float) -> tuple[list[Choice], int]:
    """All methods, the best first, and the number of problems in which any reaches the error."""
    costs: dict[Changed, list[float]] = {}
    reached_by_any = 0
    for problem, some in by_problem:
        best = None if problem.known_to > target else cheapest(some, target)
        if best is None:
            continue
        reached_by_any += 1
        for changed in dict.fromkeys(one.case.changes for one in some):
            own = cheapest([one for one in some if one.case.changes == changed], target)
            ratio = [] if own is None else [own.core_seconds / best.core_seconds]
            costs.setdefault(changed, []).extend(ratio)
    found = [
        Choice(changed, len(ratios), float(np.exp(np.mean(np.log(ratios)))) if ratios else math.inf)
        for changed, ratios in costs.items()
    ]
    return sorted(found, key=lambda one: (-one.reached, one.slowdown)), reached_by_any


def _overall(by_problem: ByProblem, target: float) -> str:
    found, of_all = choices(by_problem, target)
    if not found:
        return f"* **{words.percent(target)}**: no case of any problem reaches it.\n"
    best = found[0]
    default = next(one for one in found if not one.changes)
    text = f"* **{words.percent(target)}**: {_choice(best, of_all)}"
    if best is not default:
        text += f"; {_choice(default, of_all)}"
    return f"{text}.\n"


def _choice(one: Choice, of_all: int) -> str:
    name = words.changes(dict(one.changes))
    if one.reached == 0:
        return f"{name} reaches it in none"
    text = f"{name} reaches it in {one.reached} of the {of_all} problems in which any method does"
    return f"{text}, there at {one.slowdown:.2g} times the cost of the cheapest (geometric mean)"


def _of_problem(problem: Problem, some: Sequence[Measured]) -> str:
    lines = [f"{problem.error[0].upper()}{problem.error[1:]}."]
    failed = sum(not math.isfinite(one.error) for one in some)
    lines[0] += f" {len(some)} cases, of which {failed} failed." if failed else ""
    lines += ["", *(f"* {_sentence(problem, some, target)}" for target in TARGETS), ""]
    return "\n".join(lines)


def _sentence(problem: Problem, some: Sequence[Measured], target: float) -> str:
    aim = f"**{words.percent(target)}**: "
    if problem.known_to > target:
        return f"{aim}cannot be told, for the answer is known to {words.percent(problem.known_to)}."
    errors = held(some)
    best = cheapest(some, target)
    if best is None:
        nearest = min(some, key=lambda one: errors[one])
        return f"{aim}no case reaches it; the nearest is {_told(nearest, errors[nearest])}."
    text = aim + _told(best, errors[best])
    default = cheapest([one for one in some if one.case.is_default], target)
    if default is None:
        return f"{text}; the default does not reach it."
    if default is best:
        return f"{text}, the default."
    ratio = default.core_seconds / best.core_seconds
    return f"{text}; the default needs h = {default.case.cell:.3g} m and {ratio:.2g} times as long."


def _told(one: Measured, error: float) -> str:
    time = words.seconds(one.core_seconds)
    spread = "" if one.rounds < 2 else f" ({one.fastest:.2g} to {one.slowest:.2g})"
    return f"{words.case(one.case)}: {words.percent(error)} in {time}{spread}"
