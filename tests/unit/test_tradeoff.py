"""Error against cost: what is measured, how a sweep goes on where it was stopped, which cases are
worth their cost, and what the page says of them."""

from __future__ import annotations

import csv
import json
import math
import re
import signal
import warnings
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any, get_args

import pytest

import gimpslope as gs
from gimpslope import cli, interrupts, kernel
from gimpslope.method import DomainUpdate, Precision, Scheme
from gimpslope.studies import tradeoff
from gimpslope.studies.tradeoff import pareto, problems, rows, summary, words
from gimpslope.studies.tradeoff.measure import Measured, Task, measured, missing, run, sweep
from gimpslope.studies.tradeoff.plan import Case, Plan, alone, cases, every, is_allowed, plan

BAR = problems.PROBLEMS["bar"]
LONGER = (("courant", 0.8),)
FEW = Plan((BAR,), (Case("bar", 5.0), Case("bar", 2.5), Case("bar", 5.0, LONGER)), rounds=2)
NOTEBOOKS = Path(__file__).parents[2] / "notebooks"


def made(error: float, cost: float, cell: float = 1.0, **changed: Any) -> Measured:
    case = Case("bar", cell, tuple(changed.items()))
    return Measured(case, error, cost, 0.9 * cost, 1.1 * cost, 3, "")


@pytest.mark.parametrize("quick", [False, True])
def test_every_choice_of_the_method_is_measured(quick: bool) -> None:
    methods = [case.method for case in cases(BAR, quick=quick)]
    assert {method.shape for method in methods} == set(kernel.shapes())
    assert {method.scheme for method in methods} == set(get_args(Scheme))
    assert {method.precision for method in methods} == set(get_args(Precision))
    assert {method.domain_update for method in methods} == {None, *get_args(DomainUpdate)}
    assert {method.step[1] for method in methods} >= {0.4, 0.8}
    assert {method.blend for method in methods} >= {("alpha", 0.01), ("alpha", 0.0)}


def test_each_case_is_planned_once_and_each_grid_has_the_default() -> None:
    for problem in problems.PROBLEMS.values():
        found = cases(problem)
        assert len(set(found)) == len(found)
        defaults = [case.cell for case in found if case.is_default]
        assert set(defaults) >= {*problem.cells, *problem.fine}
        assert defaults == sorted(defaults, reverse=True)


@pytest.mark.parametrize("problem", problems.PROBLEMS.values(), ids=problems.PROBLEMS)
def test_methods_are_those_that_materials_get_by_themselves(problem: problems.Problem) -> None:
    soil = gs.DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
    left = replace(problem.method, volumetric_strain=None)
    assert problem.method == left.of([soil if problem.yields else soil.elastic()])


def test_parameters_that_exclude_each_other_are_left_out() -> None:
    twice = (("viscosity", 0.1), ("alpha", 0.1))
    nonsense = replace(BAR, only=({}, dict(twice)))
    assert cases(nonsense) == [Case("bar", cell) for cell in BAR.cells] + [
        case for case in cases(nonsense) if case.cell in BAR.fine
    ]


HATS_WITH_APIC = {"shape": "linear", "transfer": "apic", "courant": 0.8}


@pytest.mark.parametrize("problem", problems.PROBLEMS.values(), ids=problems.PROBLEMS)
def test_nothing_else_is_left_out(problem: problems.Problem) -> None:
    wanted = [
        *(problem.only or [*every(problem), *alone(problem, longer=True)]),
        *chain(*problem.dear.values()),
    ]
    refused = [
        changes
        for changes in wanted
        if not is_allowed(Case(problem.name, problem.cells[0], tuple(changes.items())))
    ]
    told = [{name: one for name, one in each.items() if one is not None} for each in refused]
    assert told == ([] if problem.only else [HATS_WITH_APIC])


def test_sweep_in_rounds_that_goes_on_where_it_was_stopped(tmp_path: Path) -> None:
    assert missing(FEW, tmp_path) == 6
    runs = sweep(FEW, tmp_path)
    first = [next(runs) for _ in range(4)]
    assert [row.case for row in first] == [*FEW.cases, FEW.cases[0]]
    assert [row.round for row in first] == [1, 1, 1, 2]
    runs.close()
    assert missing(FEW, tmp_path) == 2


def test_a_cut_off_line_costs_no_more_than_its_run(tmp_path: Path) -> None:
    whole = list(sweep(FEW, tmp_path))
    file = tmp_path / rows.NAME
    file.write_text(file.read_text()[:-9])
    assert missing(FEW, tmp_path) == 1
    again = list(sweep(FEW, tmp_path))
    assert [(row.case, row.round) for row in again] == [(whole[-1].case, 2)]
    assert missing(FEW, tmp_path) == 0
    for one in measured(FEW, tmp_path):
        assert one.rounds == 2 and one.fastest <= one.core_seconds <= one.slowest
        assert 0 < one.core_seconds < 10


def test_methods_that_fail_on_purpose_are_not_warned_of() -> None:
    usl = Case("slope_a", 0.8, (("scheme", "usl"), ("courant", 0.8)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert run(Task(usl, 1)).case == usl


def test_runs_of_another_version_or_method_do_not_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = replace(FEW, cases=FEW.cases[:1])
    list(sweep(one, tmp_path))
    other = replace(FEW, cases=(Case("bar", 5.0, (("alpha", 0.02),)),))
    assert missing(other, tmp_path) == 2
    monkeypatch.setattr(rows, "version", lambda _: "another")
    assert missing(one, tmp_path) == 2


def test_two_jobs_make_the_same_errors_as_one(tmp_path: Path) -> None:
    for name, jobs in (("one", 1), ("two", 2)):
        (tmp_path / name).mkdir()
        list(sweep(replace(FEW, rounds=1), tmp_path / name, jobs=jobs))
    found = [[one.error for one in measured(FEW, tmp_path / name)] for name in ("one", "two")]
    assert found[0] == found[1]


def test_a_sweep_that_is_stopped_keeps_the_runs_that_are_going(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), interrupts.terminable():
        for _ in sweep(FEW, tmp_path, jobs=2):
            signal.raise_signal(signal.SIGTERM)
    assert missing(FEW, tmp_path) == 6 - 2


def test_a_run_that_fails_is_told_and_not_repeated(tmp_path: Path) -> None:
    torn = Case("aluminium_bars", 0.01, (("shape", "cpgimp"), ("domain_update", "stretch")))
    fails = Plan((problems.PROBLEMS["aluminium_bars"],), (torn,), rounds=2)
    assert len(list(sweep(fails, tmp_path))) == 1
    (one,) = measured(fails, tmp_path)
    assert math.isinf(one.error) and "domain of point" in one.failure
    assert missing(fails, tmp_path) == 0
    assert pareto.front([one]) == []


def test_error_of_the_bar_falls_as_the_square_of_the_cell() -> None:
    errors = [BAR.solve(cell, BAR.method, None).error for cell in (1.25, 0.625)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.5), "finite strains are 1 %"


def test_errors_that_a_finer_grid_takes_back_do_not_hold() -> None:
    lucky, fine = made(0.001, 1.0, cell=2.0), made(0.03, 8.0, cell=1.0)
    other = made(0.02, 1.0, cell=2.0, courant=0.8)
    assert pareto.held([lucky, fine, other]) == {lucky: 0.03, fine: 0.03, other: 0.02}


def test_front_and_cheapest() -> None:
    cheap, better, near = made(0.2, 1.0, alpha=0.1), made(0.05, 2.0, alpha=0.2), made(0.046, 3.0)
    dear, failed = made(0.01, 9.0, alpha=0.3), made(math.inf, math.nan, alpha=0.4)
    worse = made(0.06, 4.0, alpha=0.5)
    every = [failed, dear, near, worse, better, cheap]
    assert pareto.front(every) == [cheap, better, dear]
    assert pareto.cheapest(every, 0.05) is better
    assert pareto.cheapest(every, 0.001) is None


def page(found: Sequence[Measured], known_to: float = 0.0) -> str:
    return summary.markdown(Plan((replace(BAR, known_to=known_to),), (), rounds=3), found)


def test_page_tells_what_to_choose() -> None:
    found = [made(0.15, 2.0, cell=2.0), made(0.08, 8.0), made(0.05, 1.0, cell=2.0, courant=0.8)]
    found.append(made(0.015, 4.0, courant=0.8))
    text = page(found)
    assert (
        "* **10 %**: uGIMP, C = 0.8, h = 2 m: 5 % in 1 s (0.9 to 1.1); the default needs h = 1 m "
        "and 8 times as long." in text
    )
    assert "**2 %**: uGIMP, C = 0.8, h = 1 m: 1.5 % in 4 s (3.6 to 4.4), finest; the def" in text
    assert "* **0.5 %**: no case reaches it; the nearest is uGIMP, C = 0.8, h = 1 m: 1.5 %" in text
    assert (
        "* **10 %**: uGIMP, C = 0.8 reaches it in 1 of the 1 problems in which any method does, "
        "at 1 times the cost of the cheapest there; uGIMP (default) reaches it in 1 of the 1 "
        "problems in which any method does, at 8 times" in text
    )
    assert (
        "uGIMP (default) reaches it in 0 of the 1 problems in which any method does. It can be "
        "told of 1 of 1 problems." in text
    )


def test_page_tells_what_each_choice_does_alone() -> None:
    found = [made(0.1, 2.0, cell=2.0), made(0.03, 8.0)]
    found += [made(0.2, 1.0, cell=2.0, courant=0.8), made(0.03, 4.0, courant=0.8)]
    found += [made(0.01, 4.0, cell=2.0, precision="single"), made(math.inf, 1.0, shape="linear")]
    lines = page(found, known_to=0.05).splitlines()
    assert "| uGIMP, C = 0.8 | 0.50 | 1.41 |" in lines, "0.03 counts as 0.05: (2 * 1)^(1/2)"
    assert "| uGIMP, single precision | 2.00 | 0.50 |" in lines
    assert "| linear MPM | - | fails |" in lines
    assert "| uGIMP, C = 0.2 | - | - |" in lines


def test_page_claims_nothing_below_what_is_known() -> None:
    text = page([made(0.001, 1.0)], known_to=0.03)
    assert (
        "* **10 %**: uGIMP (default), h = 1 m: 0.1 % in 1 s (0.9 to 1.1), finest, the default."
        in text
    )
    assert "* **2 %**: cannot be told, for the answer is known to 3 %." in text
    assert "* **2 %**: cannot be told" in page([made(0.001, 1.0)], known_to=0.02)
    assert "* **2 %**: cannot be told of any of the problems." in text


def test_words() -> None:
    changed = {"shape": "cpgimp", "domain_update": "deformation_diagonal", "viscosity": None}
    assert words.changes({**changed, "alpha": 0.0}) == "cpGIMP (deformation diagonal), alpha = 0"
    assert words.changes({"precision": "single"}) == "uGIMP, single precision"
    assert words.changes({"scheme": "musl", "transfer": "apic"}) == "uGIMP, MUSL, APIC"


@pytest.mark.skipif(not NOTEBOOKS.exists(), reason="no source tree")
def test_slope_a_is_held_against_the_limits_that_converge_found() -> None:
    text = (NOTEBOOKS / "convergence" / "convergence.md").read_text().split("## Slope A")[1]
    names = (
        "peak kinetic energy, kJ/m",
        "time of peak kinetic energy, s",
        "largest vertical displacement, m",
    )
    found = [re.search(rf"{name} \|.*\| ([\d.]+) ± ([\d.]+) \|", text) for name in names]
    assert all(found)
    limits, uncertainties = zip(*(map(float, one.groups()) for one in found if one), strict=True)
    for known, told in (
        (problems.SLOPE_A, limits),
        (problems.UNCERTAINTY_A, uncertainties),
    ):
        assert (known.energy / 1e3, known.time, known.displacement) == told


def test_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    monkeypatch.chdir(tmp_path)
    small = replace(BAR, only=({}, {"courant": 0.8}))
    monkeypatch.setitem(problems.PROBLEMS, "bar", small)
    assert (
        cli.main(["tradeoff", "bar", "--quick", "--jobs", "1", "--quiet", "--output", "chart"]) == 0
    )
    assert "charts, table and summary: chart" in capsys.readouterr().out
    folder = tmp_path / "chart"
    names = {path.name for path in folder.iterdir()}
    assert names == {"runs.jsonl", "summary.md", "overview.png", "bar.csv", "bar.png"}
    assert len((folder / "runs.jsonl").read_text().splitlines()) == 8
    with (folder / "bar.csv").open() as file:
        table = list(csv.DictReader(file))
    assert [row["method"] for row in table] == ["uGIMP (default)", "uGIMP, C = 0.8"] * 2
    assert json.loads(table[1]["changes"]) == {"courant": 0.8}
    assert all(float(row["error_that_holds"]) >= float(row["error"]) > 0 for row in table)
    assert "True" in {row["on_front"] for row in table}


@pytest.mark.parametrize("given", ["pendulum", "bar --jobs 0", "bar --output taken"])
def test_command_refuses(
    given: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("taken").write_text("a file")
    assert cli.main(["tradeoff", *given.split()]) == 2
    assert "must be" in capsys.readouterr().err
    assert not Path("tradeoff").exists()


def test_quick_sweep_takes_two_grids_of_each_problem() -> None:
    quick = plan(quick=True)
    for problem in tradeoff.PROBLEMS.values():
        assert {case.cell for case in quick.cases if case.problem == problem.name} == set(
            problem.cells[:2]
        )


def test_page_tells_kinds_of_problems_and_models_of_stones_apart() -> None:
    with_stone = problems.PROBLEMS["with_stone"]
    found = [made(0.05, 1.0)]
    for model, error, cost in (("deformable", 0.12, 8.0), ("softened", 0.12, 2.0)):
        case = Case("with_stone", 0.1, (), model)
        found.append(Measured(case, error, cost, cost, cost, 1, ""))
    text = summary.markdown(Plan((BAR, with_stone), (), rounds=3), found)
    elastic, yielding = text.split("## Elastic problems")[1].split("## Problems that yield")
    assert "* **10 %**: uGIMP (default) reaches it in 1 of the 1 problems" in elastic
    assert "* **10 %**: no case of any problem reaches it." in yielding
    assert "| softened stone | 0.25 | - | 1.00 |" in text
    assert "the nearest is uGIMP (default), deformable stone, h = 0.1 m: 12 %" in text
