"""`gimpslope run`, `export` and `info`: what they run, what they refuse, what they write."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic_run

import gimpslope as gs
from gimpslope import cli, figures
from gimpslope.cli import run as run_command
from gimpslope.io import atomic
from gimpslope.studies import reference

COARSE = ["run", "soil", "--cell", "0.8", "--duration", "0.2", "--quiet"]


@pytest.fixture(autouse=True)
def in_empty_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The arguments with which figures would have been drawn."""
    calls: list[Any] = []
    monkeypatch.setattr(figures, "write_figures", lambda *given: calls.append(given))
    return calls


def test_run_with_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    Path("all.h5").write_text("an older run")
    words = "--reading literal --cell 0.8 --duration 0.3 --courant 0.3 --threads 2 --output all.h5"
    more = "--overwrite --summary all.json --figures maps --quiet --volumetric-strain cell_average"
    assert cli.main(["run", "soil", *words.split(), *more.split()]) == 0
    run = gs.open("all.h5")
    assert run.status == "finished"
    assert run.scene == reference.slope("soil", "literal", 0.8)
    assert run.method == reference.method(
        "literal", courant=0.3, threads=2, volumetric_strain="cell_average"
    )
    assert run.stages == gs.Stages(slide=gs.Slide(0.3))
    assert run.attributes["threads"] == 2
    assert json.loads(Path("all.json").read_text()) == run.summary
    drawn = {path.name for path in Path("maps").iterdir()}
    assert {"kinetic_energy.png", "ledger.png", "speed.png", "plastic_zone.png"} <= drawn
    assert {"displacement.png", "displacement_bars.png"} <= drawn
    shown = capsys.readouterr()
    assert "slope A, soil, literal" in shown.out and "paper" in shown.out
    for value in ("1.6", "> 3", "9.3", "8.9", "5.4"):
        assert value in shown.out
    assert f"{run.summary['max_displacement_total']:.2f}" in shown.out
    assert "368 points" in shown.out and "all.h5" in shown.out and "maps" in shown.out
    assert shown.err == ""


def test_defaults(undrawn: list[Any]) -> None:
    assert cli.main([*COARSE]) == 0
    run = gs.open("soil.h5")
    assert run.scene == reference.slope("soil", "identified", 0.8)
    assert run.method == reference.method("identified")
    assert run.method.step == ("courant", 0.4)
    assert undrawn[0][1:] == ("soil_figures", reference.PAPER["soil"])
    np.testing.assert_allclose(run.times, [0, 0.2], atol=1e-12)


def test_maps_at_the_times_of_the_paper(undrawn: list[Any]) -> None:
    assert cli.main([*COARSE, "--duration", "3.6"]) == 0
    times = gs.open("soil.h5").times
    for asked in (0.5, 1.0, 1.6, 3.5):
        assert np.abs(times - asked).min() < 1e-9


def test_fixed_time_step(undrawn: list[Any]) -> None:
    assert cli.main([*COARSE, "--time-step", "0.001"]) == 0
    run = gs.open("soil.h5")
    assert run.method.step == ("fixed", 0.001)
    np.testing.assert_allclose(run.energy.time, 1e-3 * run.energy.step, rtol=1e-9)


def test_progress_shows_time_speed_and_what_is_left(
    undrawn: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([word for word in COARSE if word != "--quiet"]) == 0
    shown = capsys.readouterr().err
    for text in ("gravity", "settling", "slide", "of 0.20 s", "M point-steps/s", "<"):
        assert text in shown


def test_until_rest(undrawn: list[Any]) -> None:
    assert cli.main([*COARSE, "--duration", "8", "--until-rest"]) == 0
    run = gs.open("soil.h5")
    assert run.stages == gs.Stages(slide=gs.Slide(8.0).until_rest())
    assert "at rest" in run.status_detail and 3.0 < run.final.time < 8.0
    Path("boulder.toml").write_text(SCENE)
    assert cli.main(["run", "boulder.toml", "--quiet", "--until-rest"]) == 0
    assert gs.open("boulder.h5").stages == gs.Stages(slide=gs.Slide(0.1).until_rest())


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("--cell -1", "cell"),
        ("--cell nan", "cell"),
        ("--cell 50", "cell"),
        ("--cell wide", "--cell"),
        ("--duration 0", "duration"),
        ("--duration inf", "duration"),
        ("--courant 3", "courant"),
        ("--courant 0", "courant"),
        ("--time-step 0.01", "time_step"),
        ("--time-step -1", "time_step"),
        ("--time-step 0.001 --courant 0.1", "--courant"),
        ("--threads 0", "threads"),
        ("--threads 1.5", "--threads"),
        ("--reading favourite", "--reading"),
        ("--colour red", "--colour"),
        ("--summary nowhere/s.json", "nowhere"),
    ],
)
def test_refused_values(words: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = cli.main([*COARSE, *words.split()])
    except SystemExit as left:  # as argparse does
        code = int(left.code or 0)
    assert code == 2
    message = capsys.readouterr().err
    assert name in message and "Traceback" not in message
    assert words.split()[1] in message or words.split()[0] in message
    assert not Path("soil.h5").exists()


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("--output nowhere/run.h5", "output"),
        ("--output .", "output"),
        ("--summary .", "summary"),
        ("--figures taken", "figures"),
        ("--summary nowhere/s.json", "summary"),
    ],
)
def test_files_that_cannot_be_written(
    words: str, name: str, undrawn: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("taken").write_text("a file, no directory")
    assert cli.main([*COARSE, *words.split()]) == 2
    assert f"{name} must" in capsys.readouterr().err
    assert not Path("soil.h5").exists()


def test_existing_output_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    Path("soil.h5").write_text("precious")
    assert cli.main(COARSE) == 2
    assert "soil.h5" in capsys.readouterr().err
    assert Path("soil.h5").read_text() == "precious"


def test_failed_run_has_exit_code_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: Any, **__: Any) -> None:
        raise gs.NotSettledError("not at rest")

    monkeypatch.setattr(run_command.Simulation, "run", fails)
    assert cli.main(COARSE) == 1
    assert "not at rest" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["arbitrary", "round", "oval"])
def test_slopes_with_stones(
    name: str, undrawn: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    words = f"run {name} --cell 0.2 --duration 0.01 --seed 3 --stone-modulus 1e8 --quiet"
    assert cli.main(words.split()) == 0
    run = gs.open(f"{name}.h5")
    assert run.scene == reference.slope(name, cell=0.2, seed=3, stone_modulus=1e8)
    assert run.scene.materials[1].young == 1e8
    assert undrawn[0][2] == reference.PAPER[name]
    shown = capsys.readouterr().out
    assert (
        f", {name}, identified" in shown and f"{reference.PAPER[name]['time_of_peak']:g}" in shown
    )


def test_rigid_stones_with_friction(undrawn: list[Any]) -> None:
    words = "run round --cell 0.4 --duration 0.01 --stone-model rigid --stone-friction 30 --quiet"
    assert cli.main(words.split()) == 0
    run = gs.open("round.h5")
    assert run.scene.materials[1] == gs.Rigid(2400, friction=30)
    assert run.setup.scene == reference.slope(
        "round", cell=0.4, stone_model="rigid", stone_friction=30
    )


SCENE = """
cell = 0.8
[outline]
height = 9
[materials.soil]
density = 1800
young = 30e6
poisson = 0.33
friction = 22
cohesion = 1e3
[materials.stone]
law = "elastic"
density = 2400
young = 60e6
poisson = 0.2
[[stones]]
centre = [3, 3]
axes = [2, 2]
[stages.slide]
duration = 0.1
"""


def test_scene_file_and_its_repetition(
    undrawn: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("boulder.toml").write_text(SCENE)
    assert cli.main(["run", "boulder.toml", "--quiet", "--threads", "2"]) == 0
    first = gs.open("boulder.h5")
    assert first.setup.scene == gs.load("boulder.toml").scene
    assert "paper" not in capsys.readouterr().out
    assert cli.main(["run", "boulder.h5", "--quiet", "--threads", "1"]) == 0
    assert "repeats boulder.h5 to the last bit" in capsys.readouterr().out
    again = gs.open("boulder_again.h5")
    assert again.method.threads == 1
    np.testing.assert_array_equal(again.final.position, first.final.position)


def test_endings_in_capitals(undrawn: list[Any]) -> None:
    Path("BOULDER.TOML").write_text(SCENE)
    assert cli.main(["run", "BOULDER.TOML", "--quiet", "--output", "FIRST.H5"]) == 0
    assert gs.load("FIRST.H5") == gs.load("BOULDER.TOML")
    assert cli.main(["run", "FIRST.H5", "--quiet"]) == 0
    assert gs.open("FIRST_again.h5").status == "finished"


def test_a_repetition_that_differs_says_so(
    undrawn: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("boulder.toml").write_text(SCENE)
    assert cli.main(["run", "boulder.toml", "--quiet"]) == 0
    with atomic.change(Path("boulder.h5")) as file:
        file["final/position"][0, 0] += 1e-9
        file.attrs["instruction_set"] = "abacus"
    assert cli.main(["run", "boulder.h5", "--quiet"]) == 0
    assert "differs from boulder.h5: instruction set 'abacus' there" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("run clay", "SLOPE must be one of soil, arbitrary, round, oval, a scene file"),
        ("run missing.toml", "missing.toml"),
        ("run missing.h5", "missing.h5"),
        ("run boulder.toml --cell 0.2", "--cell must be left out"),
        ("run boulder.toml --stone-modulus 1e9", "--stone-modulus must be left out"),
        ("run soil --seed 3", "--seed must be left out for soil"),
        ("run soil --stone-modulus 1e9", "--stone-modulus must be left out for soil"),
        ("run round --seed -1", "seed must be a whole number >= 0, got -1"),
        ("run round --stone-modulus 0", "young must be"),
        ("run round --stone-friction 30", "stone_friction must be left out"),
        ("run round --stone-model rigid --stone-friction 95", "friction must be"),
        ("run soil --stone-friction 30", "--stone-friction must be left out for soil"),
        ("run made.h5 --output made.h5 --overwrite", "not the run to repeat"),
        ("run made.h5 --until-rest", "--until-rest must be left out of a run to repeat"),
        ("run soil --output soil.txt", "--output must be a file that ends in .h5, got 'soil.txt'"),
        ("run cut.h5", "path must name a whole run file, got 'cut.h5', which is damaged"),
        ("export missing.h5 --vtu out", "missing.h5"),
        ("export empty.h5 --vtu out", "the run must have snapshots, got none in 'empty.h5'"),
        ("export made.h5 --vtu boulder.toml", "--vtu must be a directory, got 'boulder.toml'"),
    ],
)
def test_what_run_and_export_refuse(
    words: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("boulder.toml").write_text(SCENE)
    synthetic_run.write_run(Path("made.h5"), until=0.5)
    synthetic_run.new_writer(Path("empty.h5"))
    Path("cut.h5").write_bytes(Path("made.h5").read_bytes()[:50_000])
    before = sorted(Path().iterdir())
    assert cli.main(words.split()) == 2
    assert message in capsys.readouterr().err
    assert sorted(Path().iterdir()) == before


def test_export(capsys: pytest.CaptureFixture[str]) -> None:
    synthetic_run.write_run(Path("made.h5"), until=0.5)
    assert cli.main(["export", "made.h5", "--vtu", "out", "--times", "0", "0.5"]) == 0
    assert "out/made.pvd" in capsys.readouterr().out
    assert {path.name for path in Path("out").iterdir()} == {
        "made.pvd",
        "made_0000.vtu",
        "made_0001.vtu",
    }
    again = ["export", "made.h5", "--vtu", "out"]
    assert cli.main(again) == 2
    refusal = "--vtu must be an empty directory unless --overwrite is given, got 'out'"
    assert refusal in capsys.readouterr().err
    assert cli.main([*again, "--overwrite"]) == 0
    assert len(list(Path("out").iterdir())) == 4


def test_info(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["info"]) == 0
    shown = capsys.readouterr().out
    assert gs.__version__ in shown
    for name in gs.kernel.instruction_sets():
        assert name in shown


def test_installed_command() -> None:
    command = Path(sys.executable).with_name("gimpslope")
    shown = subprocess.run([command, "--version"], capture_output=True, text=True, timeout=30)
    assert shown.returncode == 0 and shown.stdout.strip() == f"gimpslope {gs.__version__}"
    shown = subprocess.run([command], capture_output=True, text=True, timeout=30)
    assert shown.returncode == 2 and "COMMAND" in shown.stderr


def test_warnings_are_lines_of_the_command(
    undrawn: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert cli.main([*COARSE, "--reading", "literal"]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert sum(line.startswith("gimpslope: cones: ") for line in lines) == 1
