"""A figure of a slope over one or more draws of its stones, with how far chance can move it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources

import numpy as np

from .measures import FIGURES, Measures

SPREAD: Mapping[str, float] = json.loads(
    resources.files(__package__).joinpath("spread.json").read_text()
)
"""Standard deviation of each figure between draws of one kind of stones, as a share of its mean.
`gimpslope reproduce --reading identified --stone-modulus 5e8 --seed 1 2 3 4 5` writes the file."""

DEVIATIONS = 2.0
"""A difference counts if it is larger than this many of its standard deviations."""

LEAST_DRAWS = 3
"""Draws from which their own spread counts."""


@dataclass(frozen=True)
class Sample:
    """A figure of one slope.

    Attributes
    ----------
    mean : over the draws
    draws : their number; 0 for a slope without stones, in which nothing is drawn
    deviation : standard deviation of the mean that chance brings about
    """

    mean: float
    draws: int
    deviation: float


def sample(figure: str, draws: Sequence[Measures], *, drawn: bool) -> Sample:
    """A figure of a slope whose stones were `drawn`, or that has none.

    From three draws on their own standard deviation counts, below that `SPREAD`.
    """
    values = np.array([getattr(one, figure) for one in draws])
    mean = float(values.mean())
    if not drawn:
        return Sample(mean, 0, 0.0)
    if len(values) >= LEAST_DRAWS:
        return Sample(mean, len(values), float(values.std(ddof=1)) / math.sqrt(len(values)))
    return Sample(mean, len(values), SPREAD[figure] * abs(mean) / math.sqrt(len(values)))


def difference(first: Sample, second: Sample) -> int:
    """1 if the first is larger, -1 if it is smaller, 0 if chance may have done it."""
    gap = first.mean - second.mean
    if abs(gap) <= DEVIATIONS * math.hypot(first.deviation, second.deviation):
        return 0
    return 1 if gap > 0 else -1


def spread(kinds: Sequence[Sequence[Measures]]) -> dict[str, float]:
    """Standard deviation of each figure between draws as a share of its mean: the root of the mean
    square over kinds of stones, of the draws that have reached it; left out where none has."""
    shares: dict[str, list[float]] = {name: [] for name in FIGURES}
    for draws in kinds:
        for name in FIGURES:
            values = np.array([getattr(one, name) for one in draws])
            reached = values[np.isfinite(values)]
            if len(reached) > 1:
                mean = abs(float(reached.mean()))
                shares[name].append(float(reached.std(ddof=1)) / mean if mean else 0.0)
    return {name: math.sqrt(np.mean(np.square(some))) for name, some in shares.items() if some}
