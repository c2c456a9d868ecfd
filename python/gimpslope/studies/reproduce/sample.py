"""A figure of a slope over one or more draws of its stones, with how far chance can move it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

import numpy as np

from .measures import FIGURES, Measures

KNOWN: Mapping[str, Any] = json.loads(
    resources.files(__package__).joinpath("spread.json").read_text()
)
"""`spread`: the standard deviation of each figure between draws of one kind of stones, as a share
of its mean, and `from`: the settings of the runs it was found in. The file is what
`gimpslope reproduce --reading identified --stone-modulus 5e8 --seed 1 2 3 4 5` writes."""

LEAST_DRAWS = 5
"""Draws of each kind of stones from which their own spread counts."""


@dataclass(frozen=True)
class Sample:
    """A figure of one slope.

    Attributes
    ----------
    mean : over the draws; NaN where one of them has not reached it
    draws : their number
    deviation : standard deviation of the mean that chance brings about
    """

    mean: float
    draws: int
    deviation: float


def sample(figure: str, draws: Sequence[Measures], share: float) -> Sample:
    """A figure of a slope that chance moves by a share (standard deviation over mean) of itself
    from draw to draw; 0 for a slope in which nothing is drawn."""
    values = np.array([getattr(one, figure) for one in draws])
    mean = float(values.mean())
    return Sample(mean, len(values), share * abs(mean) / math.sqrt(len(values)))


def spread_of(kinds: Sequence[Sequence[Measures]]) -> Mapping[str, float]:
    """How far chance moves each figure, as a share of it: as these draws of several kinds of stones
    say if they are enough, otherwise as is known."""
    return spread(kinds) if has_own_spread(kinds) else KNOWN["spread"]


def has_own_spread(kinds: Sequence[Sequence[Measures]]) -> bool:
    """Whether there are enough draws of each kind for a spread of their own."""
    return all(len(draws) >= LEAST_DRAWS for draws in kinds)


def spread(kinds: Sequence[Sequence[Measures]]) -> dict[str, float]:
    """Standard deviation of each figure between draws as a share of its mean: the root of the mean
    square over kinds of stones, of those whose draws have all reached it; left out where none
    has."""
    shares: dict[str, list[float]] = {name: [] for name in FIGURES}
    for draws in kinds:
        for name in FIGURES:
            values = np.array([getattr(one, name) for one in draws])
            if np.isfinite(values).all():
                mean = abs(float(values.mean()))
                shares[name].append(float(values.std(ddof=1)) / mean if mean else 0.0)
    return {name: math.sqrt(np.mean(np.square(some))) for name, some in shares.items() if some}
