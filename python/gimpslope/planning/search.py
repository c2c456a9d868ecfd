"""The search for a grid: pilots on finer and finer ones, until the one that will do is near."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..setup import Setup
from . import grids, stones
from .cost import seconds
from .estimate import Estimate
from .pilot import Pilot, change, fly
from .problem import Problem, passed, past_the_peak
from .quantities import at_peak, need_rest
from .savings import Saved, save
from .tail import Tail, tail
from .target import Target

FULL = 2
"""Pilots whose slides last as long as the stages say."""

ORDER_NEEDS = 3
_TRIES = 3
_ALIKE = 2 / 3
_THIRD_SHARE = 1 / 2
_PILOT_SHARE = 1 / 4
"""Of what is left of the budget, what a further pilot may cost; the run has a use for it too."""


@dataclass(frozen=True)
class Search:
    """What the pilots say.

    Attributes
    ----------
    problem, saved : what is run on all grids
    pilots : coarse to fine
    target : what is asked for
    tail : where slides of finer grids than the first two may end
    lost : wall time on grids that turned out too coarse, s
    """

    problem: Problem
    saved: Saved
    pilots: tuple[Pilot, ...]
    target: Target
    tail: Tail
    lost: float = 0.0

    @property
    def estimates(self) -> tuple[Estimate, ...]:
        """By the pilots."""
        return self.improved(())

    def improved(self, finer: Sequence[Pilot]) -> tuple[Estimate, ...]:
        """By the pilots and runs on the grids after them."""
        values = [
            (pilot.cell, pilot.values if number < FULL else self.tail.extend(pilot.values))
            for number, pilot in enumerate((*self.pilots, *finer))
        ]
        return tuple(
            Estimate(
                name,
                tuple(cell for cell, found in values if name in found),
                tuple(found[name] for _, found in values if name in found),
                self.saved.changes[name] + self.tail.error.get(name, 0.0),
            )
            for name in self.target.quantities
        )

    @property
    def wanted(self) -> tuple[str, ...]:
        """The quantities that finer grids are for: those of the peak alone, where the pilots know
        all others well enough."""
        names = tuple(self.target.quantities)
        if len(self.pilots) < ORDER_NEEDS or self.levels_apart != 0:
            return names
        lacking = tuple(one.name for one in self.estimates if one.error > self.target.error)
        return names if need_rest(lacking) or not lacking else at_peak(names)

    def fly(self, level: int, path: Path, *, overwrite: bool = True) -> Pilot:
        """Run the grid of a level, counted from the coarsest, for what is wanted of it."""
        return fly(self.on(level), path, self.wanted, overwrite=overwrite)

    def on(self, level: int) -> Setup:
        """The setup on a grid, counted from the coarsest; its slide is no longer than is needed."""
        setup = self.problem.on(level, self.saved.setup)
        slide = setup.stages.slide
        if not need_rest(self.wanted):
            slide = past_the_peak(slide)
        elif level >= FULL and self.tail.time < slide.duration:
            slide = replace(slide, duration=self.tail.time)
        return replace(setup, stages=replace(setup.stages, slide=slide))

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
        """How often the cell is to be halved for the error asked for, on three grids at least; None
        if that is not known."""
        wanted = [estimate.levels(self.target.error) for estimate in self.estimates]
        known = [levels for levels in (*wanted, self.levels_apart) if levels is not None]
        if len(known) <= len(wanted):
            return None
        return max(*known, ORDER_NEEDS - len(self.pilots))

    def seconds(self, levels: int) -> float:
        """Predicted wall time of a run whose cell is halved so many times more, s."""
        last = self.pilots[-1]
        end = self.tail.time if need_rest(self.wanted) else passed(last.run.energy)
        points = grids.n_points(self.saved.setup.scene, len(self.pilots) - 1 + levels)
        return seconds(self.pilots, points, levels, min(end / last.reached, 1.0))

    @property
    def spent(self) -> float:
        """Wall time of all runs so far: pilots, what was tried on the coarsest grid and what is
        lost, s."""
        return self.lost + self.saved.seconds + sum(pilot.seconds for pilot in self.pilots[1:])

    @property
    def left(self) -> float:
        """Of the budget, s; negative where more is spent."""
        return self.target.budget - self.spent


def search(
    problem: Problem,
    target: Target,
    directory: Path,
    *,
    progress: bool,
) -> Search:
    """Pilots on grids each half as coarse as the one before: two at least, three if that costs no
    more than half of what is left of the budget, and then as long as the grid that will do is not
    the next one and a pilot costs no more than a quarter of what is left."""
    found = _begin(problem, target, directory)
    told = 0
    while True:
        if progress:
            for pilot in found.pilots[told:]:
                _tell(pilot)
            told = len(found.pilots)
        few = len(found.pilots) < ORDER_NEEDS
        near = not few and found.levels in (0, 1)
        if near or found.seconds(1) > found.left * (_THIRD_SHARE if few else _PILOT_SHARE):
            return found
        level = len(found.pilots)
        pilot = found.fly(level, directory / f"pilot_{level}.h5")
        found = replace(found, pilots=(*found.pilots, pilot))


def _begin(
    problem: Problem, target: Target, directory: Path, tries: int = _TRIES, lost: float = 0.0
) -> Search:
    """The savings on the coarsest grid and the pilot on the next one; with that as the coarsest
    anew, twice at most and if half of what is left allows, where a value is off by more than two
    thirds."""
    saved = save(problem.setup, target, directory)
    path = directory / "pilot_1.h5"
    second = fly(problem.on(1, saved.setup), path, target.quantities)
    end = tail(saved.pilot, second, target.error)
    found = Search(problem, saved, (saved.pilot, second), target, end, lost)
    alike = all(size <= _ALIKE for size in change(saved.pilot, second).values())
    if alike or tries == 1 or found.seconds(1) > _THIRD_SHARE * found.left:
        return found
    return _begin(problem.finer(), target, directory, tries - 1, found.spent)


def _tell(pilot: Pilot) -> None:
    print(
        f"pilot: cell {pilot.cell:g} m, {pilot.points:,} points, {pilot.steps:,} steps, "
        f"{pilot.seconds:.1f} s",
        file=sys.stderr,
        flush=True,
    )
