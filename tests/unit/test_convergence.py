"""The convergence study runs the slope on each grid, keeps its runs, and tells what it found."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import h5py
import pytest

import gimpslope as gs
from gimpslope.studies import convergence, reference

CELLS = (2.0, 1.0, 0.5)


def study_in(folder: Path, **options: Any) -> convergence.Convergence:
    return convergence.converge(convergence.plan(folder, **options), progress=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("convergence")


@pytest.fixture(scope="module")
def study(folder: Path) -> convergence.Convergence:
    return study_in(folder, cells=CELLS, duration=3.0)


def test_values_are_those_of_the_runs(folder: Path, study: convergence.Convergence) -> None:
    assert study.cells == CELLS
    assert study.points[0] < study.points[1] / 3 < study.points[2] / 9
    by_title = {quantity.title: quantity for quantity in study.quantities}
    for number, cell in enumerate(CELLS):
        run = gs.open(folder / f"soil_identified_{cell:g}.h5")
        assert run.scene.cell == cell
        assert run.method.viscosity == reference.READINGS["identified"].viscosity
        peak = by_title["peak kinetic energy"].values[number] * 1e3
        assert peak == pytest.approx(run.energy.peak.value, rel=0.01)
        time = by_title["time of the peak"].values[number]
        assert time == pytest.approx(run.energy.peak.time, abs=0.02)
        total = by_title["largest displacement"].values[number]
        assert total == run.max_displacement().total


def test_finished_runs_are_kept(folder: Path, study: convergence.Convergence) -> None:
    files = [folder / f"soil_identified_{cell:g}.h5" for cell in CELLS]
    made = [file.stat().st_mtime_ns for file in files]
    again = study_in(folder, cells=CELLS, duration=3.0, threads=2)
    assert [file.stat().st_mtime_ns for file in files] == made
    assert [q.values for q in again.quantities] == [q.values for q in study.quantities]


def test_another_run_is_neither_taken_nor_replaced_unless_told(tmp_path: Path) -> None:
    small = {"cells": (4.0, 2.0, 1.0)}
    study_in(tmp_path, duration=0.2, **small)
    with pytest.raises(FileExistsError, match=r"soil_identified_4\.h5"):
        study_in(tmp_path, duration=0.3, **small)
    study_in(tmp_path, duration=0.3, overwrite=True, **small)
    file = tmp_path / "soil_identified_4.h5"
    assert gs.open(file).energy.time[-1] == pytest.approx(0.3)

    with h5py.File(file, "r+") as run:
        run.attrs["gimpslope_version"] = "0.0.1"
    with pytest.raises(FileExistsError, match="another version"):
        study_in(tmp_path, duration=0.3, **small)
    file.write_text("notes")
    with pytest.raises(FileExistsError, match="something else"):
        study_in(tmp_path, duration=0.3, **small)


def test_a_run_that_was_stopped_starts_again(tmp_path: Path) -> None:
    small = {"cells": (4.0, 2.0, 1.0), "duration": 0.2}
    study_in(tmp_path, **small)
    file = tmp_path / "soil_identified_4.h5"
    with h5py.File(file, "r+") as run:
        run.attrs["status"] = "interrupted"
    study_in(tmp_path, **small)
    assert gs.open(file).status == "finished"


def test_written(tmp_path: Path, study: convergence.Convergence) -> None:
    convergence.write([study], tmp_path)
    table = (tmp_path / "convergence.md").read_text()
    assert "h = 0.5 m" in table and "peak kinetic energy, kJ/m" in table
    (plain,) = json.loads((tmp_path / "convergence.json").read_text())
    assert plain["cells"] == list(CELLS)
    assert (tmp_path / "convergence_identified.png").stat().st_size > 10_000


@pytest.mark.parametrize("cells", [(0.4, 0.2), (0.4, 0.2, 0.15), (0.1, 0.2, 0.4)])
def test_refused(tmp_path: Path, cells: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="cells must be three or more"):
        convergence.plan(tmp_path, cells=cells)
