"""Which runs a study of convergence needs, and where their files are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from ... import _check
from ...method import VolumetricStrain
from ...recording import Recording
from .. import planned, reference
from ..planned import Planned
from ..reproduce.judging import SOIL
from ..reproduce.plan import SEEDS, check_seeds, named
from ..richardson import check_cells

CELLS = (0.4, 0.2, 0.1, 0.05)
CELLS_WITH_STONES = CELLS[1:]
"""The grids, m; in cells of 0.4 m some stones would be without a point."""

DURATION = 10.0  # s
NO_STONES = "no stones"
"""In place of the model of stones, where there are none."""


@dataclass(frozen=True)
class Slope:
    """One slope in one reading.

    Attributes
    ----------
    reading : of the paper, see `reference.READINGS`
    name : see `reference.SLOPES`
    cells : m, coarse to fine
    stone_frictions : for each a further model, rigid stones that soil slides along with that angle
        of friction, degrees
    volumetric_strains : of `Method`; each model with each of them
    seeds : of the draws; one for the slope without stones, which nothing is drawn for
    planned : by the model the runs on each grid, one a draw
    """

    reading: str
    name: str
    cells: tuple[float, ...]
    seeds: tuple[int, ...]
    planned: Mapping[str, tuple[tuple[Planned, ...], ...]]


def plan(
    directory: str | PathLike[str],
    *,
    slopes: Sequence[str] = (SOIL,),
    readings: Sequence[str] = tuple(reference.READINGS),
    stone_models: Sequence[str] = ("deformable",),
    stone_frictions: Sequence[float] = (),
    volumetric_strains: Sequence[VolumetricStrain] = (reference.VOLUMETRIC_STRAIN,),
    seeds: Sequence[int] = SEEDS,
    cells: Sequence[float] | None = None,
    duration: float = DURATION,
    threads: int = 1,
    overwrite: bool = False,
) -> list[Slope]:
    """The slopes with the runs that they need, and those that are there already; writes nothing.

    Parameters
    ----------
    directory : for the run files. A finished run of the same scene, method, duration and version
        that is there already is taken as it is
    slopes : some of `reference.SLOPES`
    readings : some of `reference.READINGS`
    stone_models : some of `reference.STONE_MODELS`, for slopes with stones
    seeds : of the draws of stones, each another one; a draw has the same stones on each grid
    cells : m, each half of the one before, at least three; None: `CELLS`, for slopes with stones
        `CELLS_WITH_STONES`
    duration : of the slide, s
    threads : of the solver
    overwrite : replace files of those names that hold other runs

    Raises
    ------
    TypeError, ValueError
        If a parameter is refused, or there are too few cells, or one is not half of the one before;
        the error names the slope that it is refused for.
    FileExistsError
        If a file of those names holds something else and may not be replaced.
    """
    duration = _check.positive("duration", duration)
    seeds = check_seeds(seeds)

    def run(reading: str, name: str, model: _Model, cell: float, seed: int) -> Planned:
        drawn: dict[str, Any] = {} if name == SOIL else {"seed": seed}
        with named(f"slope {name}, cell {cell:g} m"):
            setup = reference.setup(
                name,
                reading=reading,
                cell=cell,
                duration=duration,
                threads=threads,
                **drawn,
                **model.options,
            )
        setup = replace(setup, recording=Recording(snapshot_interval=duration))
        parts = [name, reading, *model.parts, *map(str, drawn.values()), f"{cell:g}"]
        return planned.plan(Path(directory) / ("_".join(parts) + ".h5"), setup, overwrite=overwrite)

    def slope(reading: str, name: str) -> Slope:
        soil = name == SOIL
        grids = check_cells(cells or (CELLS if soil else CELLS_WITH_STONES))
        drawn = seeds[:1] if soil else seeds
        stones = [_Model(NO_STONES)] if soil else _of_stones(stone_models, stone_frictions)
        runs = {
            model.label: tuple(
                tuple(run(reading, name, model, cell, seed) for seed in drawn) for cell in grids
            )
            for model in _with_strains(stones, volumetric_strains)
        }
        return Slope(reading, name, grids, drawn, runs)

    return [slope(reading, name) for name in slopes for reading in readings]


class _Model(NamedTuple):
    """What a slope is computed with: in words, in parts of a file's name, as options of
    `reference.setup`."""

    label: str
    parts: tuple[str, ...] = ()
    options: Mapping[str, Any] = MappingProxyType({})


def _of_stones(names: Sequence[str], frictions: Sequence[float]) -> list[_Model]:
    return [_Model(name, (name,), {"stone_model": name}) for name in names] + [
        _Model(
            f"rigid, friction {angle:g}°",
            (f"rigid-{angle:g}",),
            {"stone_model": "rigid", "stone_friction": angle},
        )
        for angle in frictions
    ]


def _with_strains(models: Sequence[_Model], strains: Sequence[VolumetricStrain]) -> list[_Model]:
    """Each model with each way to take volume strains; the paper's goes unsaid."""
    return [
        model
        if strain == reference.VOLUMETRIC_STRAIN
        else _Model(
            f"{model.label}, {strain.replace('_', ' ')}",
            (*model.parts, strain.replace("_", "-")),
            {**model.options, "volumetric_strain": strain},
        )
        for model in models
        for strain in strains
    ]
