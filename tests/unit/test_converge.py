"""The study of convergence runs slopes on each grid, keeps its runs, and writes down what it found
as it goes."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import gimpslope as gs
from gimpslope import cli
from gimpslope.analysis import smooth_peak
from gimpslope.simulation import NotSettledError
from gimpslope.studies import converge, planned, reference, reference_stones
from gimpslope.studies.converge.quantities import QUANTITIES, measure
from gimpslope.studies.converge.surfaces import distance, heights

CELLS = (1.6, 0.8, 0.4)
SMALL: dict[str, Any] = {"cells": (4.0, 2.0, 1.0), "readings": ["identified"]}
STONES: dict[str, Any] = {
    "slopes": ["round"],
    "readings": ["identified"],
    "stone_models": ["deformable", "softened"],
    "seeds": (2,),
    "cells": (0.8, 0.4, 0.2),
    "duration": 0.02,
}


def studies_in(folder: Path, **options: Any) -> list[converge.Convergence]:
    *_, last = converge.converge(converge.plan(folder, **options), progress=False)
    return last


def made_in(folder: Path) -> dict[Path, int]:
    return {file: file.stat().st_mtime_ns for file in folder.glob("*.h5")}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("convergence")


@pytest.fixture(scope="module")
def study(folder: Path) -> converge.Convergence:
    (only,) = studies_in(folder, cells=CELLS, readings=["identified"])
    return only


@pytest.fixture(scope="module")
def stones(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A study with stones, so soft that the step is that of the soil, written down."""
    made = tmp_path_factory.mktemp("stones")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reference, "STONE_MODULI", {"deformable": 6e7, "softened": 3e7})
        found = studies_in(made, **STONES)
        converge.write(found, made)
        converge.draw(found, made)
        yield made


def test_values_are_those_of_the_runs(folder: Path, study: converge.Convergence) -> None:
    assert study.cells == CELLS and not study.missing and not study.has_stones
    series = study.series["no stones"]
    for number, cell in enumerate(CELLS):
        run = gs.open(folder / f"soil_identified_{cell:g}.h5")
        assert run.scene.cell == cell
        assert run.method.viscosity == reference.READINGS["identified"].viscosity
        (one,) = series.grids[number]
        assert one is not None and one.points == len(run.points)
        assert one.core_seconds == run.attributes["timing"]["processor_seconds"]
        peak = smooth_peak(run.energy)
        assert peak is not None
        assert one.figures["peak_energy"] == peak.kinetic / 1e3
        assert (one.figures["peak_time"], one.figures["peak_speed"]) == (peak.time, peak.max_speed)
        assert one.figures["total"] == run.max_displacement().total
        assert one.figures["run_out"] == run.run_out(percentile=99)
        assert one.figures["plastic_soil"] == run.plastic_share().soil
        assert one.figures["mean_strain"] == run.final.plastic_strain.mean()
    assert series.values("total").shape == (3, 1)


def test_values_have_a_panel_for_each_figure_that_was_reached(
    study: converge.Convergence, stones: Path
) -> None:
    reached = converge.figures.values(study)
    assert [ax.get_title() for ax in reached.axes] == [one.label for one in QUANTITIES]
    assert all(ax.lines for ax in reached.axes)
    (short,) = studies_in(stones, **STONES)  # of slides that have no peak yet
    nothing = converge.figures.values(short)
    assert not nothing.axes and "none of the figures was reached" in nothing.texts[0].get_text()


def test_surfaces_are_compared_in_the_same_columns(
    folder: Path, study: converge.Convergence
) -> None:
    runs = [gs.open(folder / f"soil_identified_{cell:g}.h5") for cell in CELLS]
    coarse, _, fine = (heights(run, 3.2) for run in runs)
    top = runs[2].final.position[:, 1].max()
    assert top <= fine.max() <= top + 0.5
    assert len(fine) == math.ceil(runs[2].final.position[:, 0].max() / 3.2)
    off = study.series["no stones"].off_finest()
    assert off[:, 0].tolist() == [distance(coarse, fine), off[1, 0], 0.0]


def test_distance_of_surfaces() -> None:
    assert distance(np.array([3.0, 2.0]), np.array([3.0, 2.0])) == 0
    assert distance(np.array([3.0, 2.0, 1.0, 1.0]), np.array([2.0, 1.0])) == 1.0


def test_finished_runs_are_kept(folder: Path, study: converge.Convergence) -> None:
    before = made_in(folder)
    (again,) = studies_in(folder, cells=CELLS, readings=["identified"], threads=2)
    assert made_in(folder) == before
    for figure in ("peak_energy", "total"):
        one, other = (each.series["no stones"].values(figure) for each in (study, again))
        assert one.tolist() == other.tolist()


def test_files_from_before_processor_time_was_kept_cost_their_threads(
    folder: Path, study: converge.Convergence, tmp_path: Path
) -> None:
    (old,) = (shutil.copy(file, tmp_path) for file in folder.glob("*_0.4.h5"))
    with h5py.File(old, "r+") as file:
        timing = json.loads(file.attrs["timing"]) | {"wall_seconds": 7.0}
        del timing["processor_seconds"]
        file.attrs["timing"] = json.dumps(timing)
        file.attrs["method"] = json.dumps(json.loads(file.attrs["method"]) | {"threads": 3})
    assert measure(gs.open(old), 0.4).core_seconds == 21.0


def test_a_slide_that_still_accelerates_has_no_peak(tmp_path: Path) -> None:
    (found,) = studies_in(tmp_path, duration=0.2, **SMALL)
    assert gs.open(tmp_path / "soil_identified_1.h5").phases().peak is None
    series = found.series["no stones"]
    assert np.isnan(series.values("peak_energy")).all() and series.limit("peak_energy") is None
    assert np.isnan(series.values("total")).all() and np.isnan(series.off_finest()).all()
    page = converge.markdown(found)
    nothing = "| not reached | not reached | not reached | - | - | too few grids | - |"
    assert f"| peak kinetic energy, kJ/m {nothing}" in page
    assert f"| largest displacement, m {nothing}" in page


def test_another_run_is_neither_taken_nor_replaced_unless_told(tmp_path: Path) -> None:
    studies_in(tmp_path, duration=0.2, **SMALL)
    with pytest.raises(FileExistsError, match=r"soil_identified_4\.h5"):
        studies_in(tmp_path, duration=0.3, **SMALL)
    studies_in(tmp_path, duration=0.3, overwrite=True, **SMALL)
    file = tmp_path / "soil_identified_4.h5"
    assert gs.open(file).energy.time[-1] == pytest.approx(0.3)

    with h5py.File(file, "r+") as run:
        run.attrs["gimpslope_version"] = "0.0.1"
    with pytest.raises(FileExistsError, match="another version"):
        studies_in(tmp_path, duration=0.3, **SMALL)
    file.write_text("notes")
    with pytest.raises(FileExistsError, match="something else"):
        studies_in(tmp_path, duration=0.3, **SMALL)


def test_a_run_that_was_stopped_starts_again(tmp_path: Path) -> None:
    studies_in(tmp_path, duration=0.2, **SMALL)
    file = tmp_path / "soil_identified_4.h5"
    with h5py.File(file, "r+") as run:
        run.attrs["status"] = "interrupted"
    studies_in(tmp_path, duration=0.2, **SMALL)
    assert gs.open(file).status == "finished"


def test_each_draw_has_the_same_stones_on_each_grid(tmp_path: Path) -> None:
    models = ["softened", "rigid"]
    (made,) = converge.plan(tmp_path, **(STONES | {"seeds": (1, 2), "stone_models": models}))
    assert list(made.planned) == models
    for model, grids in made.planned.items():
        for cell, draws in zip(STONES["cells"], grids, strict=True):
            for seed, one in zip((1, 2), draws, strict=True):
                assert one.path.name == f"round_identified_{model}_{seed}_{cell:g}.h5"
                assert one.setup.scene.cell == cell
                assert one.setup.scene.stones == reference_stones.stones("round", seed)
                assert one.setup.scene.stone == reference.rock(model=model)
    first, second = made.planned["rigid"][0]
    assert first.setup.scene.stones != second.setup.scene.stones


def test_a_run_with_rigid_stones_is_measured(tmp_path: Path) -> None:
    options = STONES | {"stone_models": ["rigid"], "cells": (0.4, 0.2, 0.1), "duration": 0.5}
    (made,) = converge.plan(tmp_path, **options)
    run = made.planned["rigid"][0][0].run(progress=False)
    assert run.phases().peak is not None
    found = measure(run, 0.8)
    assert found.figures["peak_energy"] == pytest.approx(run.energy.peak.value / 1e3, rel=0.05)
    assert found.gap == run.summary["smallest_gap_in_cells"]


def test_page_and_pictures_of_stones(stones: Path) -> None:
    page = (stones / "convergence.md").read_text()
    assert "## Slope C round, reading `identified`" in page and "Missing" not in page
    assert "Seeds of the stones: 2." in page
    assert "| quantity | stones | h = 0.8 m | h = 0.4 m | h = 0.2 m | orders |" in page
    assert "| 368 | 1,485 | 5,895 |" in page
    gap = gs.open(stones / "round_identified_softened_2_0.2.h5").summary["smallest_gap_in_cells"]
    assert gap is not None
    assert f"| {gap / 4:.2f} | {gap / 2:.2f} | {gap:.2f} |" in page
    for kind in ("values", "costs"):
        assert f"](round_identified_{kind}.png)" in page
        assert (stones / f"round_identified_{kind}.png").exists()
    (plain,) = json.loads((stones / "convergence.json").read_text())
    assert list(plain["models"]) == ["deformable", "softened"] and plain["seeds"] == [2]
    assert plain["models"]["deformable"]["points"] == [[368], [1485], [5895]]


def test_finished_runs_with_stones_are_kept(stones: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(planned.Planned, "run")
    (again,) = studies_in(stones, **STONES)
    assert not again.missing and again.has_stones


def test_a_run_that_fails_is_missing_and_the_others_go_on(
    stones: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the finished study, with one run taken away that then does not reach its end."""
    for file in made_in(stones):
        (tmp_path / file.name).hardlink_to(file)
    gone = "round_identified_softened_2_0.2.h5"
    (tmp_path / gone).unlink()

    def diverge(one: planned.Planned, *, progress: bool = True) -> gs.Run:
        raise gs.Diverged(f"{one.path.name} is lost")

    monkeypatch.setattr(planned.Planned, "run", diverge)
    (found,) = studies_in(tmp_path, **STONES)
    assert found.missing == (f"{gone}: {gone} is lost",)
    assert found.series["softened"].complete.tolist() == [True, True, False]
    assert found.series["deformable"].complete.all()
    converge.write([found], tmp_path)
    page = (tmp_path / "convergence.md").read_text()
    assert f"Missing: {gone}: {gone} is lost." in page
    (row,) = [line for line in page.splitlines() if line.startswith("| core-seconds, softened")]
    assert row.endswith(" | missing |")
    (plain,) = json.loads((tmp_path / "convergence.json").read_text())
    assert plain["models"]["softened"]["points"] == [[368], [1485], [None]]


def test_what_is_known_is_told_after_each_run(tmp_path: Path) -> None:
    plan = converge.plan(tmp_path, duration=0.2, **SMALL)
    told = [one for (one,) in converge.converge(plan, progress=False)]
    assert [one.series["no stones"].complete.tolist() for one in told] == [
        [True, False, False],
        [True, True, False],
        [True, True, True],
    ]
    assert told[0].missing == (
        "soil_identified_2.h5: not run yet",
        "soil_identified_1.h5: not run yet",
    )


def test_pages_and_pictures_are_made_though_no_run_reaches_its_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def never(one: planned.Planned, *, progress: bool = True) -> gs.Run:
        raise NotSettledError("it moves")

    monkeypatch.setattr(planned.Planned, "run", never)
    words = "converge round --reading identified --stone-model rigid --quiet --output"
    assert cli.main([*words.split(), str(tmp_path)]) == 1
    assert "missing round_identified_rigid_1_0.05.h5: it moves" in capsys.readouterr().err
    assert "round_identified_rigid_1_0.2.h5: it moves;" in (tmp_path / "convergence.md").read_text()
    assert {file.name for file in tmp_path.iterdir()} == {
        *("convergence.md", "convergence.json"),
        *("round_identified_values.png", "round_identified_costs.png"),
    }


def test_defaults(tmp_path: Path) -> None:
    made = converge.plan(tmp_path)
    assert [(one.name, one.reading, one.cells) for one in made] == [
        ("soil", reading, (0.4, 0.2, 0.1, 0.05)) for reading in ("identified", "literal")
    ]
    (oval, _) = converge.plan(tmp_path, slopes=["oval"])
    assert oval.cells == (0.2, 0.1, 0.05) and oval.seeds == (1,)
    assert list(oval.planned) == ["deformable"]
    assert not any(tmp_path.iterdir())


def test_frictions_and_volume_strains_make_models(tmp_path: Path) -> None:
    (made,) = converge.plan(
        tmp_path,
        slopes=["round"],
        readings=["identified"],
        stone_models=["rigid"],
        stone_frictions=[22.0],
        volumetric_strains=["point", "cell_average"],
    )
    assert list(made.planned) == [
        "rigid",
        "rigid, cell average",
        "rigid, friction 22°",
        "rigid, friction 22°, cell average",
    ]
    run = made.planned["rigid, friction 22°, cell average"][0][0]
    assert run.path.name == "round_identified_rigid-22_cell-average_1_0.2.h5"
    assert run.setup.scene.stone == gs.Rigid(2400, friction=22.0)
    assert run.setup.method.volumetric_strain == "cell_average"


@pytest.mark.parametrize("cells", [(0.4, 0.2), (0.4, 0.2, 0.15), (0.1, 0.2, 0.4)])
def test_cells_refused(tmp_path: Path, cells: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="cells must be three or more"):
        converge.plan(tmp_path, cells=cells)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--seed 1", "--seed must be left out for soil"),
        ("soil --stone-model rigid", "--stone-model must be left out for soil"),
        ("soil --stone-friction 22", "--stone-friction must be left out for soil"),
        ("round --duration 0", "duration must be"),
        ("square", "slope must be one of 'soil', 'arbitrary', 'round', 'oval'"),
        ("round --seed 1 1", "seeds must be one or more different numbers"),
        ("round --seed -1", "seed must be a whole number >= 0"),
        ("soil arbitrary --cells 0.4 0.2 0.1", "slope arbitrary, cell 0.4 m: cell must"),
    ],
)
def test_arguments_refused(words: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["converge", "--output", "never", *words.split()]) == 2
    assert message in capsys.readouterr().err
    assert not Path("never").exists()
