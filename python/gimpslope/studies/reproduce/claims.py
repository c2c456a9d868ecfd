"""What the paper says of its slopes, and whether the runs bear it out.

A claim that compares slopes holds, or does not, if they differ by more than the chance of the draw
explains (see `sample`); otherwise the draws cannot tell. A claim that gives a number is met within
a tolerance that it states.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Literal, NamedTuple

from .measures import Measures
from .sample import Sample, difference, sample

Verdict = Literal["holds", "does not", "one draw cannot tell", "not reached"]
Runs = Mapping[str, Sequence[Measures]]
"""The draws of each slope by its name: soil, arbitrary, round, oval."""

SOIL, STONES = "soil", ("arbitrary", "round", "oval")
SLOPES = (SOIL, *STONES)
_SHARE, _METRES = "{:.1%}", "{:.2f} m"


class Judgement(NamedTuple):
    """A verdict, and the figures from which it follows."""

    verdict: Verdict
    figures: str


class Claim(NamedTuple):
    """What the paper says, where, and how the runs judge it."""

    section: str
    text: str
    judge: Callable[[Runs], Judgement]


def judge(runs: Runs) -> list[tuple[Claim, Judgement]]:
    """Every claim with its judgement, in the order of the paper."""
    return [(claim, claim.judge(runs)) for claim in CLAIMS]


def _samples(runs: Runs, figure: str, slopes: Sequence[str]) -> dict[str, Sample]:
    return {name: sample(figure, runs[name], drawn=name in STONES) for name in slopes}


def _ordered(figure: str, form: str, *order: str | Sequence[str]) -> Callable[[Runs], Judgement]:
    """Each slope, or each of a group, has a larger figure than every one of the next group."""
    groups = [(group,) if isinstance(group, str) else tuple(group) for group in order]

    def judge(runs: Runs) -> Judgement:
        found = _samples(runs, figure, [name for group in groups for name in group])
        signs = [
            difference(found[larger], found[smaller])
            for before, after in pairwise(groups)
            for larger in before
            for smaller in after
        ]
        return Judgement(_verdict(found, signs), _shown(found, form))

    return judge


def _alike(
    figure: str, form: str, share: float, slopes: Sequence[str]
) -> Callable[[Runs], Judgement]:
    """The slopes differ from their mean by at most a share of it."""

    def judge(runs: Runs) -> Judgement:
        found = _samples(runs, figure, slopes)
        mean = sum(one.mean for one in found.values()) / len(found)
        near = all(abs(one.mean - mean) <= share * mean for one in found.values())
        return Judgement(_verdict(found, [1 if near else -1]), _shown(found, form))

    return judge


def _each(
    figure: str, form: str, test: Callable[[float], bool], slopes: Sequence[str]
) -> Callable[[Runs], Judgement]:
    """The figure of every one of the slopes passes a test."""

    def judge(runs: Runs) -> Judgement:
        found = _samples(runs, figure, slopes)
        signs = [1 if test(one.mean) else -1 for one in found.values()]
        return Judgement(_verdict(found, signs), _shown(found, form))

    return judge


def _ratio(
    figure: str, form: str, larger: str, smaller: str, ratio: float, share: float
) -> Callable[[Runs], Judgement]:
    """The figure of one slope is that of another times a ratio, within a share of it."""

    def judge(runs: Runs) -> Judgement:
        found = _samples(runs, figure, (larger, smaller))
        here = found[larger].mean / found[smaller].mean
        sign = 1 if abs(here - ratio) <= share * ratio else -1
        return Judgement(_verdict(found, [sign]), f"{_shown(found, form)}: {here:.2f}")

    return judge


def _all_of(*judges: Callable[[Runs], Judgement]) -> Callable[[Runs], Judgement]:
    """Several together: the worst verdict counts."""

    def judge(runs: Runs) -> Judgement:
        found = [one(runs) for one in judges]
        worst = next(v for v in _FROM_WORST if any(one.verdict == v for one in found))
        return Judgement(worst, "; ".join(one.figures for one in found))

    return judge


_FROM_WORST: tuple[Verdict, ...] = ("not reached", "does not", "one draw cannot tell", "holds")


def _verdict(found: Mapping[str, Sample], signs: Sequence[int]) -> Verdict:
    if any(one.mean != one.mean for one in found.values()):  # NaN
        return "not reached"
    if min(signs) < 0:
        return "does not"
    return "holds" if min(signs) > 0 else "one draw cannot tell"


def _shown(found: Mapping[str, Sample], form: str) -> str:
    return ", ".join(f"{name} {form.format(one.mean)}" for name, one in found.items())


CLAIMS = (
    Claim(
        "kinetic energy",
        "All four slides last the same time, about 4 s (within 15 %).",
        _all_of(
            _alike("rest_time", "{:.2f} s", 0.15, SLOPES),
            _each("rest_time", "{:.2f} s", lambda t: abs(t - 4) <= 0.6, SLOPES),
        ),
    ),
    Claim(
        "kinetic energy",
        "The slope with round stones accelerates for the shortest time, that with arbitrary ones "
        "for the longest.",
        _ordered("peak_time", "{:.2f} s", "arbitrary", (SOIL, "oval"), "round"),
    ),
    Claim(
        "kinetic energy",
        "The slope with round stones slows down for the longest time, that with arbitrary ones for "
        "the shortest.",
        _ordered("deceleration", "{:.2f} s", "round", (SOIL, "oval"), "arbitrary"),
    ),
    Claim(
        "kinetic energy",
        "The soil slope has the highest peak, then arbitrary, round and oval stones.",
        _ordered("peak_energy", "{:.1f} kJ/m", SOIL, *STONES),
    ),
    Claim(
        "kinetic energy",
        "The peak of the soil slope is 2.5 times that with arbitrary stones (within 15 %).",
        _ratio("peak_energy", "{:.1f} kJ/m", SOIL, "arbitrary", 2.5, 0.15),
    ),
    Claim(
        "kinetic energy",
        "The soil slope is lighter than those with stones.",
        _ordered("mass", "{:.1f} t/m", STONES, SOIL),
    ),
    Claim(
        "speed",
        "At 0.5 s the fastest points of all slopes are equally fast (within 5 %).",
        _alike("early_speed", "{:.2f} m/s", 0.05, SLOPES),
    ),
    Claim(
        "speed",
        "At the peak the soil slope is the fastest, above 3 m/s, and that with oval stones the "
        "slowest.",
        _all_of(
            _ordered("peak_speed", "{:.2f} m/s", SOIL, ("arbitrary", "round"), "oval"),
            _each("peak_speed", "{:.2f} m/s", lambda v: v > 3, (SOIL,)),
        ),
    ),
    Claim(
        "speed",
        "At the peak most moves fast (here: share of the mass above 1 m/s) in the soil slope, then "
        "with arbitrary stones, least with oval ones.",
        _ordered("fast_share", _SHARE, SOIL, "arbitrary", ("round",), "oval"),
    ),
    Claim(
        "speed",
        "At 3.5 s the slope with arbitrary stones is the fastest, at 2 m/s (within 15 %).",
        _all_of(
            _ordered("late_speed", "{:.2f} m/s", "arbitrary", (SOIL, "round", "oval")),
            _each("late_speed", "{:.2f} m/s", lambda v: abs(v - 2) <= 0.3, ("arbitrary",)),
        ),
    ),
    Claim(
        "speed",
        "And only its front is above 1 m/s then (here: 90 % of the mass so fast is in the front "
        "quarter).",
        _each("late_front", _SHARE, lambda share: share >= 0.9, ("arbitrary",)),
    ),
    Claim(
        "plastic zone",
        "The plastic zone of the soil slope is one, from 1 s to 5 s.",
        _all_of(
            *(
                _each(f"{time}_bands", "{:.0f}", lambda bands: bands == 1, (SOIL,))
                for time in ("early", "peak", "late")
            )
        ),
    ),
    Claim(
        "plastic zone",
        "In slopes with stones several plastic bands interlace (here: at 1 s they enclose more "
        "islands than in the soil slope).",
        _ordered("early_islands", "{:.0f}", STONES, SOIL),
    ),
    Claim(
        "plastic zone",
        "The bands go around the stones (here: a tenth as much of the stones is plastic as of the "
        "soil, or less).",
        _each("stone_over_soil", "{:.3f}", lambda ratio: ratio <= 0.1, STONES),
    ),
    Claim(
        "plastic zone",
        "Among slopes with stones most soil yields with arbitrary, least with oval ones.",
        _ordered("plastic_soil", _SHARE, "arbitrary", "round", "oval"),
    ),
    Claim(
        "plastic zone",
        "With oval stones much of the bottom stays without plastic strain (here: more of the "
        "lowest 2 m than in any other slope).",
        _ordered("bottom_intact", _SHARE, "oval", (SOIL, "arbitrary", "round")),
    ),
    Claim(
        "displacement",
        "The soil slope moves farthest: 9.3 m, 8.9 m horizontally and 5.4 m vertically (labels put "
        "right; within 0.2 m).",
        _all_of(
            _ordered("total", _METRES, SOIL, STONES),
            _each("total", _METRES, lambda u: abs(u - 9.3) <= 0.2, (SOIL,)),
            _each("horizontal", _METRES, lambda u: abs(u - 8.9) <= 0.2, (SOIL,)),
            _each("vertical", _METRES, lambda u: abs(u - 5.4) <= 0.2, (SOIL,)),
        ),
    ),
    Claim(
        "displacement",
        "The largest horizontal displacement is nearly the total one (labels put right; at least "
        "90 % of it).",
        _each("sideways", _SHARE, lambda share: share >= 0.9, SLOPES),
    ),
    Claim(
        "displacement",
        "With oval stones the slope moves least, then with round ones, and of the three farthest "
        "with arbitrary ones, 8.7 m (within 0.2 m).",
        _all_of(
            _ordered("total", _METRES, *STONES),
            _each("total", _METRES, lambda u: abs(u - 8.7) <= 0.2, ("arbitrary",)),
        ),
    ),
    Claim(
        "displacement",
        "With round and oval stones most moves by less than 2 m, more of it than in the other "
        "slopes.",
        _all_of(
            _each("near_share", _SHARE, lambda share: share > 0.5, ("round", "oval")),
            _ordered("near_share", _SHARE, ("round", "oval"), (SOIL, "arbitrary")),
        ),
    ),
    Claim(
        "displacement",
        "What moves by more than 4 m is in the front (here: 75 % of it in the front quarter).",
        _each("far_front", _SHARE, lambda share: share >= 0.75, SLOPES),
    ),
    Claim(
        "final shape",
        "The surface is smoothest in the soil slope, then with round and oval stones, and uneven "
        "with arbitrary ones.",
        _ordered("roughness", "{:.0f} mm", "arbitrary", ("round", "oval"), SOIL),
    ),
    Claim(
        "conclusion",
        "The homogeneous slope slides out farther than those with stones.",
        _ordered("run_out", _METRES, SOIL, STONES),
    ),
    Claim(
        "conclusion",
        "With large stones less soil yields than with small ones (here: round and oval against "
        "arbitrary ones, among which are small ones).",
        _ordered("plastic_soil", _SHARE, "arbitrary", ("round", "oval")),
    ),
)
