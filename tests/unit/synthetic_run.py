"""A run file of points that move by formula, so that every result of its analysis is known.

Stones stay at rest. A point of soil at (x, y) has the velocity s(t) (2 a, -a), a = x / width, with
s(t) = sin(pi t / end), so that the fastest points are those at the right, the kinetic energy is
largest at end / 2 and all is at rest at `end`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from gimpslope.io.hdf5 import RunWriter
from gimpslope.materials import DruckerPrager
from gimpslope.outline import Outline
from gimpslope.run import Run
from gimpslope.scene import Scene
from gimpslope.setup import Setup

END = 4.0
SNAPSHOT_INTERVAL = 0.25
ENERGY_INTERVAL = 0.01
STEP = 1e-3

SOIL = DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
STONE = DruckerPrager(density=2400, young=20e9, poisson=0.2, friction=42, cohesion=900e3)
SCENE = Scene(
    Outline(np.array([(0.0, 0.0), (4.0, 0.0), (1.0, 3.0), (0.0, 3.0)])),
    SOIL,
    stones=[Outline(np.array([(0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0)]))],
    stone=STONE,
    cell=0.2,
)
POINTS = SCENE.points
SHARE = np.where(POINTS.material == 0, POINTS.position[:, 0] / 4.0, 0.0)
DIRECTION = np.array([2.0, -1.0])


def rate(time: npt.ArrayLike) -> Any:
    """The factor s(t) of all velocities."""
    return np.sin(np.pi * np.asarray(time) / END)


def travel(time: npt.ArrayLike) -> Any:
    """The integral of s from 0 to t."""
    return END / np.pi * (1 - np.cos(np.pi * np.asarray(time) / END))


def kinetic(time: npt.ArrayLike) -> Any:
    """Kinetic energy, J/m."""
    return 0.5 * np.sum(POINTS.mass * SHARE**2) * np.sum(DIRECTION**2) * rate(time) ** 2


def displacement(time: float) -> npt.NDArray[np.float64]:
    """Displacement of the points, m, shape (n, 2)."""
    return travel(time) * SHARE[:, np.newaxis] * DIRECTION


def fields(time: float) -> dict[str, npt.NDArray[np.float64]]:
    """Everything a snapshot holds."""
    return {
        "position": POINTS.position + displacement(time),
        "velocity": rate(time) * SHARE[:, np.newaxis] * DIRECTION,
        "stress": np.outer(POINTS.position[:, 1] - 3.0, (6e3, 18e3, 8e3, 0.0)),
        "plastic_strain": 0.5 * travel(time) * SHARE**2,
        "volume": POINTS.volume * (1 + 0.02 * travel(time)),
    }


def energy_rows(stage: int, time: npt.NDArray[np.float64]) -> dict[str, npt.NDArray[Any]]:
    """Rows of a stage; only the slide, stage 2, moves."""
    moving = stage == 2
    return {
        "stage": np.full(len(time), stage),
        "time": time,
        "step": np.rint(time / STEP).astype(int),
        "kinetic": moving * kinetic(time),
        "potential": np.full(len(time), 1e5),
        "elastic": np.full(len(time), 1e3),
        "max_speed": moving * rate(time) * SHARE.max() * np.hypot(*DIRECTION),
    }


def new_writer(path: Path, *, overwrite: bool = False) -> RunWriter:
    """A writer of a run of the synthetic scene, nothing written but its parameters."""
    return RunWriter(
        path,
        setup={name: json.dumps(part) for name, part in Setup(SCENE).to_dict().items()},
        version="0.0.0",
        instruction_set="none",
        threads=1,
        volumetric_strain="cell_average",
        overwrite=overwrite,
    )


def write_points(writer: RunWriter) -> None:
    """The points of the scene."""
    writer.write_points(
        POINTS.position,
        POINTS.mass,
        POINTS.volume,
        POINTS.half_length,
        POINTS.material,
        POINTS.stone,
        ("soil", "stone"),
    )


def write_run(path: Path, *, until: float = END, finished: bool = True) -> Run:
    """A run up to a time; unless it is finished, as a killed run leaves it."""
    writer = new_writer(path)
    writer.append_energy(energy_rows(0, np.arange(0, 0.5, 0.1)))
    writer.append_energy(energy_rows(1, np.arange(0, 0.3, 0.1)))
    writer.write_trigger(
        energy_released=12.5, settling_time=0.2, settling_ratio=1e-7, settling_unbalanced=1e-4
    )
    write_points(writer)
    writer.append_energy(energy_rows(2, np.arange(0, until + 1e-9, ENERGY_INTERVAL)))
    for time in np.arange(0, until + 1e-9, SNAPSHOT_INTERVAL):
        writer.append_snapshot(time, fields(time))
    writer.flush()
    if finished:
        writer.write_final(until, fields(until))
        writer.write_timing(wall_seconds=2.0, processor_seconds=3.0, point_steps=1000)
        writer.finish("finished", "the duration was reached", Run(path).summary)
    return Run(path)
