"""A slope through its stages: gravity grows, the slope settles, it is let go, it slides."""

from __future__ import annotations

import json
import math
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from tqdm import tqdm

from . import _check
from ._check import FloatArray
from .io.hdf5 import FIELDS, STAGES, RunWriter
from .method import Method
from .run import Run, summarise
from .scene import Scene
from .solver import Diverged, Solver
from .stages import Stages

ENERGY_INTERVAL = 0.005  # s
SNAPSHOT_INTERVAL = 0.2  # s
_FLUSH_INTERVAL = 1.0  # s of wall time
_BAR = "{desc} {percentage:3.0f}%|{bar}| {n:.2f} of {total:.2f} s [{elapsed}<{remaining}{postfix}]"
_OPEN_BAR = "{desc} {n:.2f} s, at most {total:.0f} s [{elapsed}{postfix}]"


class NotSettledError(RuntimeError):
    """The slope did not come to rest within the time that its settling stage allows."""


def simulate(
    scene: Scene,
    duration: float | None = None,
    *,
    method: Method | None = None,
    stages: Stages | None = None,
    output: str | PathLike[str] = "run.h5",
    overwrite: bool = False,
    energy_interval: float = ENERGY_INTERVAL,
    snapshot_interval: float = SNAPSHOT_INTERVAL,
    snapshot_times: npt.ArrayLike = (),
    progress: bool = True,
) -> Run:
    """Simulate a slope from its unloaded state until the slide ends, and write the run file.

    Parameters
    ----------
    scene : what is simulated
    duration : of the slide, s; that of the stages where left out
    method : how the motion is computed; `Method()` where left out
    stages : the loading stages; those of the reference study where left out
    output : the run file
    overwrite : replace a file of that name; without it a file that is not empty is refused
    energy_interval : between rows of energy, s, > 0
    snapshot_interval : between snapshots of the slide, s, > 0
    snapshot_times : further times of snapshots, s, >= 0; those after the duration are left out
    progress : show a progress bar

    Raises
    ------
    TypeError, ValueError, FileExistsError
        If a parameter is refused; nothing is written then.
    NotSettledError
        If the slope is not at rest when its settling stage ends.
    Diverged
        If the motion is no longer finite or outruns the grid.

    After any error, Ctrl-C included, the file holds what was computed and says how it ended. A run
    that diverged ends with its last row and snapshot, for the state after them is torn.
    """
    simulation = Simulation(scene, method, stages, duration)
    recorder = Recorder(
        simulation,
        output,
        overwrite=overwrite,
        energy_interval=energy_interval,
        snapshot_interval=snapshot_interval,
        snapshot_times=snapshot_times,
        progress=progress,
    )
    return simulation.run(recorder)


class Simulation:
    """The stages of one slope: load, settle, release, slide. `solver` is the state."""

    def __init__(
        self,
        scene: Scene,
        method: Method | None = None,
        stages: Stages | None = None,
        duration: float | None = None,
    ) -> None:
        self.scene = _check.instance("scene", scene, Scene, "a Scene")
        method = Method() if method is None else method
        stages = Stages() if stages is None else stages
        self.method = _check.instance("method", method, Method, "a Method")
        self.stages = _check.instance("stages", stages, Stages, "Stages")
        if duration is not None:
            self.stages = replace(stages, slide=replace(stages.slide, duration=duration))
        self.solver = Solver.of(scene, self.method, elastic=True)

    def run(self, recorder: Recorder) -> Run:
        """All stages, one after the other, recorded."""
        with recorder:
            self.load(recorder)
            self.settle(recorder)
            self.release(recorder)
            self.slide(recorder)
        return Run(recorder.path)

    def load(self, recorder: Recorder) -> None:
        """Gravity grows linearly; all materials are elastic."""
        ramp = self.stages.gravity.ramp
        self.solver.set_gravity(0.0, -self.scene.gravity, ramp)
        self.solver.set_damping(*self.stages.settling.to_core())
        recorder.start("gravity", ramp)
        while self.solver.time < ramp:
            recorder.advance(min(recorder.next_time(), ramp))

    def settle(self, recorder: Recorder) -> None:
        """Damping brings the slope to rest.

        At rest means that the kinetic energy has stayed below its share of the potential energy for
        as long as a pressure wave needs to cross the scene twice: at a single moment it may be zero
        in full swing. The potential energy is that of the start, above the bottom of the outline.
        """
        settling = self.stages.settling
        start = self.solver.time
        window = self._crossing_time()
        potential = self._first_potential()
        recorder.start("settling", settling.limit)
        calm_since, ratio = start, math.inf
        while self.solver.time - calm_since < window:
            if self.solver.time - start >= settling.limit:
                raise NotSettledError(
                    f"not at rest after settling for limit = {settling.limit} s: kinetic over "
                    f"potential energy, {ratio:.3g} now, has not stayed below ratio = "
                    f"{settling.ratio} for {window:.3g} s, in which a wave crosses the scene twice"
                )
            row = recorder.advance(recorder.next_time())
            ratio = row["kinetic"] / potential
            if ratio > settling.ratio:
                calm_since = self.solver.time
        self.settling_time, self.settling_ratio = self.solver.time - start, ratio

    def release(self, recorder: Recorder) -> None:
        """Strength takes its true value; stresses beyond it return at once; the clock starts."""
        solver = self.solver
        solver.set_damping()
        solver.set_gravity(0.0, -self.scene.gravity)
        solver.reset_clock()
        solver.set_materials(self.scene.materials)
        released = solver.release_stress()
        recorder.release(released, self.settling_time, self.settling_ratio)

    def slide(self, recorder: Recorder) -> None:
        """The slope slides, until its kinetic energy has fallen to `rest_ratio` of its peak."""
        slide = self.stages.slide
        recorder.start("slide", slide.duration)
        peak = 0.0
        while self.solver.time < slide.duration:
            until = min(recorder.next_time(), slide.duration)
            kinetic = recorder.advance(until)["kinetic"]
            peak = max(peak, kinetic)
            if kinetic < slide.rest_ratio * peak:
                recorder.detail = f"at rest after {self.solver.time:.6g} s"
                return
        recorder.detail = f"slid for {self.solver.time:.6g} s"

    def _crossing_time(self) -> float:
        left, bottom, right, top = self.scene.outline.bounds
        slowest = min(material.wave_speed for material in self.scene.materials)
        return 2 * math.hypot(right - left, top - bottom) / slowest

    def _first_potential(self) -> float:
        points = self.scene.points
        heights = points.position[:, 1] - self.scene.outline.bounds[1]
        return float(self.scene.gravity * points.mass @ heights)


class Recorder:
    """Advances a simulation and writes what happens: energy rows, snapshots, progress, the end."""

    def __init__(
        self,
        simulation: Simulation,
        output: str | PathLike[str],
        *,
        overwrite: bool = False,
        energy_interval: float = ENERGY_INTERVAL,
        snapshot_interval: float = SNAPSHOT_INTERVAL,
        snapshot_times: npt.ArrayLike = (),
        progress: bool = True,
    ) -> None:
        self._interval = _check.positive("energy_interval", energy_interval)
        self.path = Path(_check.instance("output", output, str | PathLike, "a path"))
        self.detail = ""
        self._simulation = simulation
        self._solver = simulation.solver
        self._progress = _check.flag("progress", progress)
        self._snapshot_times = _times(
            simulation.stages.slide.duration,
            _check.positive("snapshot_interval", snapshot_interval),
            _check.array("snapshot_times", snapshot_times, ("k",)),
        )
        self._stage = 0
        self._bar: tqdm[Any] | None = None
        self._rows: list[dict[str, float]] = []
        self._rows_end = 0
        self._stage_start = 0.0
        self._intervals = 0
        self._seconds = 0.0
        self._steps = 0
        self._flushed = clock.monotonic()
        self._writer = RunWriter(
            self.path,
            scene_json=json.dumps(simulation.scene.to_dict()),
            method_json=json.dumps(simulation.method.to_dict()),
            stages_json=json.dumps(simulation.stages.to_dict()),
            version=version("gimpslope"),
            instruction_set=self._solver.instruction_set,
            threads=self._solver.threads,
            overwrite=_check.flag("overwrite", overwrite),
        )
        self._write_points()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: Any
    ) -> None:
        if self._bar is not None:
            self._bar.close()
        if kind is None:
            self._finish("finished", self.detail)
        elif issubclass(kind, KeyboardInterrupt):
            where = f"in stage {STAGES[self._stage]} at {self._solver.time:.6g} s"
            self._finish("interrupted", f"stopped by the user {where}")
        else:
            self._finish("failed", f"{kind.__name__}: {error}", sound=kind is not Diverged)

    def start(self, stage: str, duration: float) -> None:
        """Begin the rows and the bar of a stage that lasts at most `duration` seconds."""
        self._stage = STAGES.index(stage)
        if self._bar is not None:
            self._bar.close()
        self._bar = tqdm(
            total=duration,
            desc=f"{stage:8}",
            disable=not self._progress,
            bar_format=_OPEN_BAR if stage == "settling" else _BAR,
        )
        self._stage_start = self._solver.time
        self._intervals = 0
        self._row()
        if stage == "slide":
            self._snapshot_if_due()

    def next_time(self) -> float:
        """When the next row, or snapshot of the slide, is due, s."""
        due = self._next_row()
        if STAGES[self._stage] == "slide" and self._snapshot_times:
            due = min(due, self._snapshot_times[0])
        return due

    def advance(self, until: float) -> dict[str, float]:
        """Step to the time `until` and record what is due; the energies then."""
        steps = self._solver.steps
        with self._timed():
            try:
                self._solver.advance_to(until)
            finally:
                self._steps += self._solver.steps - steps
        row = self._row()
        if STAGES[self._stage] == "slide":
            self._snapshot_if_due()
        if clock.monotonic() - self._flushed > _FLUSH_INTERVAL:
            self._flush()
        self._show()
        return row

    def release(self, energy: float, settling_time: float, settling_ratio: float) -> None:
        """Record the trigger: the points now are the reference of all displacements."""
        self._write_points()
        self._writer.write_trigger(
            energy_released=energy, settling_time=settling_time, settling_ratio=settling_ratio
        )

    def _row(self) -> dict[str, float]:
        energies = self._solver.energies()
        row = {
            "stage": self._stage,
            "time": self._solver.time,
            "step": self._solver.steps,
            **energies._asdict(),
        }
        self._rows.append(row)
        self._rows_end = self._solver.steps
        while self._next_row() <= self._solver.time:
            self._intervals += 1
        return row

    def _next_row(self) -> float:
        """Counted in intervals: times that are summed up drift."""
        return round(self._stage_start + (self._intervals + 1) * self._interval, 12)

    def _snapshot_if_due(self) -> None:
        due = False
        while self._snapshot_times and self._snapshot_times[0] <= self._solver.time:
            self._snapshot_times.pop(0)
            due = True
        if due:
            self._hand_over_rows()
            self._writer.append_snapshot(self._solver.time, self._fields())
            self._flushed = clock.monotonic()

    def _fields(self) -> dict[str, Any]:
        return {name: getattr(self._solver, name) for name in FIELDS}

    def _write_points(self) -> None:
        solver, scene = self._solver, self._simulation.scene
        names = ["soil", "stone"][: len(scene.materials)]
        linear = self._simulation.method.shape == "linear"
        self._writer.write_points(
            solver.position,
            solver.mass,
            solver.volume,
            scene.points.half_length if linear else solver.half_length,
            solver.material,
            names,
        )

    def _hand_over_rows(self) -> None:
        if self._rows:
            rows, self._rows = self._rows, []
            self._writer.append_energy(
                {name: np.array([r[name] for r in rows]) for name in rows[0]}
            )

    def _flush(self) -> None:
        self._hand_over_rows()
        self._writer.flush()
        self._flushed = clock.monotonic()

    def _finish(self, status: str, detail: str, sound: bool = True) -> None:
        """Write the end; of a state that is not sound, torn in the middle of a step, nothing."""
        if sound and self._rows_end != self._solver.steps:
            self._row()
        self._hand_over_rows()
        if sound and STAGES[self._stage] == "slide":
            self._writer.write_final(self._solver.time, self._fields())
        self._writer.write_timing(self._seconds, self._steps * len(self._solver))
        self._writer.finish(status, detail, summarise(Run(self._writer.path)))

    def _show(self) -> None:
        if self._bar is not None and not self._bar.disable:
            rate = self._steps * len(self._solver) / max(self._seconds, 1e-9) / 1e6
            self._bar.set_postfix_str(f"{rate:.1f} M point-steps/s", refresh=False)
            self._bar.update(self._solver.time - self._stage_start - self._bar.n)

    @contextmanager
    def _timed(self) -> Iterator[None]:
        start = clock.perf_counter()
        try:
            yield
        finally:
            self._seconds += clock.perf_counter() - start


def _times(duration: float, interval: float, further: FloatArray) -> list[float]:
    """Times of snapshots within the duration, in order: every interval, further ones, the end."""
    if (further < 0).any():
        raise ValueError(f"snapshot_times must be numbers >= 0, got {further.min()}")
    every = np.concatenate([np.arange(0.0, duration, interval), further, [duration]])
    rounded: list[float] = np.unique(np.round(every[every <= duration], 12)).tolist()
    return rounded
