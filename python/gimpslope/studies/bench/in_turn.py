"""Speeds measured in turn, so that whatever else the machine does falls on all of them alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..._check import FloatArray

REPEATS = 7
SECONDS = 0.3
"""Of one repeat."""

_ENOUGH = 0.2  # of a repeat, to tell from it how much work fills one

Name = TypeVar("Name")


@dataclass(frozen=True)
class Work:
    """Something whose speed is measured: `do(count)` does so many pieces of it.

    A repeat lasts `share` times as long as others do.
    """

    do: Callable[[int], object]
    share: float = 1.0


def rates(works: Mapping[Name, Work]) -> dict[Name, FloatArray]:
    """Pieces of each work a second in each repeat, shape (repeats,), the works in turn.

    Ratios of two works are medians of the ratios of their repeats.
    """
    counts = {name: _count(work) for name, work in works.items()}
    rounds = [
        [counts[name] / seconds(work.do, counts[name]) for name, work in works.items()]
        for _ in range(REPEATS)
    ]
    return dict(zip(works, np.transpose(rounds), strict=True))


def ratio(rates: FloatArray, others: FloatArray) -> float:
    """How many times faster one work is than another."""
    return float(np.median(rates / others))


def seconds(do: Callable[[int], object], count: int) -> float:
    """Wall time of that much work, s."""
    start = time.perf_counter()
    do(count)
    return time.perf_counter() - start


def _count(work: Work) -> int:
    """How much work fills a repeat; finding out warms up."""
    whole = SECONDS * work.share
    count = 1
    while (spent := seconds(work.do, count)) < _ENOUGH * whole:
        count *= 2
    return max(1, round(count * whole / spent))
