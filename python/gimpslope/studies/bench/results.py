"""All that a plan measures, one after the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from . import machine, output, single, speed, study
from .cases import Case
from .machine import Limits
from .output import OutputCost
from .plan import Plan
from .single import SingleError
from .speed import Measurement
from .study import StudyTime


@dataclass(frozen=True)
class Results:
    """All that was measured.

    Attributes
    ----------
    machine : what each number of threads can do at most
    speeds : of each case
    output : cost of output, and where the time goes, on each number of threads
    single : error of single precision
    study : time of the whole reference study, extrapolated
    """

    machine: list[Limits]
    speeds: list[Measurement]
    output: list[OutputCost]
    single: SingleError
    study: StudyTime

    def to_dict(self) -> dict[str, Any]:
        """The same as plain data."""
        return asdict(self) | {"speeds": [one.to_dict() for one in self.speeds]}


def run(plan: Plan, tell: Callable[[str], None] = lambda _: None) -> Results:
    """Measure what is planned; `tell` hears what comes next."""
    standard = plan.standard
    tell("the machine")
    limits = [machine.measure(threads) for threads in plan.threads]
    speeds: list[Measurement] = []
    for group in plan.groups():
        tell(f"{group[0].points:,} points, {len(group)} cases in turn")
        speeds += speed.measure(group)
    tell(f"{standard.points:,} points, with and without output")
    costs = [output.measure(Case(standard.points, threads)) for threads in plan.threads]
    tell(f"{standard.points:,} points, single against double precision")
    error = single.compare(Case(standard.points, max(plan.threads)))
    rates = {one.case.threads: one.median for one in speeds if _is_standard(one.case, standard)}
    return Results(limits, speeds, costs, error, study.extrapolate(rates))


def _is_standard(case: Case, standard: Case) -> bool:
    return case.points == standard.points and case == case.standard
