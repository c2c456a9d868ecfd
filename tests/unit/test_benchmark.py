"""The benchmark measures what it says: slope A, about that many points, that many threads."""

from __future__ import annotations

import pytest

import gimpslope as gs
from gimpslope.studies import benchmark
from gimpslope.studies.benchmark import Measurement


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(benchmark, "_SECONDS", 0.005)


@pytest.mark.parametrize("points", [400, 1500, 5872])
def test_about_as_many_points_as_asked(points: int) -> None:
    """The face cuts cells: of the order of one point a row too many or too few."""
    measured = benchmark.Case(points).measure()
    assert measured.points == pytest.approx(points, abs=2 * points**0.5)
    assert 0 < measured.slowest <= measured.median <= measured.fastest
    assert measured.threads == 1
    assert measured.instruction_set == gs.kernel.instruction_sets()[-1]


def test_memory_is_under_a_kilobyte_a_point() -> None:
    assert 100 < benchmark.Case(5872).measure().bytes_per_point < 1000


def test_instruction_set_and_threads_as_asked() -> None:
    measured = benchmark.Case(400, threads=2, instruction_set="generic").measure()
    assert (measured.threads, measured.instruction_set) == (2, "generic")


@pytest.mark.parametrize(
    ("options", "name"),
    [({"threads": 0}, "threads"), ({"instruction_set": "abacus"}, "instruction_set")],
)
def test_refused(options: dict[str, object], name: str) -> None:
    with pytest.raises(ValueError, match=f"{name} must be"):
        benchmark.Case(400, **options).measure()  # type: ignore[arg-type]


def test_rate_counts_points_and_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a clock that moves on by a second at every look, a repeat lasts one second."""
    ticks = iter(range(1000))
    monkeypatch.setattr(benchmark.time, "perf_counter", lambda: float(next(ticks)))
    monkeypatch.setattr(benchmark, "_SECONDS", 0.2)
    measured = benchmark.Case(400).measure()
    steps = round(0.2 * benchmark._WARM_UP)  # of a repeat, which takes a second here
    assert measured.median == measured.plain == measured.points * steps
    assert measured.ratio == 1


def test_table_has_a_line_a_measurement() -> None:
    one = Measurement(23_490, 1, True, "generic", 12.34e6, 11e6, 13e6, 5.06e6, 2.44, 240.4)
    lines = benchmark.table([one, one]).splitlines()
    assert len(lines) == 3 and lines[1] == lines[2]
    for text in ("23,490", "generic", "12.3", "11.0 ... 13.0", "5.1", "2.44", "240", " on "):
        assert text in lines[1]
    assert one.to_dict()["bytes_per_point"] == 240.4
