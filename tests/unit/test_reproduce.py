"""The whole study: it runs the slopes, keeps what is finished, and writes it down."""

from __future__ import annotations

import json
import os
import platform
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gimpslope as gs
from gimpslope import cli
from gimpslope.io import atomic, hdf5
from gimpslope.studies import parallel, planned, processes, reference, reproduce

SMALL = [
    *("reproduce", "--cell", "0.2", "--stone-modulus", "3e7", "--duration", "0.6"),
    *("--reading", "identified", "--quiet"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of short slides with soft stones."""
    made = tmp_path_factory.mktemp("study") / "small"
    assert cli.main([*SMALL, "--jobs", "2", "--output", str(made)]) == 0
    return made


def test_runs_are_those_of_the_slopes(folder: Path) -> None:
    names = {"soil": "soil", **{name: f"{name}_1" for name in ("arbitrary", "round", "oval")}}
    for slope, file in names.items():
        run = gs.open(folder / f"identified_{file}.h5")
        assert run.status == "finished"
        setup = reference.setup(slope, cell=0.2, stone_modulus=3e7, duration=0.6)
        assert run.setup == setup


def test_figures_and_page(folder: Path) -> None:
    for number in range(3, 9):
        assert (folder / "identified" / f"figure_{number}.png").stat().st_size > 10_000
    page = (folder / "summary.md").read_text()
    for word in ("9.3", "8.7", "seeds of the stones | 1", "3e+07 Pa", "0.2 m", gs.__version__):
        assert word in page
    for library in (f"Python {platform.python_version()}", f"NumPy {np.__version__}", "h5py 3"):
        assert library in page
    first = page.partition("## Claims of the paper\n\n")[2].splitlines()[0]
    assert first.startswith("Of 24 claims, by verdict: `identified`: not reached ")
    counted = [int(word) for word in first.replace(",", " ").rstrip(".").split() if word.isdigit()]
    assert sum(counted) == 2 * 24
    assert "not reached" in page and "figure_8.png" in page
    assert page.count("| kinetic energy |") == 6
    html = (folder / "summary.html").read_text()
    assert html.count("<table>") == 3 and html.count("<img") == 6
    measured = json.loads((folder / "figures.json").read_text())["identified"]
    run = gs.open(folder / "identified_round_1.h5")
    assert measured["identified_round_1"]["peak_energy"] == run.energy.peak.value / 1e3
    assert measured["identified_round_1"]["late_speed"] is None


def test_finished_runs_are_kept_and_stopped_ones_made_anew(folder: Path, tmp_path: Path) -> None:
    runs = sorted(folder.glob("*.h5"))
    made = [run.stat().st_mtime_ns for run in runs]
    stopped = folder / "identified_oval_1.h5"
    stopped.write_bytes(stopped.read_bytes())
    with atomic.change(stopped) as file:
        file.attrs["status"] = "interrupted"
    assert cli.main([*SMALL, "--output", str(folder)]) == 0
    changed = [
        run for run, before in zip(runs, made, strict=True) if run.stat().st_mtime_ns > before
    ]
    assert changed == [stopped]
    assert gs.open(stopped).status == "finished"


def test_other_runs_are_not_replaced(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([*SMALL, "--cell", "0.1", "--output", str(folder)]) == 2
    assert "identified_soil.h5" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--jobs 0", "--jobs must be a whole number >= 1, got 0"),
        ("--seed 1 1", "seeds must be one or more different numbers"),
        ("--seed -3", "seed must be a whole number >= 0, got -3"),
        ("--stone-modulus -1", "young"),
        ("--cell 0", "cell must be"),
        ("--cell 0.2 --time-step 3e-4", "slope arbitrary, cell 0.2 m: time_step"),
        ("--cell 0.4", "slope arbitrary, cell 0.4 m: cell must be small enough for a point in"),
        ("--convergence arbitrary --cells 0.4 0.2 0.1", "slope arbitrary, cell 0.4 m: cell must"),
    ],
)
def test_refusals(words: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["reproduce", "--output", "never", *words.split()]) == 2
    assert message in capsys.readouterr().err
    assert not Path("never").exists()


@pytest.mark.parametrize(
    ("kill", "number"),
    [(os.kill, signal.SIGINT), (os.killpg, signal.SIGTERM)],
    ids=["ctrl_c", "terminated_as_a_group"],
)
def test_signals_end_all_runs_and_keep_them(
    tmp_path: Path, kill: Callable[[int, int], None], number: signal.Signals
) -> None:
    words = ["--cell", "0.2", "--reading", "identified", "--quiet", "--output", "stopped"]
    command = [sys.executable, "-m", "gimpslope.cli", "reproduce", *words, "--jobs", "2"]
    process = subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, start_new_session=True
    )
    first, second = (
        tmp_path / "stopped" / f"identified_{name}_1.h5" for name in ("arbitrary", "round")
    )
    deadline = time.monotonic() + 60
    while not (first.exists() and second.exists()) and time.monotonic() < deadline:
        time.sleep(0.1)
    time.sleep(1.0)
    kill(process.pid, number)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert errors.decode() == "gimpslope: interrupted\n"
    assert [gs.open(path).status for path in (first, second)] == ["interrupted", "interrupted"]


def test_runs_end_with_a_study_that_is_killed_and_nothing_is_written_twice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["reproduce", "--cell", "0.2", "--reading", "identified", "--quiet", "--jobs", "1"]
    command = [sys.executable, "-m", "gimpslope.cli", *words, "--output", "killed"]
    process = subprocess.Popen(command, cwd=tmp_path)
    path = tmp_path / "killed" / "identified_arbitrary_1.h5"
    deadline = time.monotonic() + 60
    while hdf5.still_writing(path) is None and time.monotonic() < deadline:
        time.sleep(0.1)
    assert cli.main([*words, "--output", str(tmp_path / "killed")]) == 2
    assert f"process {hdf5.still_writing(path)} is writing" in capsys.readouterr().err
    with pytest.raises(FileExistsError, match="that no run is writing"):
        reference.setup(cell=0.8).simulate(path, overwrite=True, progress=False)
    process.kill()
    process.wait()
    while hdf5.still_writing(path) is not None and time.monotonic() < deadline:
        time.sleep(0.1)
    assert gs.open(path).status == "interrupted"


def test_no_more_than_so_many_runs_at_a_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All are made, and given back in the order of the plan."""
    going: list[int] = []
    start = processes._Worker

    def counted(work: Any) -> Any:
        alive = [worker for worker in started if worker.process.is_alive()]
        going.append(len(alive) + 1)
        started.append(start(work))
        return started[-1]

    started: list[Any] = []
    monkeypatch.setattr(processes, "_Worker", counted)
    setup = reference.setup(cell=0.8, duration=0.05)
    plans = [planned.plan(tmp_path / f"{number}.h5", setup) for number in range(4)]
    runs = parallel.run_all(plans, jobs=2, progress=False)
    assert [run.path for run in runs] == [one.path for one in plans]
    assert going[:2] == [1, 2] and max(going) == 2


@pytest.mark.parametrize("content", [b"", b"no HDF5", b"\x89HDF\r\n\x1a\n truncated"])
def test_files_that_are_no_runs(content: bytes, tmp_path: Path) -> None:
    """An empty one is what a run killed at its birth leaves."""
    path, setup = tmp_path / "run.h5", reference.setup(cell=0.8)
    path.write_bytes(content)
    if content:
        with pytest.raises(FileExistsError, match="holds something else: path must name a"):
            planned.plan(path, setup)
    assert planned.plan(path, setup, overwrite=True).found is None


def test_what_differs_from_a_run_that_is_there(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    setup = reference.setup("round", cell=0.4, duration=0.01)
    setup.simulate(path, progress=False)

    def difference(**changed: Any) -> str:
        other = reference.setup("round", **({"cell": 0.4, "duration": 0.01} | changed))
        with pytest.raises(FileExistsError) as refusal:
            planned.plan(path, other)
        return str(refusal.value).partition("something else: ")[2]

    assert difference(duration=0.8) == "stages.slide.duration 0.01 there, 0.8 here"
    assert difference(stone_model="rigid") == "scene.stone DruckerPrager there, Rigid here"
    assert difference(time_step=1e-5) == "method.time_step None there, 1e-05 here"
    drawn = difference(seed=2)
    assert drawn.startswith("scene.stones.stones[0].shape.centre[0] 0.474546 there, ")
    assert drawn.count(" there") == 3 and drawn.endswith(" more")
    assert planned.plan(path, reference.setup("round", cell=0.4, duration=0.01, threads=2)).found
    with atomic.change(path) as file:
        file.attrs["gimpslope_version"] = "0.0.1"
    with pytest.raises(FileExistsError, match=r"else: another version, 0\.0\.1 there, .* here$"):
        planned.plan(path, setup)


def test_a_run_that_fails_is_named_and_the_others_are_finished(tmp_path: Path) -> None:
    good = reference.setup(cell=0.8, duration=0.05)
    impatient = gs.Stages(settling=gs.Settling(limit=0.01), slide=gs.Slide(0.05))
    bad = gs.Setup(good.scene, good.method, impatient)
    plans = [
        planned.plan(tmp_path / f"{name}.h5", one) for name, one in (("bad", bad), ("good", good))
    ]
    with pytest.raises(parallel.RunFailed, match=r"bad\.h5 .* failed: NotSettledError"):
        parallel.run_all(plans, jobs=1, progress=False)
    assert gs.open(tmp_path / "good.h5").status == "finished"


def test_a_warning_of_a_run_is_told_with_its_name(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    literal = reference.setup(reading="literal", cell=0.8, duration=0.05)
    parallel.run_all([planned.plan(tmp_path / "a.h5", literal)], jobs=1, progress=False)
    assert capfd.readouterr().err.startswith(f"gimpslope: {tmp_path / 'a.h5'}: cones: ")


def test_readings_and_seeds_are_planned_without_files(tmp_path: Path) -> None:
    slopes = reproduce.plan(tmp_path / "new", seeds=(1, 2), cell=0.2).slopes
    assert [slope.reading for slope in slopes] == ["identified"] * 4 + ["literal"] * 4
    assert [len(slope.planned) for slope in slopes] == [1, 2, 2, 2] * 2
    assert not (tmp_path / "new").exists()
