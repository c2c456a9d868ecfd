"""Slopes of the study on several grids: what is run, judged and shown."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.colors import to_hex

import gimpslope as gs
from gimpslope import cli
from gimpslope.figures.grids import against_cell
from gimpslope.studies import reproduce
from gimpslope.studies.reproduce import claims, judging, refinement, tables
from gimpslope.studies.reproduce.measures import FIGURES, Measures

SPREAD = dict.fromkeys(FIGURES, 0.01)
PEAKS = "The soil slope has the highest peak, then arbitrary, round and oval stones."
CELLS = (0.2, 0.1, 0.05)


def measures(**figures: float) -> Measures:
    """A slope of which all figures are 1, but for these."""
    return replace(Measures(*(1.0,) * (len(FIGURES) - 3)), **figures)


def refined(rounds: Sequence[float], soil: float = 160.0) -> refinement.Refinement:
    """Soil and two draws of round stones with these peaks of kinetic energy on three grids."""
    grids = {
        cell: {
            "soil": [measures(peak_energy=soil)],
            "round": [measures(peak_energy=peak + 1), measures(peak_energy=peak - 1)],
        }
        for cell, peak in zip(CELLS, rounds, strict=True)
    }
    gaps = {"round": [(0.5, 0.25), (1.0, 0.5), (2.0, 1.0)]}
    return refinement.refinement(grids, gaps, SPREAD)


def survival(found: refinement.Refinement, text: str) -> refinement.Survival:
    (number,) = [n for n, claim in enumerate(claims.CLAIMS) if claim.text == text]
    return found.survivals[number]


@pytest.mark.parametrize(
    ("rounds", "verdict", "told"),
    [
        ((100.0, 110.0, 120.0), "survives", "holds at 0.2, 0.1, 0.05 m"),
        ((180.0, 110.0, 120.0), "survives", "does not at 0.2 m; holds at 0.1, 0.05 m"),
        ((180.0, 170.0, 120.0), "appears", "does not at 0.2, 0.1 m; holds at 0.05 m"),
        ((100.0, 170.0, 180.0), "does not survive", "holds at 0.2 m; does not at 0.1, 0.05 m"),
        ((170.0, 180.0, 190.0), "fails too", "does not at 0.2, 0.1, 0.05 m"),
        ((100.0, 100.0, 160.0), "cannot tell", "holds at 0.2, 0.1 m; 2 draws cannot tell at 0.05"),
        ((100.0, 100.0, float("nan")), "not reached", "not reached at 0.05 m"),
    ],
)
def test_a_claim_survives_what_the_finest_grids_say(
    rounds: Sequence[float], verdict: str, told: str
) -> None:
    found = survival(refined(rounds), PEAKS)
    assert found.verdict == verdict
    assert told in found.figures


def test_claims_about_other_slopes_are_not_judged() -> None:
    found = refined((100.0, 110.0, 120.0))
    for text in (
        "The peak of the soil slope is 2.5 times that with arbitrary stones (within 15 %).",
        "Among slopes with stones most soil yields with arbitrary, least with oval ones.",
    ):
        assert survival(found, text).verdict == "not run"


def test_one_slope_is_alike_to_nothing() -> None:
    alike = judging.alike("rest_time", judging.Form(0), 0.15, judging.SLOPES)
    assert judging.judgement([alike], {"soil": [measures()]}, SPREAD).verdict == "not run"


def test_order_skips_slopes_that_were_not_run() -> None:
    """Soil before round, though arbitrary ones stand between them."""
    order = judging.ordered("peak_energy", judging.Form(0), *judging.SLOPES)
    draws = {"soil": [measures(peak_energy=2.0)], "round": [measures(peak_energy=1.0)]}
    assert judging.judgement([order], draws, SPREAD).verdict == "holds"
    swapped = {"soil": draws["round"], "round": draws["soil"]}
    assert judging.judgement([order], swapped, SPREAD).verdict == "does not"


def test_limits_are_those_of_the_means() -> None:
    """Means of 100, 130 and 145 are of first order and end at 160."""
    found = refined((100.0, 130.0, 145.0))
    limit = found.limit("round", "peak_energy")
    assert limit is not None and limit.limit == pytest.approx(160.0)
    assert limit.orders == pytest.approx((1.0,))
    assert found.limit("soil", "peak_energy").limit == 160.0
    assert refined((100.0, float("nan"), 145.0)).limit("round", "peak_energy") is None


def test_the_picture_shows_draws_means_and_the_paper() -> None:
    ax = against_cell(CELLS, {"C round": [[1, 3], [2, 6], [4, 8]]}, reference={"C round": 5.0})
    mean, *draws, paper = ax.lines
    assert mean.get_ydata().tolist() == [2.0, 4.0, 6.0]
    assert [line.get_ydata().tolist() for line in draws] == [[1, 2, 4], [3, 6, 8]]
    assert set(paper.get_ydata()) == {5.0}
    assert len({to_hex(line.get_color()) for line in ax.lines}) == 1
    figure = refinement.figure(refined((100.0, 130.0, 145.0)))
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.texts] == [
        *("A soil", "C round", "A soil, the paper", "C round, the paper"),
        "A soil, the paper (more than)",
    ]


def test_a_slope_without_figures_is_in_no_legend() -> None:
    nothing = [[float("nan")]] * 3
    ax = against_cell(CELLS, {"A soil": nothing, "C round": [[1], [2], [3]]})
    assert ax.get_legend_handles_labels()[1] == ["C round"]
    assert to_hex(ax.lines[0].get_color()) == to_hex("C1")


def test_a_lower_bound_is_drawn_as_one() -> None:
    figure = refinement.figure(refined((100.0, 130.0, 145.0)))
    (bound,) = [
        line
        for ax in figure.axes
        for line in ax.lines
        if line.get_label() == "A soil, the paper (more than)"
    ]
    assert bound.axes.get_title() == "fastest point at the peak, m/s"
    assert set(bound.get_ydata()) == {3.0} and bound.get_linestyle() == ":"


def test_the_table_has_gaps_and_no_limits_of_counts() -> None:
    bands = dict(zip(CELLS, (0.0, 0.0, 1.0), strict=True))
    grids = {cell: {"round": [measures(peak_bands=count)]} for cell, count in bands.items()}
    found = refinement.refinement(grids, {"round": [(0.5, 0.25), (1.0, 0.5), (2.0, 1.0)]}, SPREAD)
    rows = [line.strip("| ").split(" | ") for line in tables.grids(found).splitlines()]
    by_figure = {figure: cells for _, figure, *cells in rows}
    assert found.limit("round", "peak_bands").behaviour == "diverges"
    assert by_figure["plastic bands at the peak"] == ["-", "0", "0", "1", "-"]
    assert by_figure["smallest gap between stones of each draw, cells"] == [
        *("-", "0.50, 0.25", "1.00, 0.50", "2.00, 1.00", "-")
    ]
    assert "smallest gap" not in tables.grids(replace(found, gaps={}))


def test_runs_on_the_grid_of_the_study_are_shared(tmp_path: Path) -> None:
    made = reproduce.plan(
        tmp_path,
        readings=["identified"],
        cell=0.2,
        seeds=[3],
        refined=("soil", "round"),
        cells=(0.4, 0.2, 0.1),
    )
    files = [str(run.path.relative_to(tmp_path)) for run in made.runs]
    assert len(files) == len(set(files)) == 4 + 1 + 2 + 2 * 2
    assert files[:2] == ["cell_0.1/identified_round_3.h5", "cell_0.1/identified_round_4.h5"]
    assert "identified_round_4.h5" in files
    assert files[-1] == "cell_0.4/identified_soil.h5"
    assert {slope.seeds for slope in made.refined} == {(3,), (3, 4)}
    five = reproduce.plan(
        tmp_path,
        readings=["literal"],
        cell=0.2,
        seeds=range(5),
        refined=["oval"],
        cells=(0.2, 0.1, 0.05),
    )
    assert [slope.seeds for slope in five.refined] == [(0, 1)] * 3
    assert not any(tmp_path.iterdir())


def test_page_figures_and_resumption(tmp_path: Path) -> None:
    words = [
        *("reproduce", "--cell", "0.2", "--stone-modulus", "3e7", "--duration", "0.6", "--quiet"),
        *("--reading", "identified", "--convergence", "--cells", "0.8", "0.4", "0.2"),
        *("--jobs", "2", "--output", str(tmp_path / "grids")),
    ]
    assert cli.main(words) == 0
    page = (tmp_path / "grids" / "summary.md").read_text()
    assert "`identified`, soil, round at 0.8, 0.4, 0.2 m" in page
    assert page.count("**not run**: it compares other slopes") == 7
    assert "| slope | figure | paper | h = 0.8 m | h = 0.4 m | h = 0.2 m | limit |" in page
    assert "](identified/figure_grids.png)" in page
    assert (tmp_path / "grids" / "identified" / "figure_grids.png").stat().st_size > 10_000
    measured = json.loads((tmp_path / "grids" / "figures.json").read_text())
    gaps = [
        f"{gs.open(path).summary['smallest_gap_in_cells']:.2f}"
        for path in sorted((tmp_path / "grids").glob("*round_[12].h5"))
    ]
    assert "of each draw, cells | - | " in page and f" | {', '.join(gaps)} | - |" in page
    on_grids = measured["grids"]["identified"]
    assert [len(on_grids[cell]["round"]) for cell in ("0.8", "0.4", "0.2")] == [2, 2, 2]
    assert on_grids["0.2"]["soil"] == [measured["identified"]["identified_soil"]]
    made = {run: run.stat().st_mtime_ns for run in (tmp_path / "grids").rglob("*.h5")}
    assert cli.main(words) == 0
    assert all(run.stat().st_mtime_ns == before for run, before in made.items())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--cells 0.2 0.1 0.05", "--cells must be given with --convergence"),
        ("--convergence --cells 0.2 0.1", "cells must be three or more"),
        ("--convergence --cells 0.2 0.1 0.06", "each half of the one before"),
    ],
)
def test_refusals(words: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["reproduce", "--output", "never", *words.split()]) == 2
    assert message in capsys.readouterr().err
    assert not Path("never").exists()


def test_a_slope_of_no_such_name(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        cli.main(["reproduce", "--convergence", "square"])
    assert "square" in capsys.readouterr().err
