"""Plans from the command line, and the study of four slopes by plans."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

import gimpslope as gs
from gimpslope import cli, planning
from gimpslope.planning import Estimate
from gimpslope.studies import reference, within

CELLS = (0.8, 0.4, 0.2)
GIMPSLOPE = [sys.executable, "-m", "gimpslope.cli"]

SCENE = """
cell = 0.8
[outline]
height = 4.5
crest = 1
[materials.soil]
density = 1800
young = 30e6
poisson = 0.33
friction = 22
cohesion = 1e3
[stages.slide]
duration = 4
[method]
viscosity = 0.2
"""


def test_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("small.toml").write_text(SCENE)
    words = [
        "plan",
        "small.toml",
        "--error",
        "0.5",
        "--budget",
        "0.1",
        "--quantities",
        "time_of_peak",
    ]
    assert cli.main([*words, "--dry-run"]) == 0
    shown = capsys.readouterr()
    assert "time of the peak" in shown.out and "pilot: cell" in shown.err
    assert not Path("small_planned.h5").exists()
    assert cli.main([*words, "--quiet", "--output", "fine.h5"]) == 0
    shown = capsys.readouterr()
    assert "by the estimate" in shown.out and shown.err == ""
    assert gs.open("fine.h5").status == "finished"
    assert cli.main([*words, "--output", "fine.h5"]) == 2
    assert "--output must be a new file" in capsys.readouterr().err


class Ended(NamedTuple):
    """How a command ended: its exit code, its last line on standard error, whether it showed a
    traceback, and what is left of its pilots."""

    code: int
    last: str
    traceback: bool
    left: list[Path]


IN_GOOD_ORDER = Ended(130, "gimpslope: interrupted", traceback=False, left=[])


def terminated(
    command: list[str], folder: Path, plans: int, kill: Callable[[int, int], None] = os.kill
) -> Ended:
    """Ends a command by SIGTERM when so many plans have begun."""
    pilots = folder / "pilots"
    pilots.mkdir()
    process = subprocess.Popen(
        command,
        env=os.environ | {"TMPDIR": str(pilots)},
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    try:
        deadline = time.monotonic() + 25
        while len(list(pilots.glob("gimpslope_*/*.h5"))) < plans and time.monotonic() < deadline:
            time.sleep(0.05)
        assert len(list(pilots.glob("gimpslope_*"))) == plans, "plans that have begun"
        kill(process.pid, signal.SIGTERM)
        _, errors = process.communicate(timeout=10)
    finally:
        process.kill()
        process.communicate()
    shown = errors.decode()
    last = shown.splitlines()[-1]
    return Ended(process.returncode, last, "Traceback" in shown, list(pilots.iterdir()))


def test_a_plan_that_is_terminated_takes_its_pilots_along(tmp_path: Path) -> None:
    """Also one in the background of a script, where Ctrl-C is ignored."""
    plan = ["plan", "soil", "--error", "0.001", "--output", str(tmp_path / "soil.h5")]
    in_background = ["sh", "-c", "trap '' INT; exec \"$@\"", ""]
    assert terminated([*in_background, *GIMPSLOPE, *plan], tmp_path, plans=1) == IN_GOOD_ORDER


@pytest.mark.parametrize("kill", [os.kill, os.killpg], ids=["alone", "as_a_group"])
def test_a_study_that_is_terminated_takes_its_plans_along(
    tmp_path: Path, kill: Callable[[int, int], None]
) -> None:
    words = ["--error", "0.001", "--jobs", "2", "--output", str(tmp_path / "study")]
    assert terminated([*GIMPSLOPE, "reproduce", *words], tmp_path, 2, kill) == IN_GOOD_ORDER


def test_warnings_of_a_slope_are_lines_of_the_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def plan(*_: object, **__: object) -> None:
        warnings.warn("torn", gs.MethodWarning, stacklevel=2)
        raise InterruptedError

    monkeypatch.setattr(warnings, "showwarning", warnings.showwarning)
    monkeypatch.setattr(within.planning, "plan", plan)
    target = planning.Target(0.1, within.QUANTITIES)
    of = {"folder": tmp_path, "target": target, "reading": "identified", "seed": 1}
    with warnings.catch_warnings(), pytest.raises(InterruptedError):
        warnings.simplefilter("always")
        within._slope("soil", **of, progress=False)  # type: ignore[arg-type]
    assert capsys.readouterr().err == "A soil: torn\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("plan clay", "SCENE must be one of"),
        ("plan missing.toml", "missing.toml"),
        ("plan missing.toml --seed 2", "--seed must be left out"),
        ("plan soil --error 2", "error must be"),
        ("plan soil --budget -1", "budget must be"),
        ("plan soil --output plan.txt", "--output must be a file that ends in .h5"),
        ("reproduce --error 0", "error must be"),
        ("reproduce --error 0.1 --cell 0.2", "--cell must be left out with --error, got 0.2"),
        ("reproduce --error 0.1 --convergence", "--convergence must be left out"),
        ("reproduce --error 0.1 --stone-friction 20", "--stone-friction must be left out"),
        ("reproduce --error 0.1 --seed 1 2", "--seed must be a single one with --error"),
        ("reproduce --error 0.1 --reading literal identified", "--reading must be a single one"),
        ("reproduce --budget 60", "--budget must be given with --error"),
    ],
)
def test_what_commands_refuse(
    words: str,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(words.split()) == 2
    assert message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_page_of_the_study(tmp_path: Path) -> None:
    names = ("peak_kinetic_energy", "time_of_peak")
    of_peak = Estimate(names[0], CELLS, (96e3, 130e3, 147e3))
    of_time = Estimate(names[1], CELLS, (1.7, 1.6, math.nan))
    slopes = tuple(
        within.Slope(name, (of_peak, of_time), True, False, 400, 9000, 1.5, (1.0, 2.0), ("why",))
        for name in reference.SLOPES
    )
    found = within.Study(planning.Target(0.1, names), "identified", 1, slopes, 12.0)
    within.write(found, tmp_path)
    page = (tmp_path / "within.md").read_text()
    assert "| peak kinetic energy | 164 ± 21 kJ/m, 13.0 % (147) |" in page
    assert "not reached" in page and "1.0 + 2.0" in page and "- why" in page
    assert '"error": null' in (tmp_path / "within.json").read_text()


def test_study_does_not_replace_runs(tmp_path: Path) -> None:
    (tmp_path / "soil.h5").write_text("precious")
    with pytest.raises(FileExistsError, match=r"soil\.h5"):
        within.study(planning.Target(0.1), tmp_path)
