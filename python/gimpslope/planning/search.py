"""The search for a grid: pilots on finer and finer ones, until the one that will do is near."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from . import grids, stones
from .cost import seconds
from .estimate import Estimate
from .pilot import Pilot, fly
from .problem import Problem
from .quantities import need_rest
from .savings import Saved, save
from .tail import Tail, tail
from .target import Target

_PILOT_SHARE = 1 / 8
"""Of the budget, what a pilot may cost: half the cell is eight times the cost."""


@dataclass(frozen=True)
class Search:
    """What the pilots say.

    Attributes
    ----------
    problem, saved : what is run on all grids
    pilots : coarse to fine
    target : what is asked for
    """

    problem: Problem
    saved: Saved
    pilots: tuple[Pilot, ...]
    target: Target

    @property
    def estimates(self) -> tuple[Estimate, ...]:
        """By the pilots."""
        late = self.tail.error
        return tuple(
            Estimate(name, cells, values, self.saved.changes[name], late.get(name, 0.0))
            for name, cells, values in _by_name(
                self.target.quantities, self.pilots, [p.values for p in self.pilots]
            )
        )

    def improved(self, finer: Sequence[Pilot]) -> tuple[Estimate, ...]:
        """By the pilots and runs on the grids after them, whose slides end as the tail says."""
        end, pilots = self.tail, (*self.pilots, *finer)
        values = [pilot.values for pilot in self.pilots] + [end.extend(run.values) for run in finer]
        late = end.error if finer else {}
        return tuple(
            Estimate(name, cells, raw, self.saved.changes[name] + late.get(name, 0.0))
            for name, cells, raw in _by_name(self.target.quantities, pilots, values)
        )

    @property
    def tail(self) -> Tail:
        """Where the slides of finer runs may end."""
        *_, before, last = self.pilots
        if not need_rest(self.target.quantities):
            return Tail(math.inf, {}, {})
        return tail(before, last, self.target.error)

    @property
    def levels_apart(self) -> int | None:
        """How often the cell is to be halved until three grids tell all stones apart; None where
        some touch."""
        cell = stones.cell_apart(self.saved.setup.scene)
        if cell == 0:
            return None
        if math.isinf(cell):
            return 0
        return max(0, math.ceil(math.log2(self.pilots[-1].cell / (cell / 4)) - 1e-9))

    @property
    def levels(self) -> int | None:
        """How often the cell is to be halved for the error asked for; None if that is not known."""
        wanted = [estimate.levels(self.target.error) for estimate in self.estimates]
        known = [levels for levels in (*wanted, self.levels_apart) if levels is not None]
        return max(known) if len(known) == len(wanted) + 1 else None

    def seconds(self, levels: int) -> float:
        """Predicted wall time of a run whose cell is halved so many times more, s."""
        end = min(self.tail.time / self.pilots[-1].reached, 1.0)
        points = grids.n_points(self.saved.setup.scene, len(self.pilots) - 1 + levels)
        return seconds(self.pilots, points, levels, end)

    @property
    def spent(self) -> float:
        """Wall time of the pilots so far, s."""
        return sum(pilot.seconds for pilot in self.pilots)


def _by_name(
    names: Sequence[str], pilots: Sequence[Pilot], values: Sequence[Mapping[str, float]]
) -> Iterator[tuple[str, tuple[float, ...], tuple[float, ...]]]:
    """Name, cells and values of each quantity."""
    cells = tuple(pilot.cell for pilot in pilots)
    return ((name, cells, tuple(one[name] for one in values)) for name in names)


def search(
    problem: Problem,
    target: Target,
    directory: Path,
    *,
    progress: bool,
) -> Search:
    """Pilots on grids each half as coarse as the one before: two at least, three if that costs no
    more than half the budget (s), and then as long as the grid that will do is not the next one and
    a pilot costs no more than an eighth."""
    saved = save(problem.setup, target, directory)
    found = Search(problem, saved, (saved.pilot,), target)
    while True:
        levels = len(found.pilots)
        setup, path = problem.on(levels, saved.setup), directory / f"pilot_{levels}.h5"
        pilot = fly(setup, path, target.quantities)
        found = Search(problem, saved, (*found.pilots, pilot), target)
        if progress:
            _tell(pilot)
        few = len(found.pilots) < 3
        near = not few and found.levels in (0, 1)
        if near or found.seconds(1) > target.budget * (0.5 if few else _PILOT_SHARE):
            return found


def _tell(pilot: Pilot) -> None:
    print(
        f"pilot: cell {pilot.cell:g} m, {pilot.points:,} points, {pilot.steps:,} steps, "
        f"{pilot.seconds:.1f} s",
        file=sys.stderr,
        flush=True,
    )
