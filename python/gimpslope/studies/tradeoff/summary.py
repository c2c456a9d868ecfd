"""One page: what to choose for how small an error, computed from what was measured."""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from importlib.metadata import version

import numpy as np

from ...kernel import instruction_sets
from ..reproduce.tables import table
from . import effects, words
from .measure import Measured
from .pareto import cheapest, held, is_finest
from .plan import Changed, Plan
from .problem import Problem
from .ranking import ByProblem, Choice, choices, of_each

TARGETS = (0.1, 0.02, 0.005)
"""Errors, as parts of what is known."""

_EXPLANATION = (
    "Error against core-seconds (processor time of the steps alone, of slopes also of loading and "
    "output), medians of {rounds} through all cases, with their range. An error counts as reached "
    "where it holds on that grid and on all finer ones that were measured with the same method: "
    "smaller errors on coarse grids are luck. *Finest*: no finer one was measured. The default is "
    "uGIMP, USF, a Courant number C of 0.4, an alpha of 0.01 or the viscosity of the problem, and "
    "volume strains of each point where all is elastic, averaged over cells where a material "
    "yields; methods are named by what they change of it.\n"
)
_EFFECTS = (
    "Error over that of the default on the same grid, geometric means over the grids, and the same "
    "of the cost over all problems. Errors count as no smaller than the answer is known. In "
    "brackets: on how many grids a method fails.\n"
)


def markdown(plan: Plan, measured: Sequence[Measured]) -> str:
    """The page."""
    by_problem = of_each(plan, measured)
    head = (
        f"# Speed against accuracy\n\ngimpslope {version('gimpslope')}, `gimpslope tradeoff`, "
        f"{platform.machine()}, instructions {instruction_sets()[-1]}.\n"
    )
    parts = [head, _EXPLANATION.format(rounds=_rounds(measured))]
    if missing := len(plan.cases) - len(measured):
        parts += [f"Of {len(plan.cases)} cases {missing} are not measured yet.\n"]
    parts += ["![overview](overview.png)\n"]
    for name, some_problems in _groups(by_problem).items():
        parts += [f"## {name}\n", "".join(_overall(some_problems, each) for each in TARGETS)]
    parts += ["## Each choice alone\n", _EFFECTS, _effects(by_problem)]
    for problem, some in by_problem:
        parts += [f"## {problem.title}\n", _of_problem(problem, some)]
    return "\n".join(parts)


def _rounds(measured: Sequence[Measured]) -> str:
    found = {one.rounds for one in measured if not one.failure}
    low, high = min(found, default=0), max(found, default=0)
    return f"{high} rounds" if low == high else f"{low} to {high} rounds"


def _groups(by_problem: ByProblem) -> dict[str, ByProblem]:
    """All problems, and those of each kind unless that is all."""
    yielding = [one for one in by_problem if one[0].yields]
    elastic = [one for one in by_problem if not one[0].yields]
    if not (yielding and elastic):
        return {"Overall": by_problem}
    return {"Overall": by_problem, "Elastic problems": elastic, "Problems that yield": yielding}


def _overall(by_problem: ByProblem, target: float) -> str:
    found, of_all = choices(by_problem, target)
    aim = f"* **{words.percent(target)}**: "
    known = sum(problem.known_to < target for problem, _ in by_problem)
    if known == 0:
        return f"{aim}cannot be told of any of the problems.\n"
    if not found:
        return f"{aim}no case of any problem reaches it.\n"
    best, default = found[0], next(one for one in found if not one.changes)
    told = [_choice(one, of_all) for one in dict.fromkeys((best, default))]
    return f"{aim}{'; '.join(told)}. It can be told of {known} of {len(by_problem)} problems.\n"


def _choice(one: Choice, of_all: int) -> str:
    name, reached = words.changes(dict(one.changes)), of_all - len(one.missed)
    text = f"{name} reaches it in {reached} of the {of_all} problems in which any method does"
    if reached == 0:
        return text
    missed = f" (not: {', '.join(one.missed)})" if one.missed else ""
    return f"{text}{missed}, at {one.slowdown:.2g} times the cost of the cheapest there"


def _effects(by_problem: ByProblem) -> str:
    with_models = [problem for problem, _ in by_problem if len(problem.models) > 1]
    found = effects.choices(problem for problem, _ in by_problem)
    rows = [_effect(words.changes(dict(one)), by_problem, one) for one in found]
    for problem in with_models:
        rows += [_effect(f"{model} stone", by_problem, (), model) for model in problem.models[1:]]
    return table(["", "cost", *(problem.title for problem, _ in by_problem)], rows)


def _effect(
    name: str, by_problem: ByProblem, changes: Changed, model: str | None = None
) -> list[str]:
    found = [
        effects.effect(problem, some, changes, model or problem.models[0])
        for problem, some in by_problem
    ]
    costs = [one.cost for one in found if math.isfinite(one.cost)]
    cost = f"{np.exp(np.mean(np.log(costs))):.2f}" if costs else "-"
    return [name, cost, *map(_ratio, found)]


def _ratio(one: effects.Effect) -> str:
    if one.grids == one.failed:
        return "fails" if one.grids else "-"
    failed = f" ({one.failed} of {one.grids})" if one.failed else ""
    return f"{one.error:.2f}{failed}"


def _of_problem(problem: Problem, some: Sequence[Measured]) -> str:
    lines = [f"{problem.error[0].upper()}{problem.error[1:]}."]
    failed = sum(not math.isfinite(one.error) for one in some)
    lines[0] += f" {len(some)} cases, of which {failed} failed." if failed else ""
    lines += ["", *(f"* {_sentence(problem, some, target)}" for target in TARGETS), ""]
    return "\n".join(lines)


def _sentence(problem: Problem, some: Sequence[Measured], target: float) -> str:
    aim = f"**{words.percent(target)}**: "
    if problem.known_to >= target:
        return f"{aim}cannot be told, for the answer is known to {words.percent(problem.known_to)}."
    errors = held(some)
    best = cheapest(some, target)
    if best is None:
        nearest = min(some, key=lambda one: errors[one])
        return f"{aim}no case reaches it; the nearest is {_told(nearest, errors[nearest], 3)}."
    finest = ", finest" if is_finest(best, some) else ""
    text = aim + _told(best, errors[best]) + finest
    default = cheapest([one for one in some if one.case.is_default], target)
    if default is None:
        return f"{text}; the default does not reach it."
    if default is best:
        return f"{text}, the default."
    ratio = default.core_seconds / best.core_seconds
    return f"{text}; the default needs h = {default.case.cell:.3g} m and {ratio:.2g} times as long."


def _told(one: Measured, error: float, digits: int = 2) -> str:
    time = words.seconds(one.core_seconds)
    spread = "" if one.rounds < 2 else f" ({one.fastest:.2g} to {one.slowest:.2g})"
    return f"{words.case(one.case)}: {words.percent(error, digits)} in {time}{spread}"
