"""How a claim of the paper is judged by the runs: what it compares, and what chance may do to that.

Each part of a claim comes down to margins, numbers that must be positive, with the standard
deviation that the draw of the stones gives them. A margin decides if it is larger than `DEVIATIONS`
of these, one way or the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from .measures import Measures
from .sample import Sample, sample

Draws = Mapping[str, Sequence[Measures]]
"""The draws of each slope by its name: soil, arbitrary, round, oval, or some of them."""

DEVIATIONS = 3.0
"""By how many standard deviations a margin must differ from nothing. With a spread known from 15
draws of three kinds (12 degrees of freedom) chance does so in 1 % of all cases, and a claim may
have half a dozen margins."""

HOLDS, DOES_NOT, NOT_REACHED = "holds", "does not", "not reached"
NOT_RUN = "not run"
"""The verdict on a claim that compares none of the slopes there are."""

SOIL, STONES = "soil", ("arbitrary", "round", "oval")
SLOPES = (SOIL, *STONES)


class Judgement(NamedTuple):
    """A verdict, and the figures from which it follows: "holds", "does not", "not reached", that
    one draw (or so many) cannot tell, or "not run"."""

    verdict: str
    figures: str


class Form(NamedTuple):
    """How a figure is shown.

    Attributes
    ----------
    digits : behind the point
    unit : may be empty
    factor : from the figure to the unit
    """

    digits: int
    unit: str = ""
    factor: float = 1.0

    def shown(self, one: Sample) -> str:
        """The mean, and what chance does to it where the digits can tell, in the unit."""
        if math.isnan(one.mean):
            return NOT_REACHED
        mean, chance = (
            f"{self.factor * value:.{self.digits}f}" for value in (one.mean, one.deviation)
        )
        spread = f" ± {chance}" if float(chance) > 0 else ""
        return f"{mean}{spread} {self.unit}".rstrip()


class _Margin(NamedTuple):
    value: float
    deviation: float


class _Found(NamedTuple):
    samples: Mapping[str, Sample]
    margins: Sequence[_Margin]
    shown: str


Part = Callable[[Draws, Mapping[str, float]], _Found]


def judgement(parts: Sequence[Part], draws: Draws, spread: Mapping[str, float]) -> Judgement:
    """The worst that any part of a claim says of the slopes there are, where chance moves each
    figure by a share of it from draw to draw."""
    found = [one for part in parts if (one := part(draws, spread)).margins]
    if not found:
        return Judgement(NOT_RUN, "")
    shown = "; ".join(dict.fromkeys(one.shown for one in found))
    samples = [one for part in found for one in part.samples.values()]
    margins = [margin for part in found for margin in part.margins]
    if any(math.isnan(one.mean) for one in samples):
        return Judgement(NOT_REACHED, shown)
    signs = [_sign(margin) for margin in margins]
    if min(signs) < 0:
        return Judgement(DOES_NOT, shown)
    return Judgement(HOLDS if min(signs) > 0 else cannot_tell(samples), shown)


def cannot_tell(samples: Iterable[Sample]) -> str:
    """The verdict of chance over so many draws."""
    draws = max(one.draws for one in samples)
    return "one draw cannot tell" if draws <= 1 else f"{draws} draws cannot tell"


def ordered(figure: str, form: Form, *order: str | Sequence[str]) -> Part:
    """Each slope, or each of a group, has a larger figure than every one of the next group."""
    groups = [(group,) if isinstance(group, str) else tuple(group) for group in order]

    def part(draws: Draws, spread: Mapping[str, float]) -> _Found:
        there = [kept for group in groups if (kept := [name for name in group if name in draws])]
        found = _samples(draws, spread, figure, [name for group in there for name in group])
        margins = [
            _Margin(more.mean - less.mean, math.hypot(more.deviation, less.deviation))
            for before, after in pairwise(there)
            for more in (found[name] for name in before)
            for less in (found[name] for name in after)
        ]
        return _Found(found, margins, _shown(found, form))

    return part


def alike(figure: str, form: Form, share: float, slopes: Sequence[str]) -> Part:
    """The slopes differ from their mean by at most a share of it."""

    def part(draws: Draws, spread: Mapping[str, float]) -> _Found:
        found = _samples(draws, spread, figure, slopes)
        if len(found) < 2:
            return _Found(found, [], "")
        mean = sum(one.mean for one in found.values()) / len(found)
        margins = [
            _Margin(share * mean - abs(one.mean - mean), one.deviation) for one in found.values()
        ]
        return _Found(found, margins, _shown(found, form))

    return part


def between(
    figure: str, form: Form, low: float, high: float, slopes: Sequence[str] = SLOPES
) -> Part:
    """The figure of every one of the slopes is between two ends, which may be infinite."""

    def part(draws: Draws, spread: Mapping[str, float]) -> _Found:
        found = _samples(draws, spread, figure, slopes)
        margins = [
            _Margin(min(one.mean - low, high - one.mean), one.deviation) for one in found.values()
        ]
        return _Found(found, margins, _shown(found, form))

    return part


def near(figure: str, form: Form, value: float, tolerance: float, slopes: Sequence[str]) -> Part:
    """The figure of every one of the slopes is a value within a tolerance."""
    return between(figure, form, value - tolerance, value + tolerance, slopes)


def ratio(figure: str, form: Form, larger: str, smaller: str, value: float, share: float) -> Part:
    """The figure of one slope is that of another times a value, within a share of it."""

    def part(draws: Draws, spread: Mapping[str, float]) -> _Found:
        found = _samples(draws, spread, figure, (larger, smaller))
        if len(found) < 2:
            return _Found(found, [], "")
        above, below = found[larger], found[smaller]
        here = above.mean / below.mean
        relative = math.hypot(above.deviation / above.mean, below.deviation / below.mean)
        margin = _Margin(share * value - abs(here - value), here * relative)
        told = "" if math.isnan(here) else f": {here:.2f}"
        return _Found(found, [margin], f"{_shown(found, form)}{told}")

    return part


def _samples(
    draws: Draws, spread: Mapping[str, float], figure: str, slopes: Sequence[str]
) -> dict[str, Sample]:
    share = spread.get(figure, math.nan)
    return {
        name: sample(figure, draws[name], share if name in STONES else 0.0)
        for name in slopes
        if name in draws
    }


def _sign(margin: _Margin) -> int:
    """1 or -1 for a margin that decides, otherwise, or if its deviation is not known, 0."""
    if not abs(margin.value) > DEVIATIONS * margin.deviation:
        return 0
    return 1 if margin.value > 0 else -1


def _shown(found: Mapping[str, Sample], form: Form) -> str:
    return ", ".join(f"{name} {form.shown(one)}" for name, one in found.items())
