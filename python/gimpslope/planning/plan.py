"""A plan: on which grid, and how, a slope is to be run for an error asked for; and its answer."""

from __future__ import annotations

import shutil
import tempfile
import time as clock
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from .. import _check
from ..interrupts import uninterrupted
from ..method import Method
from ..run import Run
from ..scene import Scene
from ..setup import Setup
from ..stages import Stages
from . import report
from .estimate import Estimate
from .pilot import Pilot
from .problem import pose
from .quantities import DEFAULT, need_rest
from .search import Search, search
from .target import Target


@dataclass(frozen=True, eq=False)
class Answer:
    """What came of a plan.

    Attributes
    ----------
    run : on the finest grid, which its file holds
    estimates : of each quantity by name, by all grids: value, error, and the raw values beside
    error : asked for
    grids : all runs, from coarse to fine, the pilots first; the files of all but the last go with
        plan and answer
    seconds : wall time of the runs, without the pilots, s
    apart : whether the grids that the estimates are from tell all stones apart
    """

    run: Run
    estimates: Mapping[str, Estimate]
    error: float
    grids: tuple[Pilot, ...]
    seconds: float
    apart: bool
    _plan: Plan = field(repr=False)  # the pilots' files are there as long as it is

    @property
    def reached(self) -> bool:
        """Whether the estimated errors are all below that, by grids that tell all stones apart."""
        return self.apart and all(one.error <= self.error for one in self.estimates.values())

    def __str__(self) -> str:
        return report.answer(self)


@dataclass(frozen=True, eq=False)
class Plan:
    """How a slope is to be run for an error asked for; `print` tells why.

    Attributes
    ----------
    setup : of the run: cell, step, blend, stones and stages
    error : asked for, a share of each quantity
    holds : whether the estimated errors are below it; if not, `reasons` tell what that would need
    levels : how often the cell of the finest pilot is halved, on the way to that of `setup`
    seconds : predicted wall time of `run`, s; 0 where the finest pilot will do
    reasons : what was chosen and why, a sentence each
    """

    setup: Setup
    error: float
    holds: bool
    levels: int
    seconds: float
    reasons: tuple[str, ...]
    _search: Search = field(repr=False)
    _directory: Path = field(repr=False)

    def __post_init__(self) -> None:
        weakref.finalize(self, shutil.rmtree, self._directory, ignore_errors=True)

    @cached_property
    def estimates(self) -> Mapping[str, Estimate]:
        """Each quantity by name, by the pilots; `predicted(plan.levels)` is its error after the
        run, `at_worst(plan.levels)` the same at the least order that is trusted."""
        return MappingProxyType({one.name: one for one in self._search.estimates})

    @property
    def pilot_seconds(self) -> float:
        """Wall time that the pilots took, s."""
        return self._search.spent

    def run(self, output: str | PathLike[str] = "run.h5", *, overwrite: bool = False) -> Answer:
        """Run the slope on the chosen grid and on those between it and the pilots; extrapolate.

        The run file is that of the finest grid; those between go with plan and answer.
        Raises as `simulate` does.
        """
        start, found = clock.perf_counter(), self._search
        if self.levels == 0:
            run, finer = _copied(found.pilots[-1].run, Path(output), overwrite), []
        else:
            last = len(found.pilots) - 1 + self.levels
            chosen = found.fly(last, Path(output), overwrite=overwrite)
            run, finer = chosen.run, [*self._between(), chosen]
        return Answer(
            run,
            MappingProxyType({one.name: one for one in found.improved(finer)}),
            self.error,
            (*found.pilots, *finer),
            clock.perf_counter() - start,
            found.levels_apart is not None and self.levels >= found.levels_apart,
            self,
        )

    def _between(self) -> list[Pilot]:
        """Runs on the grids between the finest pilot and the chosen one."""
        first = len(self._search.pilots)
        return [
            self._search.fly(level, self._directory / f"between_{level}.h5")
            for level in range(first, first + self.levels - 1)
        ]

    def __str__(self) -> str:
        return report.plan(self)


def plan(
    scene: Scene,
    error: float = Target.error,
    quantities: Sequence[str] = DEFAULT,
    *,
    method: Method | None = None,
    stages: Stages | None = None,
    budget: float = Target.budget,
    progress: bool = True,
) -> Plan:
    """Find by pilots on coarse grids the cheapest run that gives some results to an error.

    Each pilot halves the cell of the one before; what they say of the limit, by Richardson's
    extrapolation, tells how fine a grid is needed, and a run on that improves the limit. The limit
    is that of the cell alone: of the same soil, blend as a viscosity, and walls. Where the pilots
    settle no limit, or stones are closer than two cells on all of them, the plan does not hold and
    says what it would need.

    Parameters
    ----------
    scene : what is to be simulated; its cell is where the blend is taken from, and one of the
        grids or finer or coarser than all of them by a power of two
    error : asked for, as a share of each quantity, in (0, 1)
    quantities : names as in a run's summary: "peak_kinetic_energy", "time_of_peak",
        "speed_at_peak", "max_displacement_total", "_horizontal" and "_vertical", and "run_out".
        With those of the peak alone, runs end soon after it
    method : as for `simulate`; the plan chooses the step, and holds a blend as a viscosity
    stages : as for `simulate`; the plan chooses gravity's ramp and may end the slide early
    budget : wall time that pilots and run may take, s, > 0; two pilots are run in any case
    progress : tell of each pilot on standard error

    Raises
    ------
    TypeError, ValueError
        If a parameter is refused, or a quantity is unknown.
    NotSettledError, Diverged
        As `simulate` does, by a pilot.
    """
    target = Target(error, quantities, budget)
    _check.flag("progress", progress)
    problem = pose(
        _check.instance("scene", scene, Scene, "a Scene"),
        target.error,
        Method() if method is None else _check.instance("method", method, Method, "a Method"),
        Stages() if stages is None else _check.instance("stages", stages, Stages, "Stages"),
        until_rest=need_rest(target.quantities),
    )
    directory = Path(tempfile.mkdtemp(prefix="gimpslope_"))
    try:
        found = search(problem, target, directory, progress=progress)
    except BaseException:
        with uninterrupted():
            shutil.rmtree(directory)
        raise
    needed, levels = found.levels, _affordable(found)
    finest = found.pilots[-1]
    return Plan(
        setup=found.on(len(found.pilots) - 1 + levels) if levels else finest.run.setup,
        error=target.error,
        holds=needed is not None and levels >= needed,
        levels=levels,
        seconds=_cost(found, levels),
        reasons=(*problem.reasons, *found.saved.reasons, *report.limits(found, levels)),
        _search=found,
        _directory=directory,
    )


def _affordable(found: Search) -> int:
    """The levels that are needed, or as many as the budget leaves room for; one where it is not
    known how many are needed."""
    wanted = 1 if found.levels is None else found.levels
    return max((n for n in range(wanted + 1) if _cost(found, n) <= found.left), default=0)


def _cost(found: Search, levels: int) -> float:
    """Predicted wall time of the run on a grid and of those before it, s."""
    return sum(found.seconds(n) for n in range(1, levels + 1))


def _copied(run: Run, output: Path, overwrite: bool) -> Run:
    if output.exists() and output.stat().st_size > 0 and not overwrite:
        raise FileExistsError(
            f"output must be a new or empty file unless overwrite is set, got {str(output)!r}"
        )
    shutil.copyfile(run.path, output)
    return Run(output)
