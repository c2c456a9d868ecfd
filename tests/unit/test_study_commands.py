"""`gimpslope verify` and `converge` from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from gimpslope import cli
from gimpslope.studies import verify
from gimpslope.studies.verify import bar


@pytest.fixture(autouse=True)
def in_empty_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_verify(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["verify", "bar", "shear", "--output", "known"]) == 0
    shown = capsys.readouterr()
    assert "checks hold" in shown.err.splitlines()[0]
    for word in ("problem", "quantity", "expected", "got", "error", "order", "time"):
        assert word in shown.out.splitlines()[0]
    data = json.loads(Path("known/verification.json").read_text())
    assert [one["name"] for one in data["problems"]] == ["bar", "shear"]
    assert data["set"] == "quick"
    table = Path("known/verification.md").read_text()
    for one in data["problems"]:
        assert Path("known", f"{one['name']}.png").stat().st_size > 5_000
        for check in one["checks"]:
            assert check["holds"] and check["why"] in table and check["quantity"] in shown.out


def test_verify_fails_with_exit_code_1(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    check = verify.Check.at_most("error", bound=1.0, got=2.0, why="one is enough")
    wrong = verify.Problem("bar", "Bar", lambda full: verify.Outcome([check], Figure()))
    monkeypatch.setattr(bar, "PROBLEM", wrong)
    assert cli.main(["verify", "bar"]) == 1
    assert " NO " in capsys.readouterr().out


def test_verify_refuses_unknown_problems(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["verify", "bar", "pendulum"]) == 2
    shown = capsys.readouterr()
    assert "pendulum" in shown.err and "column" in shown.err and shown.out == ""


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("--cells 0.4 0.2", "cells"),
        ("--cells 0.4 0.2 0.15", "cells"),
        ("--cells 1 0 0", "cells"),
        ("--cells 100 50 25", "cell"),
        ("--threads 0", "threads"),
    ],
)
def test_converge_refuses(words: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["converge", *words.split()]) == 2
    assert f"{name} must be" in capsys.readouterr().err
    assert not Path("convergence").exists()


@pytest.mark.parametrize("command", ["verify bar", "converge --cells 4 2 1"])
def test_directories_that_cannot_be_made(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("taken").write_text("a file")
    for output in ("taken", "taken/below"):
        assert cli.main([*command.split(), "--output", output]) == 2
        shown = capsys.readouterr()
        assert output in shown.err and shown.out == ""


def test_converge(capsys: pytest.CaptureFixture[str]) -> None:
    words = "converge --reading identified --cells 4 2 1 --quiet --output finer"
    assert cli.main(words.split()) == 0
    assert "h = 1 m" in capsys.readouterr().out
    assert Path("finer/convergence.md").exists() and Path("finer/soil_identified_4.h5").exists()
