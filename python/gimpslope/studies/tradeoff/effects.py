"""What each choice does alone, beside the default on the same grid."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

from .measure import Measured
from .plan import COURANTS, Changed, alone
from .problem import Problem


class Effect(NamedTuple):
    """Error and cost over those of the default: geometric means over the grids, NaN without any.
    Errors count as no smaller than the answer is known. And grids on which it fails, of how many.
    """

    error: float
    cost: float
    failed: int
    grids: int


def choices(problems: Iterable[Problem]) -> list[Changed]:
    """Each choice alone that any of the problems has, steps at last."""
    steps = [{"courant": courant} for courant in COURANTS]
    others = chain.from_iterable(alone(problem)[1:] for problem in problems)
    return list(dict.fromkeys(tuple(changes.items()) for changes in [*others, *steps]))


def effect(
    problem: Problem, some: Sequence[Measured], changes: Changed, model: str | None
) -> Effect:
    """Of changes, and of a model of stones, in one problem."""
    defaults = {one.case.cell: one for one in some if one.case.is_default}
    beside = [
        (one, defaults[one.case.cell])
        for one in some
        if (one.case.changes, one.case.model) == (changes, model) and one.case.cell in defaults
    ]
    both = [pair for pair in beside if all(math.isfinite(one.error) for one in pair)]

    def seen(one: Measured) -> float:
        return max(one.error, problem.known_to)

    return Effect(
        _mean([seen(one) / seen(default) for one, default in both]),
        _mean([one.core_seconds / default.core_seconds for one, default in both]),
        sum(not math.isfinite(one.error) for one, _ in beside),
        len(beside),
    )


def _mean(ratios: Sequence[float]) -> float:
    logs = [math.log(ratio) for ratio in ratios]
    return math.exp(sum(logs) / len(logs)) if logs else math.nan
