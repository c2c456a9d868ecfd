"""The claims of the paper are judged by the figures of the runs, and by what chance may do."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from gimpslope.studies.reproduce import claims, judging, sample
from gimpslope.studies.reproduce.measures import FIGURES, Measures

AS_TOLD = {
    "soil": {"peak_energy": 160.0, "peak_time": 1.6, "peak_speed": 3.4, "fast_share": 0.5},
    "arbitrary": {"peak_energy": 64.0, "peak_time": 2.0, "peak_speed": 2.5, "fast_share": 0.4},
    "round": {"peak_energy": 50.0, "peak_time": 1.5, "peak_speed": 2.4, "fast_share": 0.3},
    "oval": {"peak_energy": 30.0, "peak_time": 1.8, "peak_speed": 2.0, "fast_share": 0.2},
}
"""Figures as the paper has them, or in the order in which it has them."""

REST = {
    "soil": (4.0, 105.7, 1.0, (1, 1, 1), 0.5, 0.0, 0.3, 9.3, 8.9, 5.4, 0.5, 0.8, 5.0, 20.0),
    "arbitrary": (3.8, 112.4, 2.0, (4, 5, 6), 0.6, 0.0, 0.3, 8.7, 8.5, 5.0, 0.5, 0.8, 4.0, 90.0),
    "round": (4.1, 112.4, 1.0, (4, 5, 6), 0.4, 0.0, 0.4, 7.0, 6.8, 4.0, 0.8, 0.8, 3.0, 50.0),
    "oval": (4.0, 112.4, 0.8, (4, 5, 6), 0.3, 0.0, 0.6, 6.0, 5.8, 3.0, 0.8, 0.8, 2.0, 45.0),
}


def told(name: str) -> Measures:
    (rest, mass, late, bands, soil, stone, bottom) = REST[name][:7]
    (total, horizontal, vertical, near, far_front, run_out, rough) = REST[name][7:]
    early, peak, end = (float(count) for count in bands)
    return Measures(
        mass=mass,
        rest_time=rest,
        early_speed=1.2,
        late_speed=late,
        late_rear=0.0,
        early_bands=early,
        peak_bands=peak,
        late_bands=end,
        early_islands=early - 1,
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


METRES = judging.Form(2, "m")

BANDS = (
    "In slopes with stones several plastic bands interlace (here: at 1 s they enclose more islands "
    "than in the soil slope)."
)

PAPER = {name: [told(name)] for name in AS_TOLD}


@pytest.fixture(autouse=True)
def one_per_cent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every figure varies by 1 % from draw to draw."""
    monkeypatch.setattr(sample, "KNOWN", {"spread": dict.fromkeys(FIGURES, 0.01), "from": ""})


def verdicts(runs: judging.Draws) -> dict[str, str]:
    return {claim.text: judgement.verdict for claim, judgement in claims.judge(runs, chance(runs))}


def chance(runs: judging.Draws) -> Mapping[str, float]:
    return sample.spread_of([runs[name] for name in judging.STONES])


def verdict(part: judging.Part, runs: judging.Draws) -> str:
    return judging.judgement([part], runs, chance(runs)).verdict


def test_the_paper_holds_what_it_claims(monkeypatch: pytest.MonkeyPatch) -> None:
    little = {"spread": dict.fromkeys(FIGURES, 0.001), "from": ""}
    monkeypatch.setattr(sample, "KNOWN", little)
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
    ("oval", "found"),
    [
        (45.0, "holds"),
        (48.5, "one draw cannot tell"),
        (51.5, "one draw cannot tell"),
        (55.0, "does not"),
    ],
)
def test_chance_decides_between_slopes_with_stones(oval: float, found: str) -> None:
    """50 and 48.5 kJ/m differ by less than three times 1 % of both together, 2.1 kJ/m."""
    runs = PAPER | {"oval": [replace(PAPER["oval"][0], peak_energy=oval)]}
    peak = "The soil slope has the highest peak, then arbitrary, round and oval stones."
    assert verdicts(runs)[peak] == found


def test_chance_counts_against_numbers_too() -> None:
    """8.7 m within 0.2 m; three deviations of 1 % are 0.26 m."""
    part = judging.near("total", METRES, 8.7, 0.2, ("arbitrary",))
    soil = judging.near("total", METRES, 8.7, 0.2, ("soil",))
    for total, found in (
        (8.7, "one draw cannot tell"),
        (8.45, "one draw cannot tell"),
        (8.0, "does not"),
    ):
        runs = PAPER | {name: [replace(told(name), total=total)] for name in ("arbitrary", "soil")}
        assert verdict(part, runs) == found
        assert verdict(soil, runs) == ("holds" if total == 8.7 else "does not")
    twice = judging.ratio("peak_energy", judging.Form(0), "soil", "arbitrary", 2.5, 0.15)
    for energy, found in ((64.0, "holds"), (56.0, "one draw cannot tell"), (50.0, "does not")):
        runs = PAPER | {"arbitrary": [replace(told("arbitrary"), peak_energy=energy)]}
        assert verdict(twice, runs) == found


def test_five_draws_have_a_spread_of_their_own_and_fewer_do_not() -> None:
    def draws(name: str, count: int) -> list[Measures]:
        energies = (40.0, 45.0, 50.0, 55.0, 60.0)[:count]
        return [replace(told(name), peak_energy=energy) for energy in energies]

    kinds = [draws(name, 5) for name in judging.STONES]
    own = sample.spread_of(kinds)
    assert own["peak_energy"] == pytest.approx(62.5**0.5 / 50)
    found = sample.sample("peak_energy", kinds[0], own["peak_energy"])
    assert found.mean == 50.0 and found.draws == 5
    assert found.deviation == pytest.approx((62.5 / 5) ** 0.5)
    assert sample.spread_of([draws(name, 4) for name in judging.STONES])["peak_energy"] == 0.01
    runs = PAPER | {name: draws(name, 5) for name in judging.STONES}
    peak = judging.ordered("peak_energy", judging.Form(0), *judging.STONES)
    assert verdict(peak, runs) == "5 draws cannot tell"


def test_a_figure_of_unknown_spread_decides_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sample, "KNOWN", {"spread": {}, "from": ""})
    peak = judging.ordered("peak_energy", judging.Form(0), *judging.STONES)
    assert verdict(peak, PAPER) == "one draw cannot tell"


def test_the_known_spread_has_every_figure() -> None:
    known = json.loads((Path(sample.__file__).parent / "spread.json").read_text())
    assert set(known["spread"]) == set(FIGURES)
    assert all(0 <= share < 1 for name, share in known["spread"].items() if name != "late_rear")


def test_what_was_not_reached_is_not_judged() -> None:
    nan = float("nan")
    runs = {name: [replace(told(name), rest_time=nan, late_speed=nan)] for name in PAPER}
    found = verdicts(runs)
    unreached = [text for text, verdict in found.items() if verdict == "not reached"]
    assert len(unreached) == 3  # the duration, the deceleration, the speed at 3.5 s
    assert all(word in " ".join(unreached) for word in ("last", "slows down", "3.5 s"))


def test_figures_stand_beside_the_verdict() -> None:
    (_, judgement), *_ = claims.judge(PAPER, chance(PAPER))
    assert judgement.figures == (
        "soil 4.00 s, arbitrary 3.80 ± 0.04 s, round 4.10 ± 0.04 s, oval 4.00 ± 0.04 s"
    )


@pytest.mark.parametrize(
    ("form", "mean", "deviation", "shown"),
    [
        (judging.Form(1, "kJ/m"), 38.13, 2.67, "38.1 ± 2.7 kJ/m"),
        (judging.Form(1, "%", 100.0), 0.2718, 0.0142, "27.2 ± 1.4 %"),
        (judging.Form(1, "%", 100.0), 0.0001, 0.00008, "0.0 %"),
        (judging.Form(1, "t/m"), 112.3, 0.04, "112.3 t/m"),
        (judging.Form(0), 34.2, 1.4, "34 ± 1"),
        (judging.Form(2, "m"), 9.3, float("nan"), "9.30 m"),
        (judging.Form(2, "m"), float("nan"), float("nan"), "not reached"),
    ],
)
def test_deviations_are_in_the_unit_of_the_figure(
    form: judging.Form, mean: float, deviation: float, shown: str
) -> None:
    assert form.shown(sample.Sample(mean, 1, deviation)) == shown


def test_a_ratio_of_what_was_not_reached_is_left_out() -> None:
    twice = judging.ratio("peak_energy", judging.Form(1, "kJ/m"), "soil", "arbitrary", 2.5, 0.15)
    nothing = {"soil": [replace(told("soil"), peak_energy=float("nan"))]}
    assert judging.judgement([twice], PAPER | nothing, chance(PAPER)) == (
        "not reached",
        "soil not reached, arbitrary 64.0 ± 0.6 kJ/m",
    )
    assert judging.judgement([twice], PAPER, chance(PAPER)).figures.endswith(" kJ/m: 2.50")


def test_spread_is_the_deviation_between_draws() -> None:
    first = [replace(told("round"), peak_energy=value) for value in (90.0, 100.0, 110.0)]
    second = [replace(told("oval"), peak_energy=value) for value in (40.0, 50.0, 60.0)]
    found = sample.spread([first, second])
    assert found["peak_energy"] == pytest.approx(((0.1**2 + 0.2**2) / 2) ** 0.5)
    assert found["total"] == 0.0 and set(found) == set(FIGURES)
