"""The sweep: round after round through all cases, so that whatever else the machine does falls on
all of them alike; each run is written down as soon as it is made."""

from __future__ import annotations

import math
import multiprocessing
import warnings
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...interrupts import uninterrupted
from ...method_warning import MethodWarning
from ...simulation import NotSettledError
from ...solver import Diverged
from .. import processes
from . import rows
from .plan import Case, Plan
from .problems import PROBLEMS
from .rows import Row


class Task(NamedTuple):
    """A case in one of the rounds, from 1."""

    case: Case
    round: int


@dataclass(frozen=True)
class Measured:
    """A case over all rounds.

    Attributes
    ----------
    case : what was run
    error : a part of what is known; infinite where the run failed
    core_seconds, fastest, slowest : median and range over the rounds; NaN where the run failed
    rounds : how many
    failure : why it failed, in words
    """

    case: Case
    error: float
    core_seconds: float
    fastest: float
    slowest: float
    rounds: int
    failure: str


def sweep(plan: Plan, folder: Path, *, jobs: int = 1) -> Iterator[Row]:
    """Make the runs that are not there yet, at most `jobs` at a time, and write each to the folder.

    A run that fails is not repeated. Ctrl-C or SIGTERM ends a sweep of one job at once, one of more
    when the runs that are going have ended, which are kept. A script that calls this with more than
    one job needs `if __name__ == "__main__":`, for the processes import it.
    """
    for number in range(1, plan.rounds + 1):
        for row in _run_all(_waiting(plan, folder, number), jobs):
            rows.append(folder, row)
            yield row


def missing(plan: Plan, folder: Path) -> int:
    """Runs that are not there yet, at most: those that fail are not repeated."""
    return sum(len(_waiting(plan, folder, number)) for number in range(1, plan.rounds + 1))


def measured(plan: Plan, folder: Path) -> list[Measured]:
    """What is there of each case, in the order of the plan."""
    by_case: dict[Case, list[Row]] = defaultdict(list)
    for row in rows.read(folder, plan.cases):
        by_case[row.case].append(row)
    return [_over_rounds(case, by_case[case]) for case in plan.cases if case in by_case]


def _waiting(plan: Plan, folder: Path, number: int) -> list[Task]:
    there = rows.read(folder, plan.cases)
    done = {row.case for row in there if row.round == number or row.failure}
    return [Task(case, number) for case in plan.cases if case not in done]


def _over_rounds(case: Case, some: list[Row]) -> Measured:
    seconds = [row.core_seconds for row in some]
    low, median, high = np.quantile(seconds, (0, 0.5, 1)).tolist()
    return Measured(case, some[0].error, median, low, high, len(some), some[0].failure)


def _run_all(tasks: Sequence[Task], jobs: int) -> Iterator[Row]:
    if jobs == 1 or len(tasks) < 2:
        yield from map(run, tasks)
        return
    # Ctrl-C waits for the runs that are going, on purpose: they may be minutes of work, and what is
    # measured of them is all that they leave.
    queue, going = list(tasks), set[Future[Row]]()
    spawn = multiprocessing.get_context("spawn")
    with uninterrupted() as came, ProcessPoolExecutor(jobs, spawn) as pool:
        while going or (queue and not came):
            while queue and len(going) < jobs and not came:
                with processes.signals_blocked():
                    going.add(pool.submit(run, queue.pop(0)))
            done, going = wait(going, return_when=FIRST_COMPLETED)
            yield from (one.result() for one in done)


def run(task: Task) -> Row:
    """One run; a motion that fails has an infinite error."""
    case, number = task
    try:
        with warnings.catch_warnings():  # it goes where they warn of on purpose
            warnings.simplefilter("ignore", MethodWarning)
            solution = PROBLEMS[case.problem].solve(case.cell, case.method, case.model)
    except (Diverged, NotSettledError) as failed:
        return Row(case, number, math.inf, math.nan, str(failed))
    if not math.isfinite(solution.error):
        return Row(case, number, math.inf, math.nan, "what is measured is not finite")
    return Row(case, number, *solution)
