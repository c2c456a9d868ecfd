"""Recording a simulation: energy rows, snapshots, progress, and how it ended."""

from __future__ import annotations

import json
import time as clock
from collections.abc import Mapping
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from tqdm import tqdm

from . import _check
from .interrupts import uninterrupted
from .io.hdf5 import FIELDS, RIGID_STONES, SNAPSHOT_FIELDS, STAGES, Quantity, RunWriter
from .run import Run
from .solver import Diverged
from .summary import summarise

if TYPE_CHECKING:
    from .simulation import Simulation

_FLUSH_INTERVAL = 1.0  # s of wall time
_MOMENT = 0.05  # s of wall time
_LARGEST_BATCH = 1024  # rows
_BAR = "{desc} {percentage:3.0f}%|{bar}| {n:.2f} of {total:.2f} s [{elapsed}<{remaining}{postfix}]"
_OPEN_BAR = "{desc} {n:.2f} s, at most {total:.0f} s [{elapsed}{postfix}]"


class Recorder:
    """Advances a simulation and writes what happens: energy rows, snapshots, progress, the end."""

    def __init__(
        self,
        simulation: Simulation,
        output: str | PathLike[str],
        *,
        overwrite: bool = False,
        progress: bool = True,
    ) -> None:
        setup = simulation.setup
        method = setup.method.of(setup.scene.materials)
        self.path = Path(_check.instance("output", output, str | PathLike, "a path"))
        self.detail = ""
        self._torn = False  # the state, in the middle of a step
        self._solver = simulation.solver
        self._progress = _check.flag("progress", progress)
        self._setup = setup
        self._snapshot_times = setup.recording.times(setup.stages.slide.duration)
        self._stage = 0
        self._bar: tqdm[Any] | None = None
        self._batch = 1
        self._rows_end = 0
        self._stage_start = 0.0
        self._intervals = 0
        self._seconds = self._processor_seconds = 0.0
        self._steps = 0
        self._flushed = clock.monotonic()
        self._writer = RunWriter(
            self.path,
            setup={name: json.dumps(part) for name, part in setup.to_dict().items()},
            version=version("gimpslope"),
            instruction_set=self._solver.instruction_set,
            threads=self._solver.threads,
            volumetric_strain=method.to_core()["volumetric_strain"],
            ledger=setup.method.ledger,
            rigid_stones=self._solver.rigid_stones.number.tolist(),
            overwrite=_check.flag("overwrite", overwrite),
        )
        self._write_points()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: Any
    ) -> None:
        with uninterrupted():
            try:
                self._end(kind, error)
            finally:
                if self._bar is not None:
                    self._bar.close()

    def _end(self, kind: type[BaseException] | None, error: BaseException | None) -> None:
        try:
            self._keep(self._solver.take_rows())
        finally:
            if kind is None:
                self._finish("finished", self.detail)
            elif issubclass(kind, KeyboardInterrupt):
                where = f"in stage {STAGES[self._stage]} at {self._solver.time:.6g} s"
                self._finish("interrupted", f"stopped by Ctrl-C or SIGTERM {where}")
            else:
                self._finish("failed", f"{kind.__name__}: {error}")

    def start(self, stage: str, duration: float) -> None:
        """Begin the rows and the bar of a stage that lasts at most `duration` seconds."""
        self._stage = STAGES.index(stage)
        if self._bar is not None:
            self._bar.close()
            self._bar = None
        if self._progress and duration > 0:  # an idle bar too takes a lock between processes
            self._bar = tqdm(
                total=duration,
                desc=f"{stage:8}",
                bar_format=_OPEN_BAR if stage == "settling" else _BAR,
            )
        self._stage_start = self._solver.time
        self._intervals = 0
        self._row()
        if stage == "slide":
            self._snapshot_if_due()

    def advance(self, until: float, *, rows: int | None = None) -> dict[str, float]:
        """Step on towards the time `until` and record what is due on the way: at most `rows` rows,
        or where left out as many as fit in a moment of wall time. The last row."""
        steps = self._solver.steps
        start, processor_start = clock.perf_counter(), clock.process_time()
        try:
            self._solver.advance_through(self._due(until, rows or self._batch))
        except Diverged:
            self._torn = True
            raise
        finally:
            with uninterrupted():  # rows that are taken but not kept would be lost
                spent = clock.perf_counter() - start
                self._seconds += spent
                self._processor_seconds += clock.process_time() - processor_start
                self._steps += self._solver.steps - steps
                columns = self._solver.take_rows()
                self._keep(columns)
        if spent < _MOMENT:
            self._batch = min(2 * self._batch, _LARGEST_BATCH)
        elif spent > 4 * _MOMENT:
            self._batch = max(self._batch // 2, 1)
        if STAGES[self._stage] == "slide":
            self._snapshot_if_due()
        if clock.monotonic() - self._flushed > _FLUSH_INTERVAL:
            self._writer.flush_aside()
            self._flushed = clock.monotonic()
        self._show()
        return {name: column[-1] for name, column in columns.items()}

    def release(self, energy: float, **settling: float) -> None:
        """Record the trigger: the points now are the reference of all displacements."""
        self._write_points()
        self._writer.write_trigger(energy_released=energy, **settling)

    def _row(self) -> None:
        """A row of the present state."""
        solver = self._solver
        ledger = solver.ledger._asdict() if self._setup.method.ledger else {}
        row = {"time": solver.time, "step": solver.steps, **solver.energies()._asdict(), **ledger}
        rows = {name: np.array([value]) for name, value in row.items()}
        if len(solver.rigid_stones):
            rows[RIGID_STONES] = solver.rigid_stones.states[np.newaxis]
        self._keep(rows)

    def _keep(self, rows: dict[str, npt.NDArray[Any]]) -> None:
        if len(rows["step"]) == 0:
            return
        self._writer.append_energy({"stage": np.full(len(rows["step"]), self._stage), **rows})
        self._rows_end = rows["step"][-1]
        while self._row_time(self._intervals + 1) <= self._solver.time:
            self._intervals += 1

    def _row_time(self, number: int) -> float:
        return self._setup.recording.row_time(self._stage_start, number)

    def _due(self, until: float, rows: int) -> list[float]:
        """Times of the next rows, the last one `until` or that of a snapshot if such is near."""
        if STAGES[self._stage] == "slide" and self._snapshot_times:
            until = min(until, self._snapshot_times[0])
        first = self._intervals + 1
        times = [self._row_time(interval) for interval in range(first, first + rows)]
        return times if times[-1] < until else [*(time for time in times if time < until), until]

    def _snapshot_if_due(self) -> None:
        due = False
        while self._snapshot_times and self._snapshot_times[0] <= self._solver.time:
            self._snapshot_times.pop(0)
            due = True
        if due:
            self._writer.append_snapshot(self._solver.time, self._fields(SNAPSHOT_FIELDS))

    def _fields(self, quantities: Mapping[str, Quantity]) -> dict[str, Any]:
        return {
            name: self._solver.values(name, single=quantity.dtype == "f4")
            for name, quantity in quantities.items()
        }

    def _write_points(self) -> None:
        solver, scene = self._solver, self._setup.scene
        has_domains = self._setup.method.has_domains
        self._writer.write_points(
            solver.position,
            solver.mass,
            solver.volume,
            solver.half_length if has_domains else scene.points.half_length,
            solver.material,
            scene.points.stone,
            scene.material_names,
        )

    def flush(self) -> None:
        """Write what is kept in memory."""
        self._writer.flush()

    def _finish(self, status: str, detail: str) -> None:
        """Write the end; of a torn state, nothing."""
        if not self._torn and self._solver.steps > self._rows_end:
            self._row()
        if not self._torn and STAGES[self._stage] == "slide":
            self._writer.write_final(self._solver.time, self._fields(FIELDS))
        self._writer.write_timing(
            self._seconds, self._processor_seconds, self._steps * len(self._solver)
        )
        self._writer.finish(status, detail, summarise(Run(self._writer.path)))

    def _show(self) -> None:
        if self._bar is not None:
            rate = self._steps * len(self._solver) / max(self._seconds, 1e-9) / 1e6
            self._bar.set_postfix_str(f"{rate:.1f} M point-steps/s", refresh=False)
            self._bar.update(self._solver.time - self._stage_start - self._bar.n)
