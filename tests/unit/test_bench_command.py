"""`gimpslope bench` from the command line, shortened."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gimpslope import cli
from gimpslope.studies.bench import guard
from gimpslope.studies.bench.plan import Plan


@pytest.fixture(autouse=True)
def in_empty_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def short_bench(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = {"in_turn.SECONDS": 0.003, "machine.MEMORY": 2**20, "output.SHARE": 0.01}
    for name, value in (parts | {"single.STEPS": 50}).items():
        monkeypatch.setattr(f"gimpslope.studies.bench.{name}", value)


@pytest.mark.usefixtures("short_bench")
def test_bench(capsys: pytest.CaptureFixture[str]) -> None:
    words = "bench --points 400 1500 --threads 1 2 --json bench.json --output speed"
    assert cli.main(words.split()) == 0
    shown = capsys.readouterr().out
    rows = json.loads(Path("bench.json").read_text())["speeds"]
    assert [row["threads"] for row in rows[:4]] == [1, 2, 1, 2]
    assert len(rows) == 4 + len(Plan().variants())
    for row in rows:
        assert 300 < row["points"] < 1700
        assert 0 < row["slowest"] <= row["median"] <= row["fastest"]
        assert f"{row['median'] / 1e6:.1f}" in shown
    assert Path("speed/bench.txt").read_text() in shown
    assert Path("speed/bench.png").stat().st_size > 20_000


@pytest.mark.parametrize(
    "words", ["--threads 0", "--points 0", "--points -5", "--json nowhere/b.json", "--output b.txt"]
)
def test_bench_refuses(words: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("b.txt").write_text("")
    name, value = words.split()
    small = [] if name == "--points" else ["--points", "400"]
    assert cli.main(["bench", *small, name, value]) == 2
    shown = capsys.readouterr()
    assert name.strip("-") in shown.err and value in shown.err and shown.out == ""


@pytest.mark.parametrize(("on_two", "code"), [(9.5, 0), (7.5, 1)])
def test_bench_guard(
    on_two: float, code: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        guard, "ratios", lambda: {1: guard.Ratio(6, 6.25), 2: guard.Ratio(6, on_two)}
    )
    assert cli.main(["bench", "--guard"]) == code
    shown = capsys.readouterr()
    assert "6.25" in shown.out and f"{on_two:.2f}" in shown.out
    assert ("too slow on 2 threads" in shown.err) == bool(code)


@pytest.mark.parametrize("words", ["--points 400", "--threads 1", "--json b.json", "--output b"])
def test_bench_guard_stands_alone(words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["bench", "--guard", *words.split()]) == 2
    assert f"{words.split()[0]} must be left out" in capsys.readouterr().err
