"""What is refused before a run, and how a run may end: in error, stopped, or killed."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from coarse_slope import METHOD, SLOPE, STAGES, recording, simulate

import gimpslope as gs
from gimpslope.io.atomic import _StagedFile
from gimpslope.setup import Setup
from gimpslope.simulation import Simulation
from gimpslope.studies import reference


def test_existing_output_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    path.write_text("precious")
    with pytest.raises(FileExistsError, match="overwrite"):
        simulate(path, duration=0.05)
    assert path.read_text() == "precious"
    assert simulate(path, duration=0.05, overwrite=True).status == "finished"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"duration": -1.0}, r"duration must be .* > 0, got -1"),
        ({"duration": float("nan")}, r"duration must be .* > 0, got nan"),
        ({"energy_interval": 0.0}, r"energy_interval must be .* > 0, got 0"),
        ({"snapshot_interval": float("inf")}, r"snapshot_interval must be .* > 0, got inf"),
        ({"snapshot_times": [-0.5]}, r"snapshot_times must be .* >= 0, got -0\.5"),
        ({"progress": "no"}, r"progress must be True or False, got 'no'"),
        ({"method": gs.Method(time_step=1.0)}, r"time_step must be at most 0\.00\d+ s.*got 1"),
        ({"snapshot_times": 5.0}, "snapshot_times must be"),
        ({"overwrite": "no"}, "overwrite must be"),
        ({"scene": "slope"}, "scene must be"),
        ({"method": "ugimp"}, "method must be"),
        ({"stages": 3}, "stages must be"),
        ({"method": gs.Method(viscosity=1e4)}, "viscosity must be"),
        ({"method": gs.Method(relaxation_time=1e-6)}, "relaxation_time must be"),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_refused_before_anything_is_written(
    options: dict[str, Any], message: str, tmp_path: Path
) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        simulate(tmp_path / "run.h5", **options)
    assert not (tmp_path / "run.h5").exists()


def test_a_time_step_that_was_accepted_stays_accepted(tmp_path: Path) -> None:
    """The settled slope is not quite as dense everywhere: that is no reason to refuse it then."""
    limit = gs.Solver.of(SLOPE).stable_time_step
    method = gs.Method(viscosity=0.5625, time_step=0.9999 * limit)
    assert simulate(tmp_path / "run.h5", method=method, duration=0.1).status == "finished"


def test_fixed_step_is_kept(tmp_path: Path) -> None:
    run = simulate(tmp_path / "run.h5", method=gs.Method(time_step=2e-3), duration=0.1)
    np.testing.assert_allclose(run.energy.time, 2e-3 * run.energy.step, rtol=1e-9)
    assert 0.1 * (1 - 1e-9) <= run.final.time < 0.1 + 2e-3


def test_diverging_run_says_where_and_why(tmp_path: Path) -> None:
    limit = gs.Solver.of(SLOPE).stable_time_step
    method = gs.Method(time_step=8 * limit, allow_unstable=True)
    with pytest.raises(gs.Diverged) as caught:
        simulate(tmp_path / "run.h5", method=method)
    error, message = caught.value, str(caught.value)
    assert 0 <= error.point < SLOPE.n_points and error.step > 0
    assert error.time == pytest.approx(8 * limit * (error.step - 1))
    assert f"step {error.step} from t = " in message and f"point {error.point} at" in message
    assert "likely cause: the time step of" in message and "above the stable limit" in message
    run = gs.open(tmp_path / "run.h5")
    assert run.status == "failed" and run.status_detail == f"Diverged: {message}"
    rows = run.energy.stage("gravity")
    assert len(rows) > 0 and error.time - rows.time[-1] <= max(0.005, 8 * limit)


def slide_with_a_thrown_point(path: Path, raised: type[BaseException]) -> gs.Run:
    # A Courant number would follow the speed: the step is fixed.
    simulation = Simulation(Setup(SLOPE, reference.method(time_step=2e-3), STAGES))
    with pytest.raises(raised), recording(simulation, path) as recorder:
        simulation.load(recorder)
        simulation.settle(recorder)
        simulation.release(recorder)
        velocity = simulation.solver.velocity
        velocity[7] = (0.0, 1e9)
        simulation.solver.velocity = velocity
        simulation.slide(recorder)
    return gs.open(path)


def test_diverging_slide_keeps_its_last_state(tmp_path: Path) -> None:
    run = slide_with_a_thrown_point(tmp_path / "run.h5", gs.Diverged)
    assert run.status == "failed" and run.trigger
    assert len(run.final.position) == SLOPE.n_points
    assert len(run.energy) == 1 and run.times.tolist() == [0.0]


@pytest.mark.parametrize("taken", [True, False])
def test_no_row_is_lost_on_its_way_to_the_file(
    taken: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C the moment the kernel has handed its rows over, or the moment before."""
    take, moments = gs.Solver.take_rows, iter(range(100))

    def interrupted(solver: gs.Solver) -> dict[str, Any]:
        now = next(moments) == 3
        if now and not taken:
            raise KeyboardInterrupt
        rows = take(solver)
        if now:
            assert len(rows["time"]) > 0
            signal.raise_signal(signal.SIGINT)
        return rows

    monkeypatch.setattr(gs.Solver, "take_rows", interrupted)
    with pytest.raises(KeyboardInterrupt):
        simulate(tmp_path / "run.h5")
    run = gs.open(tmp_path / "run.h5")
    rows = run.energy.stage("gravity")
    assert run.status == "interrupted" and len(rows) > 4
    check_rows_without_gap(run)


def test_a_torn_state_is_not_written_whatever_ends_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C while the error of a step is on its way."""
    advance, take = gs.Solver.advance_through, gs.Solver.take_rows
    diverged = []

    def noted(solver: gs.Solver, times: Any) -> None:
        try:
            advance(solver, times)
        except gs.Diverged as error:
            diverged.append(error)
            raise

    def interrupted(solver: gs.Solver) -> dict[str, Any]:
        if diverged:
            signal.raise_signal(signal.SIGINT)
        return take(solver)

    monkeypatch.setattr(gs.Solver, "advance_through", noted)
    monkeypatch.setattr(gs.Solver, "take_rows", interrupted)
    run = slide_with_a_thrown_point(tmp_path / "run.h5", KeyboardInterrupt)
    assert run.status == "interrupted" and len(run.energy) == 1 and len(diverged) == 1
    assert np.isfinite(run.energy.kinetic).all() and run.final.time == 0.0


def test_ctrl_c_within_hdf5_is_a_ctrl_c(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """HDF5 asks the file object for its methods, and takes one that raises for one that lacks."""
    flush, calls = _StagedFile.flush, iter(range(100))

    def interrupted(file: _StagedFile) -> None:
        if next(calls) == 0:
            signal.raise_signal(signal.SIGINT)
        flush(file)

    monkeypatch.setattr(_StagedFile, "flush", interrupted)
    with pytest.raises(KeyboardInterrupt):
        simulate(tmp_path / "run.h5")
    assert gs.open(tmp_path / "run.h5").status == "running" and next(calls) > 0


def test_a_run_after_one_that_diverged_is_written_whole(tmp_path: Path) -> None:
    limit = gs.Solver.of(SLOPE).stable_time_step
    method = gs.Method(time_step=8 * limit, allow_unstable=True)
    try:
        simulate(tmp_path / "torn.h5", method=method)
    except gs.Diverged:
        with (
            pytest.raises(RuntimeError, match="enough"),
            recording(Simulation(Setup(SLOPE, METHOD, STAGES)), tmp_path / "run.h5") as recorder,
        ):
            recorder.start("slide", 1.0)
            recorder.advance(0.0123, rows=3)
            raise RuntimeError("enough") from None
    run = gs.open(tmp_path / "run.h5")
    assert run.status == "failed" and run.final.time == pytest.approx(0.0123)


SLOW = """
cell = 0.2
[outline]
height = 9
[materials.soil]
density = 1800
young = 30e6
poisson = 0.33
friction = 22
cohesion = 1e3
[stages.gravity]
ramp = 1000
"""


@contextmanager
def command(path: Path) -> Iterator[subprocess.Popen[bytes]]:
    """A run by the command line that would last for minutes."""
    words = ["run", "soil", "--cell", "0.2", "--duration", "1000"]
    if path.stem == "gravity":
        scene = path.with_suffix(".toml")
        scene.write_text(SLOW)
        words = ["run", str(scene)]
    words += ["--output", str(path), "--quiet"]
    process = subprocess.Popen(
        [sys.executable, "-m", "gimpslope.cli", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=path.parent,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def wait_for(path: Path, group: str, process: subprocess.Popen[bytes]) -> None:
    """Wait until the running process has written that to its run file."""
    deadline = time.monotonic() + 25
    while process.poll() is None and time.monotonic() < deadline:
        if path.exists() and path.stat().st_size > 0:
            with h5py.File(path, "r", locking=False) as file:
                if group in file and (group != "snapshots" or len(file["snapshots/time"]) > 2):
                    return
        time.sleep(0.02)
    raise AssertionError(f"{group} was not written; exit code {process.poll()}")


def check_rows_without_gap(run: gs.Run) -> None:
    for stage in ("gravity", "settling", "slide"):
        steps = np.diff(run.energy.stage(stage).time)
        assert ((steps > 0) & (steps < 0.005 * (1 + 1e-9))).all()


def test_interrupted_slide_leaves_all_that_was_computed(tmp_path: Path) -> None:
    path = tmp_path / "slide.h5"
    with command(path) as process:
        wait_for(path, "snapshots", process)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, errors = process.communicate(timeout=10)
        assert time.monotonic() - start < 2.0
    assert process.returncode == 130
    assert b"interrupted" in errors and b"Traceback" not in errors
    run = gs.open(path)
    assert run.status == "interrupted"
    assert run.status_detail.startswith("stopped by Ctrl-C or SIGTERM in stage slide at ")
    check_rows_without_gap(run)
    with h5py.File(path, "r") as file:
        final = file["final"].attrs["time"]
    assert final == run.final.time
    assert run.times[-1] <= run.energy.time[-1] <= run.final.time
    assert run.final.time <= run.energy.time[-1] + 0.005 * (1 + 1e-9)
    assert run.summary["simulated_time"] == run.energy.time[-1]
    assert run.summary["point_steps_per_second"] > 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_while_gravity_grows(tmp_path: Path, number: signal.Signals) -> None:
    path = tmp_path / "gravity.h5"
    with command(path) as process:
        wait_for(path, "points", process)
        time.sleep(0.3)
        process.send_signal(number)
        start = time.monotonic()
        _, errors = process.communicate(timeout=10)
        assert time.monotonic() - start < 2.0
    assert process.returncode == 130 and b"Traceback" not in errors
    run = gs.open(path)
    assert run.status == "interrupted"
    assert len(run.energy.stage("gravity")) > 1 and len(run.energy) == 0
    check_rows_without_gap(run)


def test_killed_run_is_readable(tmp_path: Path) -> None:
    path = tmp_path / "slide.h5"
    with command(path) as process:
        wait_for(path, "snapshots", process)
        process.kill()
        process.communicate(timeout=10)
    run = gs.open(path)
    assert run.status == "running"
    assert len(run.times) > 2 and run.final.time == run.times[-1]
    assert run.energy.time[-1] >= run.times[-1]
    assert run.summary["max_displacement_total"] > 0
    check_rows_without_gap(run)
