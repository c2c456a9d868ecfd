"""The runs of a study of convergence: made, measured, compared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..._check import FloatArray
from ...run import Run
from ...simulation import NotSettledError
from ...solver import Diverged
from ..planned import Planned
from ..richardson import Extrapolation
from .limits import Reference, reference
from .plan import NO_STONES, Slope
from .quantities import Measured, measure
from .series import Series

_NOT_YET = "not run yet"

Outcome = Measured | str
"""Of a run: what was measured, or why there is nothing."""


class Errors(NamedTuple):
    """Errors of the means over draws, parts of the limit, shape (grids,), and the limit."""

    values: FloatArray
    against: Reference

    @property
    def known_to(self) -> float:
        """Uncertainty of the limit, a part of it."""
        return abs(self.against.uncertainty / self.against.limit)


@dataclass(frozen=True, eq=False)
class Convergence:
    """A slope in one reading from grid to grid.

    Attributes
    ----------
    reading : of the paper, see `reference.READINGS`
    slope : see `reference.SLOPES`
    cells : m, coarse to fine
    seeds : of the draws of stones
    series : by the model of the stones what was measured
    missing : in words, the runs that are not there, and why
    """

    reading: str
    slope: str
    cells: tuple[float, ...]
    seeds: tuple[int, ...]
    series: Mapping[str, Series]
    missing: tuple[str, ...]

    @property
    def has_stones(self) -> bool:
        """Whether there are any."""
        return NO_STONES not in self.series

    def limits(self, figure: str) -> dict[str, Extrapolation]:
        """Of a figure, by model, of those that have one."""
        found = {model: series.limit(figure) for model, series in self.series.items()}
        return {
            model: limit
            for model, limit in found.items()
            if limit is not None and np.isfinite(limit.limit)
        }

    def errors(self, figure: str, model: str) -> Errors | None:
        """Of a figure, against what `limits.reference` says; None without a limit, or one of 0."""
        against = reference(model, self.limits(figure))
        if against is None or against.limit == 0:
            return None
        means = self.series[model].values(figure).mean(axis=1)
        return Errors(np.abs(means / against.limit - 1), against)


def converge(plan: Sequence[Slope], *, progress: bool = True) -> Iterator[list[Convergence]]:
    """Make the runs that are not there yet, the coarse grids first; after each of them, and once if
    there is none, what is known by then: one study a slope and reading.

    A run that diverges or does not settle is missing, and the others go on. Raises what else
    `simulate` raises.
    """
    outcomes: dict[Path, Outcome] = {}
    waiting: list[tuple[float, Slope, Planned]] = []
    for slope in plan:
        for cell, one in _runs(slope):
            outcomes[one.path] = _NOT_YET if one.found is None else _measure(one.found, slope)
            if one.found is None:
                waiting.append((cell, slope, one))
    for _, slope, one in sorted(waiting, key=lambda item: -item[0]):
        outcomes[one.path] = _attempt(one, slope, progress)
        yield [_convergence(each, outcomes) for each in plan]
    if not waiting:
        yield [_convergence(each, outcomes) for each in plan]


def _runs(slope: Slope) -> Iterator[tuple[float, Planned]]:
    """Each with its cell."""
    for grids in slope.planned.values():
        for cell, draws in zip(slope.cells, grids, strict=True):
            yield from ((cell, one) for one in draws)


def _attempt(one: Planned, slope: Slope, progress: bool) -> Outcome:
    try:
        return _measure(one.run(progress=progress), slope)
    except (Diverged, NotSettledError) as failed:
        return str(failed)


def _measure(run: Run, slope: Slope) -> Measured:
    return measure(run, 2 * slope.cells[0])


def _convergence(slope: Slope, outcomes: Mapping[Path, Outcome]) -> Convergence:
    def there(one: Planned) -> Measured | None:
        found = outcomes[one.path]
        return found if isinstance(found, Measured) else None

    series = {
        model: Series(tuple(tuple(map(there, draws)) for draws in grids))
        for model, grids in slope.planned.items()
    }
    missing = tuple(
        f"{one.path.name}: {found}"
        for _, one in _runs(slope)
        if isinstance(found := outcomes[one.path], str)
    )
    return Convergence(slope.reading, slope.name, slope.cells, slope.seeds, series, missing)
