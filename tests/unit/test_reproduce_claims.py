"""The claims of the paper are judged by the figures of the runs, and by what chance may do."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gimpslope.studies.reproduce import claims, sample
from gimpslope.studies.reproduce.measures import FIGURES, Measures

AS_TOLD = {
    "soil": {"peak_energy": 160.0, "peak_time": 1.6, "peak_speed": 3.4, "fast_share": 0.5},
    "arbitrary": {"peak_energy": 64.0, "peak_time": 2.0, "peak_speed": 2.5, "fast_share": 0.4},
    "round": {"peak_energy": 50.0, "peak_time": 1.5, "peak_speed": 2.4, "fast_share": 0.3},
    "oval": {"peak_energy": 30.0, "peak_time": 1.8, "peak_speed": 2.0, "fast_share": 0.2},
}
"""Figures as the paper has them, or in the order in which it has them."""

REST = {
    "soil": (4.0, 105.7, 1.0, 0.9, (1, 1, 1), 0.5, 0.0, 0.3, 9.3, 8.9, 5.4, 0.5, 0.8, 5.0, 20.0),
    "arbitrary": (
        3.8,
        112.4,
        2.0,
        0.95,
        (4, 5, 6),
        0.6,
        0.0,
        0.3,
        8.7,
        8.5,
        5.0,
        0.5,
        0.8,
        4.0,
        90.0,
    ),
    "round": (4.1, 112.4, 1.0, 0.9, (4, 5, 6), 0.4, 0.0, 0.4, 7.0, 6.8, 4.0, 0.8, 0.8, 3.0, 50.0),
    "oval": (4.0, 112.4, 0.8, 0.9, (4, 5, 6), 0.3, 0.0, 0.6, 6.0, 5.8, 3.0, 0.8, 0.8, 2.0, 45.0),
}


def told(name: str) -> Measures:
    (rest, mass, late, late_front, bands, soil, stone, bottom) = REST[name][:8]
    (total, horizontal, vertical, near, far_front, run_out, rough) = REST[name][8:]
    early, peak, end = (float(count) for count in bands)
    return Measures(
        mass=mass,
        rest_time=rest,
        early_speed=1.2,
        late_speed=late,
        late_front=late_front,
        early_bands=early,
        peak_bands=peak,
        late_bands=end,
        early_islands=early - 1,
        peak_islands=peak - 1,
        late_islands=end - 1,
        plastic_soil=soil,
        plastic_stone=stone,
        bottom_intact=bottom,
        total=total,
        horizontal=horizontal,
        vertical=vertical,
        near_share=near,
        far_front=far_front,
        run_out=run_out,
        roughness=rough,
        **AS_TOLD[name],
    )


BANDS = (
    "In slopes with stones several plastic bands interlace (here: at 1 s they enclose more islands "
    "than in the soil slope)."
)

PAPER = {name: [told(name)] for name in AS_TOLD}


@pytest.fixture(autouse=True)
def chance(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every figure varies by 1 % from draw to draw."""
    monkeypatch.setattr(sample, "SPREAD", dict.fromkeys(FIGURES, 0.01))


def verdicts(runs: claims.Runs) -> dict[str, str]:
    return {claim.text: judgement.verdict for claim, judgement in claims.judge(runs)}


def test_the_paper_holds_what_it_claims() -> None:
    assert set(verdicts(PAPER).values()) == {"holds"}


def test_runs_that_are_all_like_the_soil_contradict_comparisons() -> None:
    alike = dict.fromkeys(PAPER, PAPER["soil"])
    found = verdicts(alike)
    peak = "The soil slope has the highest peak, then arbitrary, round and oval stones."
    assert found[peak] == "one draw cannot tell"
    assert (
        found["The peak of the soil slope is 2.5 times that with arbitrary stones (within 15 %)."]
        == "does not"
    )
    assert found[BANDS] == "one draw cannot tell"


@pytest.mark.parametrize(
    ("oval", "verdict"),
    [
        (45.0, "holds"),
        (49.0, "one draw cannot tell"),
        (51.0, "one draw cannot tell"),
        (55.0, "does not"),
    ],
)
def test_chance_decides_between_slopes_with_stones(oval: float, verdict: str) -> None:
    """50 and 49 kJ/m differ by less than twice 1 % of both together, 1.4 kJ/m."""
    runs = PAPER | {"oval": [replace(PAPER["oval"][0], peak_energy=oval)]}
    peak = "The soil slope has the highest peak, then arbitrary, round and oval stones."
    assert verdicts(runs)[peak] == verdict


def test_several_draws_have_their_own_spread() -> None:
    draws = [replace(told("round"), peak_energy=value) for value in (40.0, 50.0, 60.0)]
    found = sample.sample("peak_energy", draws, drawn=True)
    assert found.mean == 50.0 and found.draws == 3
    assert found.deviation == pytest.approx(10.0 / 3**0.5)
    one = sample.sample("peak_energy", draws[:1], drawn=True)
    assert one.deviation == pytest.approx(0.4)
    soil = sample.sample("peak_energy", draws[:1], drawn=False)
    assert soil.deviation == 0.0
    assert sample.difference(found, sample.Sample(38.0, 0, 0.0)) == 1
    assert sample.difference(found, sample.Sample(39.0, 0, 0.0)) == 0
    assert sample.difference(sample.Sample(38.0, 0, 0.0), found) == -1


def test_what_was_not_reached_is_not_judged() -> None:
    nan = float("nan")
    runs = {name: [replace(told(name), rest_time=nan, late_speed=nan)] for name in PAPER}
    found = verdicts(runs)
    unreached = [text for text, verdict in found.items() if verdict == "not reached"]
    assert len(unreached) == 3
    assert all(word in " ".join(unreached) for word in ("last", "slows down", "3.5 s"))


def test_figures_stand_beside_the_verdict() -> None:
    (_, judgement), *_ = claims.judge(PAPER)
    assert "soil 4.00 s, arbitrary 3.80 s, round 4.10 s, oval 4.00 s" in judgement.figures


def test_spread_is_the_deviation_between_draws() -> None:
    first = [replace(told("round"), peak_energy=value) for value in (90.0, 100.0, 110.0)]
    second = [replace(told("oval"), peak_energy=value) for value in (40.0, 50.0, 60.0)]
    found = sample.spread([first, second])
    assert found["peak_energy"] == pytest.approx(((0.1**2 + 0.2**2) / 2) ** 0.5)
    assert found["total"] == 0.0 and set(found) == set(FIGURES)
