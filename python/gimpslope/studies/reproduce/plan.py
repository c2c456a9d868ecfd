"""Which runs the study needs, and where their files are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from ... import _check
from ...setup import Setup
from ...solver import Solver
from .. import planned, reference
from ..planned import Planned
from ..richardson import check_cells
from .judging import SLOPES, SOIL

SEEDS = (1,)
CELL = 0.1
REFINED, CELLS = (SOIL, "round"), (0.2, 0.1, 0.05)
"""The slopes whose answer is followed from grid to grid, and the grids, m."""

REFINED_DRAWS = 2


@dataclass(frozen=True)
class Slope:
    """One slope of the study in one reading on one grid, with one run a draw of its stones.

    Attributes
    ----------
    reading : of the paper, see `reference.READINGS`
    name : see `reference.SLOPES`
    cell : m
    seeds : of the draws; one for the slope without stones, which nothing is drawn for
    planned : the run of each
    """

    reading: str
    name: str
    cell: float
    seeds: tuple[int, ...]
    planned: tuple[Planned, ...]


@dataclass(frozen=True)
class Plan:
    """The slopes of the study, and those that are followed from grid to grid, if any."""

    slopes: tuple[Slope, ...]
    refined: tuple[Slope, ...] = ()

    @property
    def runs(self) -> tuple[Planned, ...]:
        """Every run once, the longest first, so that none is left alone at the end."""
        wanted = {
            run.path: (slope, run) for slope in self.slopes + self.refined for run in slope.planned
        }
        first = sorted(wanted.values(), key=lambda one: (one[0].cell, one[0].name == SOIL))
        return tuple(run for _, run in first)


def plan(
    directory: str | PathLike[str],
    *,
    readings: Sequence[str] = tuple(reference.READINGS),
    cell: float = CELL,
    stone_model: str = "deformable",
    stone_modulus: float | None = None,
    stone_friction: float | None = None,
    seeds: Sequence[int] = SEEDS,
    duration: float = 10.0,
    time_step: float | None = None,
    refined: Sequence[str] = (),
    cells: Sequence[float] = CELLS,
    overwrite: bool = False,
) -> Plan:
    """The runs that the study needs, and those that are there already; writes nothing.

    Parameters
    ----------
    directory : for the run files. Finished runs of the same setup and version are taken as they are
    readings : some of `reference.READINGS`
    cell : side of a grid cell, m
    stone_model : one of `reference.STONE_MODELS`
    stone_modulus : Young's modulus of stones that are not rigid, Pa; None: that of the model
    stone_friction : angle of friction of rigid stones along soil, degrees; None: soil sticks
    seeds : of the draws of stones, each another one
    duration : of the slides, s
    time_step : fixed, s; None: a Courant number of 0.4
    refined : slopes to run on several grids too, with the first two seeds (of one, with the next
        one too)
    cells : of these grids, m, each half of the one before, at least three
    overwrite : replace files of those names that hold other runs

    Raises
    ------
    TypeError, ValueError
        If a parameter is refused; the error names the slope that it is refused for.
    FileExistsError
        If a file of those names holds something else and may not be replaced.
    """
    seeds = check_seeds(seeds)

    def slope(reading: str, name: str, side: float, draws: Sequence[int]) -> Slope:
        drawn = tuple(draws) if name != SOIL else (draws[0],)
        runs = []
        for seed in drawn:
            with named(f"slope {name}, cell {side:g} m"):
                setup = reference.setup(
                    name,
                    reading=reading,
                    cell=side,
                    duration=duration,
                    seed=seed,
                    stone_model=stone_model,
                    stone_modulus=stone_modulus,
                    stone_friction=stone_friction,
                    time_step=time_step,
                )
                _check_step(setup)
            grid = "" if side == cell else f"cell_{side:g}"
            file = f"{reading}_{name}.h5" if name == SOIL else f"{reading}_{name}_{seed}.h5"
            runs.append(planned.plan(Path(directory) / grid / file, setup, overwrite=overwrite))
        return Slope(reading, name, side, drawn, tuple(runs))

    return Plan(
        tuple(slope(reading, name, cell, seeds) for reading in readings for name in SLOPES),
        tuple(
            slope(reading, name, side, _few(seeds))
            for reading in readings
            for side in (check_cells(cells) if refined else ())
            for name in SLOPES
            if name in refined
        ),
    )


def check_seeds(seeds: Sequence[int]) -> tuple[int, ...]:
    """Seeds as numbers; raises `TypeError` or `ValueError` unless they are one or more different
    whole numbers >= 0."""
    if not seeds or len(set(seeds)) < len(seeds):
        raise ValueError(f"seeds must be one or more different numbers, got {list(seeds)}")
    return tuple(_check.whole("seed", seed, 0) for seed in seeds)


@contextmanager
def named(slope: str) -> Iterator[None]:
    """Refusals say which slope they are of."""
    try:
        yield
    except (TypeError, ValueError) as refused:
        kind = TypeError if isinstance(refused, TypeError) else ValueError
        raise kind(f"{slope}: {refused}") from refused


def _few(seeds: Sequence[int]) -> Sequence[int]:
    return seeds[:REFINED_DRAWS] if len(seeds) >= REFINED_DRAWS else (seeds[0], seeds[0] + 1)


def _check_step(setup: Setup) -> None:
    """Refuse a time step above the stable limit now, and not in a process after hours."""
    if setup.method.time_step is not None:
        Solver.of(setup.scene, setup.method)
