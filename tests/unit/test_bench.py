"""The benchmark measures what it says, and its figures follow from what was measured."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gimpslope as gs
from gimpslope import _core
from gimpslope.studies import bench, plain_data
from gimpslope.studies.bench import (
    Case,
    Plan,
    guard,
    in_turn,
    machine,
    output,
    report,
    single,
    speed,
    study,
)
from gimpslope.studies.bench.in_turn import Work
from gimpslope.studies.bench.machine import Limits
from gimpslope.studies.bench.output import OutputCost
from gimpslope.studies.bench.single import SingleError


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(in_turn, "SECONDS", 0.005)
    monkeypatch.setattr(in_turn, "REPEATS", 3)


def measurement(case: Case) -> bench.Measurement:
    return bench.Measurement(
        case=case,
        points=case.points + 14,
        instruction_set="generic",
        median=12.34e6,
        slowest=11e6,
        fastest=13e6,
        plain=5.06e6,
        ratio=2.44,
        ratio_of_fastest=2.57,
        to_standard=0.87,
        flops=500.0,
        peak=50e9,
        peak_share=0.123,
        bytes_per_point=240.4,
        parts={"stress": 0.5, "move": 0.3, "nodes": 0.15, "sort": 0.05},
    )


def results() -> bench.Results:
    """Figures as they might have been measured."""
    plan = Plan([2000, 23_490], [1, 2])
    parts = {"stress": 0.4, "move": 0.3, "nodes": 0.1, "sort": 0.05, "output": 0.1, "rest": 0.05}
    return bench.Results(
        machine=[
            Limits(n, "generic", 52e9 * n, {"L2": 110e9 * n, "L3": 80e9 * n, "DRAM": 21e9})
            for n in plan.threads
        ],
        speeds=[measurement(case) for group in plan.groups() for case in group],
        output=[OutputCost(23_490, n, 1042, 11, 251, 0.123, parts) for n in plan.threads],
        single=SingleError(23_490, 2000, 1.5e-7, 2.5e-7, 3.5e-7),
        study=study.extrapolate({1: 40e6, 2: 79e6}),
    )


@pytest.mark.parametrize("points", [400, 1500, 5872])
def test_about_as_many_points_as_asked(points: int) -> None:
    """The face cuts cells: of the order of one point a row too many or too few."""
    solver = Case(points).solver()
    assert len(solver) == pytest.approx(points, abs=2 * points**0.5)
    assert solver.threads == 1
    assert solver.instruction_set == gs.kernel.instruction_sets()[-1]


def test_case_as_asked() -> None:
    case = Case(400, threads=2, precision="single", shape="linear", ledger=True)
    solver = replace(case, instruction_set="generic").solver()
    assert (solver.threads, solver.instruction_set) == (2, "generic")
    method = case.method()
    assert (method.precision, method.shape, method.ledger) == ("single", "linear", True)
    assert case.standard == Case(400, threads=2)


def test_share_of_stones() -> None:
    slope = Case(5872, stones=0.4).slope()
    in_stone = slope.points.material == 1
    assert in_stone.mean() == pytest.approx(0.4, abs=0.02)
    densities = np.where(in_stone, slope.materials[1].density, slope.materials[0].density)
    assert slope.points.mass == pytest.approx(slope.points.volume * densities)


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"points": 3}, "points"),
        ({"points": 10**11}, "points"),
        ({"threads": 0}, "threads"),
        ({"stones": 0.9}, "stones"),
        ({"shape": "cubic"}, "shape"),
        ({"scheme": "late"}, "scheme"),
        ({"precision": "half"}, "precision"),
        ({"instruction_set": "abacus"}, "instruction_set"),
    ],
)
def test_refused_cases(options: dict[str, object], name: str) -> None:
    with pytest.raises(ValueError, match=f"{name} must be"):
        Case(**({"points": 400} | options)).solver()  # type: ignore[arg-type]


def test_threads_are_refused_where_there_are_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench.cases.kernel, "has_threads", lambda: False)
    assert Case(400).threads == 1
    with pytest.raises(ValueError, match="threads must be 1, for this build has none, got 2"):
        Case(400, threads=2)


def test_operations_that_are_not_counted_are_left_open() -> None:
    late = replace(measurement(Case(2000, scheme="usl")), flops=None, peak_share=None)
    counted, open_ = report.table([measurement(Case(2000)), late]).splitlines()[1:]
    assert "12 %" in counted and "%" not in open_.split("2.57")[1] and " - " in open_


def test_plan_has_the_variants_in_the_size_nearest_to_slope_a() -> None:
    plan = Plan([30_000, 2000], [2, 1, 2])
    assert (plan.sizes, plan.threads) == ((2000, 30_000), (1, 2))
    small, large = plan.groups()
    assert small == [Case(2000, 1), Case(2000, 2)]
    assert large[:2] == [Case(30_000, 1), Case(30_000, 2)]
    assert all(case.standard == plan.standard == Case(30_000) for case in large[2:])
    assert {case.shape for case in large} == {"linear", "ugimp", "cpgimp", "quadratic_bspline"}
    assert {case.scheme for case in large} == {"usf", "usl", "musl"}
    assert any(case.ledger for case in large) and any(case.stones == 0.4 for case in large)
    assert any(case.precision == "single" for case in large)
    assert any(case.volumetric_strain == "cell_average" for case in large)


def test_plan_refuses() -> None:
    with pytest.raises(ValueError, match="sizes must hold a number"):
        Plan([])
    with pytest.raises(ValueError, match="threads must be"):
        Plan(None, [0])


def test_works_are_done_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a clock that the works move on, rates are exact, and no work waits for another's end."""
    clock, log = [0.0], []

    def work(name: str, each: float) -> Work:
        def do(count: int) -> None:
            clock[0] += count * each
            log.append(name)

        return Work(do)

    monkeypatch.setattr(in_turn.time, "perf_counter", lambda: clock[0])
    rates = in_turn.rates({"fast": work("fast", 1e-4), "slow": work("slow", 4e-4)})
    assert rates["fast"] == pytest.approx([1e4] * 3) and rates["slow"] == pytest.approx([2500] * 3)
    assert in_turn.ratio(rates["fast"], rates["slow"]) == pytest.approx(4)
    assert log[-6:] == ["fast", "slow"] * 3


def test_measurements_of_a_group(monkeypatch: pytest.MonkeyPatch) -> None:
    """With given rates, the first work's 1, 2 and 3 a second and k times that of the k-th; plain
    loops are at their best no faster than in the median."""

    def rates(works: dict[Any, Work]) -> dict[Any, np.ndarray]:
        for work in works.values():
            work.do(2)
        fastest = {name: 2.0 if "plain" in str(name) else 3.0 for name in works}
        return {
            name: k * np.array([1.0, fastest[name], 2.0]) for k, name in enumerate(works, start=1)
        }

    monkeypatch.setattr(speed, "rates", rates)
    linear, ledger = Case(400, shape="linear"), Case(400, threads=2, ledger=True)
    first, second, third = speed.measure([Case(400), linear, ledger])
    n = first.points
    assert (first.slowest, first.median, first.fastest) == (n, 2 * n, 3 * n)
    assert first.plain == second.plain == 4 * 2 * n
    assert (first.ratio, second.ratio, third.ratio) == (1 / 4, 2 / 4, 3 / 4)
    assert (first.ratio_of_fastest, third.ratio_of_fastest) == (3 / 8, 9 / 8)
    assert (first.to_standard, second.to_standard, third.to_standard) == (1, 2, None)
    assert first.peak_share == pytest.approx(first.flops * first.median / first.peak)
    assert third.peak == pytest.approx(2 * first.peak * 6 / 5)  # two threads, the sixth work
    assert second.flops < first.flops
    for one in (first, second, third):
        assert 100 < one.bytes_per_point < 2000
        assert set(one.parts) == {"stress", "move", "nodes", "sort"}
        assert sum(one.parts.values()) == pytest.approx(1)
    row = third.to_dict()
    assert (row["threads"], row["ledger"], row["points"]) == (2, True, third.points)


def test_limits_of_the_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    """With given rates of repeats: a clock would tell of what else the machine does."""

    def rates(works: dict[str, Work]) -> dict[str, np.ndarray]:
        for work in works.values():
            work.do(1)
        return {name: np.array([1.0, 3.0, 2.0]) for name in works}

    monkeypatch.setattr(machine, "MEMORY", 2**22)
    monkeypatch.setattr(machine, "rates", rates)
    limits = machine.measure(2)
    loops = _core.Machine(threads=2, bytes=machine.BUFFERS["L2"])
    assert limits.threads == 2
    assert limits.multiply_add == 2 * loops.multiply_add(1)  # by the median
    assert list(limits.reading) == ["L2", "L3", "DRAM"]
    assert limits.reading["L2"] == 2 * loops.read(1)
    assert limits.reading["DRAM"] == 2 * 2**22


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
def test_loops_count_their_work(instruction_set: str) -> None:
    one, two = (
        _core.Machine(threads=n, bytes=1000, instruction_set=instruction_set) for n in (1, 2)
    )
    assert one.multiply_add(10) == 10 * one.multiply_add(1) > 0
    assert two.multiply_add(10) == 2 * one.multiply_add(10)
    assert (one.read(3), two.read(3)) == (3 * 960, 2 * 3 * 960)  # whole cache lines


@pytest.mark.parametrize(("name", "value"), [("threads", 0), ("bytes", 63)])
def test_machine_refuses(name: str, value: int) -> None:
    with pytest.raises(ValueError, match=f"{name} must be .*, got {value}"):
        _core.Machine(**({"threads": 1, "bytes": 64} | {name: value}))


@pytest.mark.parametrize("name", ["multiply_add", "read"])
def test_machine_refuses_less_than_no_work(name: str) -> None:
    with pytest.raises(ValueError, match="must be zero or positive, got -1"):
        getattr(_core.Machine(threads=1, bytes=64), name)(-1)


def test_output_is_written_at_the_rates_of_the_whole_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output, "SHARE", 0.01)
    cost = output.measure(Case(400))
    assert cost.rows == 1 + 0.01 * output.DURATION / output.RECORDING.energy_interval
    assert cost.snapshots == 1 + 0.01 * output.SNAPSHOTS
    assert cost.share < 1
    assert list(cost.parts) == ["stress", "move", "nodes", "sort", "output", "rest"]
    assert sum(cost.parts.values()) == pytest.approx(1)


def test_single_precision_is_near_double(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(single, "STEPS", 200)
    error = single.compare(Case(400))
    for difference in (error.kinetic, error.largest, error.median):
        assert 0 < difference < 1e-4


def test_time_of_the_study() -> None:
    """23,490 points and 1,000,000 steps at 23.49 M point-steps/s are 1,000 s."""
    side_by_side = study.extrapolate({1: 23.49e6, 2: 40e6})
    assert side_by_side.slope[1] == pytest.approx(1000)
    assert (side_by_side.at_once, side_by_side.study) == (2, pytest.approx(2000))
    in_turn_faster = study.extrapolate({1: 23.49e6, 2: 2.5 * 23.49e6})
    assert (in_turn_faster.at_once, in_turn_faster.study) == (1, pytest.approx(1600))
    assert study.extrapolate({2: 23.49e6}).study == pytest.approx(4000)
    with pytest.raises(ValueError, match="rates must hold"):
        study.extrapolate({})


def test_guard_lets_a_fast_kernel_pass() -> None:
    """By its fastest repeat, though others on the machine have slowed most of them."""
    fast = {
        n: guard.Ratio(median=0.7 * limit, of_fastest=limit) for n, limit in guard.LIMITS.items()
    }
    assert guard.failures(fast) == []
    assert len(guard.lines(fast)) == 2
    (measured, missing) = guard.lines({1: guard.Ratio(6.4, 7.0)})
    assert "6.40 times" in measured and "7.00 by the fastest" in measured
    assert "2 threads: not measured" in missing


@pytest.mark.parametrize("ratio", [0.99, float("nan")])
@pytest.mark.parametrize("threads", guard.LIMITS)
def test_guard_names_a_slow_kernel(threads: int, ratio: float) -> None:
    limits = {n: guard.Ratio(limit, limit) for n, limit in guard.LIMITS.items()}
    slow = guard.Ratio(guard.LIMITS[threads], ratio * guard.LIMITS[threads])
    (failure,) = guard.failures(limits | {threads: slow})
    assert f"too slow on {threads} thread" in failure
    assert f"{slow.of_fastest:.2f}" in failure and f"{guard.LIMITS[threads]:g}" in failure


def test_guard_measures_slope_a_beside_the_plain_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Case] = []

    def measured(cases: list[Case]) -> list[bench.Measurement]:
        asked.extend(cases)
        return [measurement(case) for case in cases]

    monkeypatch.setattr(guard, "measure", measured)
    monkeypatch.setattr(guard, "all_threads", lambda: 2)
    assert guard.ratios() == {1: (2.44, 2.57), 2: (2.44, 2.57)}
    assert asked == [Case(bench.SLOPE_A, 1), Case(bench.SLOPE_A, 2)]


def test_table_has_a_line_a_measurement() -> None:
    case = Case(2000, ledger=True, stones=0.4)
    lines = report.table([measurement(case), measurement(replace(case, threads=2))]).splitlines()
    assert len(lines) == 3
    assert len({len(line) for line in lines}) == 1
    for text in ("2,014", "double", "ugimp", "usf", " on ", "40 %", "12.3", "11.0 ... 13.0"):
        assert text in lines[1]
    for text in ("5.1", "2.44", "2.57", "0.87", "6.2", "12 %", "240"):
        assert text in lines[1]


def test_text_says_everything() -> None:
    shown = report.text(results())
    for text in ("52", "104", "110", "L2 256 KiB", "ugimp 500", "12.3 %", "1.5e-07", "3.5e-07"):
        assert text in shown
    assert "extrapolated" in shown and "9.8 min on 1 thread, 5.0 min on 2 threads" in shown
    assert "4 slopes on 2 cores 19.6 min, 2 at a time" in shown


def test_results_as_json() -> None:
    data = json.loads(plain_data.dumps(results().to_dict()))
    assert set(data) == {"machine", "speeds", "output", "single", "study"}
    assert [row["threads"] for row in data["speeds"][:2]] == [1, 2]
    assert data["speeds"][0]["bytes_per_point"] == 240.4
    assert data["study"]["slope"]["1"] == pytest.approx(587.25)


def test_written_results(tmp_path: Path) -> None:
    report.write(results(), tmp_path)
    assert "of peak" in (tmp_path / "bench.txt").read_text()
    assert (tmp_path / "bench.png").stat().st_size > 20_000
