"""A run file opened for analysis: energy, speed, plastic zone and displacement."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _check
from ._check import FloatArray
from .io import hdf5
from .method import Method
from .scene import Scene
from .stages import Stages

if TYPE_CHECKING:
    import meshio
    from matplotlib.axes import Axes

PLASTIC_THRESHOLD = 0.01
"""Equivalent plastic strain above which a point counts as part of the plastic zone."""

_TIME_TOLERANCE = 0.01
_SOIL = 0
_READABLE = {
    "points": "{:,}",
    "steps": "{:,}",
    "stones": "{:,}",
    "peak_kinetic_energy": "{:,.0f} J/m",
    "time_of_peak": "{:.3f} s",
    "speed_at_peak": "{:.3f} m/s",
    "max_speed": "{:.3f} m/s",
    "final_kinetic_energy": "{:,.3g} J/m",
    "simulated_time": "{:.3f} s",
    "max_displacement_total": "{:.3f} m",
    "max_displacement_horizontal": "{:.3f} m",
    "max_displacement_vertical": "{:.3f} m",
    "toe": "{:.3f} m",
    "wall_seconds": "{:.1f} s",
    "point_steps_per_second": "{:,.0f} /s",
}


def open(path: str | PathLike[str]) -> Run:
    """The run in the file at `path`, whether it has ended, was stopped or is still being written.

    Raises
    ------
    FileNotFoundError, ValueError
        If there is no such file, or it is not a run file of a known format.
    """
    return Run(path)


class Peak(NamedTuple):
    """Where a curve is highest."""

    time: float
    value: float


class MaxDisplacement(NamedTuple):
    """Largest displacements of any point, m; each may be of another point."""

    total: float
    horizontal: float
    vertical: float


@dataclass(frozen=True, eq=False)
class Energy:
    """Energy rows of one stage, one array (k,) a column.

    Attributes
    ----------
    time : s; in the slide from the trigger
    step : steps taken since the clock was last set to zero
    kinetic, potential, elastic : J/m; potential is zero at y = 0
    max_speed : speed of the fastest point, m/s
    """

    path: Path
    time: FloatArray
    step: npt.NDArray[np.int64]
    kinetic: FloatArray
    potential: FloatArray
    elastic: FloatArray
    max_speed: FloatArray

    def __len__(self) -> int:
        return len(self.time)

    @property
    def peak(self) -> Peak:
        """Time (s) and value (J/m) of the largest kinetic energy; of the first if several.

        Raises `ValueError` for a stage without rows.
        """
        row = self._peak_row()
        return Peak(float(self.time[row]), float(self.kinetic[row]))

    @property
    def speed_at_peak(self) -> float:
        """Speed of the fastest point when the kinetic energy is largest, m/s."""
        return float(self.max_speed[self._peak_row()])

    def stage(self, name: str) -> Energy:
        """The rows of another stage: "gravity", "settling" or "slide"."""
        return _energy(self.path, name)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Kinetic energy against time, drawn into `ax` or a new figure."""
        from . import figures

        return figures.kinetic_energy(self, ax)

    def _peak_row(self) -> int:
        if len(self) == 0:
            raise ValueError(f"the stage must have energy rows, got none in {str(self.path)!r}")
        return int(np.argmax(self.kinetic))


@dataclass(frozen=True, eq=False)
class Points:
    """The points at the start of the slide, in the order in which they were given.

    Attributes
    ----------
    position : m, shape (n, 2)
    mass : kg/m, shape (n,)
    volume : area in the plane, m2, shape (n,)
    half_length : half the sides of the point's rectangle, m, shape (n, 2)
    material : index into the scene's materials, 0 being the soil, shape (n,)
    """

    position: FloatArray
    mass: FloatArray
    volume: FloatArray
    half_length: FloatArray
    material: npt.NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.position)


@dataclass(frozen=True, eq=False)
class Snapshot:
    """The points at one time of the slide.

    Attributes
    ----------
    time : since the trigger, s
    position : m, shape (n, 2)
    velocity : m/s, shape (n, 2)
    stress : xx, yy, zz, xy, tension positive, Pa, shape (n, 4)
    plastic_strain : equivalent plastic strain since the trigger, shape (n,)
    volume : area in the plane, m2, shape (n,)
    points : the points at the start of the slide
    """

    time: float
    position: FloatArray
    velocity: FloatArray
    stress: FloatArray
    plastic_strain: FloatArray
    volume: FloatArray
    points: Points

    @property
    def speed(self) -> FloatArray:
        """Magnitude of the velocity, m/s, shape (n,)."""
        speed: FloatArray = np.linalg.norm(self.velocity, axis=1)
        return speed

    @property
    def displacement(self) -> FloatArray:
        """Displacement since the trigger, m, shape (n, 2)."""
        return self.position - self.points.position

    @property
    def density(self) -> FloatArray:
        """Mass over present volume, kg/m3, shape (n,)."""
        density: FloatArray = self.points.mass / self.volume
        return density

    def to_meshio(self) -> meshio.Mesh:
        """The points as vertices with their fields, for any format that meshio writes.

        `run.snapshot(1.6).to_meshio().write("slope.vtu")` makes a file for ParaView. Vectors get a
        third component of zero; stress is xx, yy, zz, xy.
        """
        import meshio

        n = len(self.position)
        deep = {
            name: np.column_stack([getattr(self, name), np.zeros(n)])
            for name in ("position", "velocity", "displacement")
        }
        return meshio.Mesh(
            deep.pop("position"),
            [("vertex", np.arange(n)[:, np.newaxis])],
            point_data={
                **deep,
                "stress": self.stress,
                "plastic_strain": self.plastic_strain,
                "density": self.density,
                "material": self.points.material,
            },
        )


class Run:
    """A run file opened for analysis.

    The file is opened for each reading and closed after it, so that a run can be looked at while it
    is still being written. Points are in the order in which they were given.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        self.path = Path(path)
        hdf5.read_attributes(self.path)

    @property
    def attributes(self) -> dict[str, Any]:
        """The root attributes of the file as they are now, JSON text decoded."""
        return hdf5.read_attributes(self.path)

    @property
    def status(self) -> str:
        """ "running" (also of a killed run), "finished", "interrupted" or "failed"."""
        return str(self.attributes["status"])

    @property
    def status_detail(self) -> str:
        """How the run ended, in words."""
        return str(self.attributes["status_detail"])

    @cached_property
    def scene(self) -> Scene:
        """What was simulated."""
        return Scene.from_dict(self.attributes["scene"])

    @cached_property
    def method(self) -> Method:
        """How it was computed."""
        return Method.from_dict(self.attributes["method"])

    @cached_property
    def stages(self) -> Stages:
        """The loading stages."""
        return Stages.from_dict(self.attributes["stages"])

    @property
    def summary(self) -> dict[str, float | int | None]:
        """The main results, as `summarise` computes them from the data written so far."""
        return summarise(self)

    @property
    def trigger(self) -> dict[str, float]:
        """energy_released (J/m), settling_time (s), settling_ratio; empty before the trigger."""
        return hdf5.read_trigger(self.path)

    @property
    def energy(self) -> Energy:
        """Energy rows of the slide; `energy.stage(name)` gives those of the other stages."""
        return _energy(self.path, "slide")

    @property
    def times(self) -> FloatArray:
        """Times of the snapshots, s, shape (k,)."""
        return hdf5.read_snapshot_times(self.path)

    @property
    def points(self) -> Points:
        """The points at the start of the slide. Raises `ValueError` if none are written yet."""
        arrays = hdf5.read_points(self.path)
        if not arrays:
            raise ValueError(f"the run must have reached the slide, got none in {str(self.path)!r}")
        return Points(**arrays)

    @property
    def final(self) -> Snapshot:
        """The last state: the final one, or the last snapshot of a run that was killed."""
        found = hdf5.read_final(self.path)
        if found is None:
            return self._snapshot(-1)
        time, arrays = found
        return Snapshot(time=time, points=self.points, **arrays)

    def snapshot(self, time: float) -> Snapshot:
        """The snapshot nearest to `time` (s).

        Raises
        ------
        TypeError, ValueError
            If the time is no number, or more than 1 % of the largest interval between snapshots
            before the first or after the last of them.
        """
        times = self.times
        wanted = _check.finite("time", time)
        self._refuse_empty(times)
        tolerance = _TIME_TOLERANCE * np.max(np.diff(times), initial=0.0)
        if not times[0] - tolerance <= wanted <= times[-1] + tolerance:
            raise ValueError(
                f"time must be a number in [{times[0]:.6g}, {times[-1]:.6g}], "
                f"the times of the snapshots, got {time!r}"
            )
        return self._snapshot(int(np.argmin(np.abs(times - wanted))))

    def state(self, time: float | None = None) -> Snapshot:
        """The snapshot nearest to `time` (s), or the last state when it is None."""
        return self.final if time is None else self.snapshot(time)

    def displacement(self, time: float | None = None) -> FloatArray:
        """Displacement (x, y) since the trigger, m, shape (n, 2), at `time` (s) or in the end."""
        return self.state(time).displacement

    def max_displacement(self, time: float | None = None) -> MaxDisplacement:
        """Largest displacement in all, sideways (|u_x|) and up or down (|u_y|), m.

        At `time` (s), or in the end when it is None.
        """
        return _max_displacement(self.state(time))

    def plastic_zone(
        self, time: float | None = None, threshold: float = PLASTIC_THRESHOLD
    ) -> npt.NDArray[np.bool_]:
        """Which points are soil with an equivalent plastic strain above a threshold, shape (n,).

        At `time` (s), or in the end when it is None. The default threshold of 1 % is above the
        elastic strains of the study's soil, about 0.5 %, and far below those in a sliding band.
        """
        state = self.state(time)
        limit = _check.not_negative("threshold", threshold)
        zone: npt.NDArray[np.bool_] = (state.plastic_strain > limit) & (
            state.points.material == _SOIL
        )
        return zone

    def plot_energy(self, ax: Axes | None = None) -> Axes:
        """Kinetic energy of the slide against time."""
        return self.energy.plot(ax)

    def plot_speed(
        self, time: float, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the speed at `time` (s); its colours end at `largest` (m/s) where given."""
        from . import figures

        return figures.speed(self, time, ax, largest=largest)

    def plot_plastic_zone(
        self, time: float, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the equivalent plastic strain at `time` (s)."""
        from . import figures

        return figures.plastic_zone(self, time, ax, largest=largest)

    def plot_displacement(
        self, time: float | None = None, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the displacement since the trigger at `time` (s), or in the end."""
        from . import figures

        return figures.displacement(self, time, ax, largest=largest)

    def __repr__(self) -> str:
        return f"<Run {self.path.name!r}: {self.status}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{name.replace('_', ' ')}</th><td>{value}</td></tr>"
            for name, value in _readable(self.summary).items()
        )
        title = escape(f"{self.path.name}: {self.status}")
        return f"<table><caption>{title}</caption>{rows}</table>"

    def _snapshot(self, number: int) -> Snapshot:
        times = self.times
        self._refuse_empty(times)
        arrays = hdf5.read_snapshot(self.path, number % len(times))
        return Snapshot(time=float(times[number]), points=self.points, **arrays)

    def _refuse_empty(self, times: FloatArray) -> None:
        if len(times) == 0:
            raise ValueError(f"the run must have snapshots, got none in {str(self.path)!r}")


def summarise(run: Run) -> dict[str, float | int | None]:
    """The main results of a run from the data written so far, in SI units.

    Keys: points, steps (of all stages), stones, peak_kinetic_energy (J/m), time_of_peak,
    speed_at_peak (of the fastest point then), max_speed, max_displacement_total, _horizontal and
    _vertical, toe (largest x of a point in the end), final_kinetic_energy (J/m), simulated_time
    (of the slide), wall_seconds (spent stepping) and point_steps_per_second. What the run has not
    reached, or not recorded, is None.
    """
    return {
        "points": len(hdf5.read_points(run.path).get("mass", ())),
        "steps": _steps(hdf5.read_energy(run.path)["step"]),
        "stones": len(run.scene.stones),
        **_energy_summary(run.energy),
        **_displacement_summary(run),
        **_speed_of_computing(run.attributes.get("timing")),
    }


def _energy(path: Path, stage: str) -> Energy:
    number = hdf5.STAGES.index(_check.one_of("stage", stage, hdf5.STAGES))
    columns = hdf5.read_energy(path)
    rows = columns.pop("stage") == number
    return Energy(path, **{name: column[rows] for name, column in columns.items()})


def _max_displacement(state: Snapshot) -> MaxDisplacement:
    moved = state.displacement
    horizontal, vertical = np.abs(moved).max(axis=0)
    return MaxDisplacement(float(np.hypot(*moved.T).max()), float(horizontal), float(vertical))


def _steps(column: npt.NDArray[np.int64]) -> int:
    """All steps taken, given a count that starts again from zero whenever the clock does."""
    ends = np.append(column[:-1][np.diff(column) < 0], column[-1:])
    return int(ends.sum())


def _energy_summary(energy: Energy) -> dict[str, float | None]:
    names = (
        "peak_kinetic_energy",
        "time_of_peak",
        "speed_at_peak",
        "max_speed",
        "final_kinetic_energy",
        "simulated_time",
    )
    if len(energy) == 0:
        return dict.fromkeys(names)
    values = (
        energy.peak.value,
        energy.peak.time,
        energy.speed_at_peak,
        float(energy.max_speed.max()),
        float(energy.kinetic[-1]),
        float(energy.time[-1]),
    )
    return dict(zip(names, values, strict=True))


def _displacement_summary(run: Run) -> dict[str, float | None]:
    names = [f"max_displacement_{name}" for name in MaxDisplacement._fields] + ["toe"]
    if len(run.times) == 0:
        return dict.fromkeys(names)
    state = run.final
    values = (*_max_displacement(state), float(state.position[:, 0].max()))
    return dict(zip(names, values, strict=True))


def _speed_of_computing(timing: dict[str, Any] | None) -> dict[str, float | None]:
    seconds = timing["wall_seconds"] if timing else None
    rate = timing["point_steps"] / seconds if timing and seconds else None
    return {"wall_seconds": seconds, "point_steps_per_second": rate}


def _readable(summary: dict[str, float | int | None]) -> dict[str, str]:
    return {
        name: "not recorded" if value is None else _READABLE[name].format(value)
        for name, value in summary.items()
    }
