"""A figure of a slope over one or more draws of its stones, with how far chance can move it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .measures import Measures

SPREAD: Mapping[str, float] = {}
"""Standard deviation of each figure between draws of one kind of stones, as a share of its mean."""

DEVIATIONS = 2.0
"""A difference counts if it is larger than this many of its standard deviations."""

_LEAST = 3


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
    if len(values) >= _LEAST:
        return Sample(mean, len(values), float(values.std(ddof=1)) / math.sqrt(len(values)))
    return Sample(mean, len(values), SPREAD[figure] * abs(mean) / math.sqrt(len(values)))


def difference(first: Sample, second: Sample) -> int:
    """1 if the first is larger, -1 if it is smaller, 0 if chance may have done it."""
    gap = first.mean - second.mean
    if abs(gap) <= DEVIATIONS * math.hypot(first.deviation, second.deviation):
        return 0
    return 1 if gap > 0 else -1
