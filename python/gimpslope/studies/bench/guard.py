"""A guard against the kernel becoming slow: how many times faster than the plain loop it is.

It is judged by the fastest repeats of both: others on the machine can only take time, and take it
from two threads first, while a kernel that has become slow is slow in every repeat.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from .cases import Case
from .plan import all_threads
from .speed import measure

LIMITS = MappingProxyType({1: 5.0, 2: 8.0})
"""Least ratio of the kernel's speed on slope A to the plain loop's on one thread, by threads."""


class Ratio(NamedTuple):
    """How many times faster than the plain loop: median of the repeats, and of the fastest ones."""

    median: float
    of_fastest: float


def ratios() -> dict[int, Ratio]:
    """The ratio on each number of threads in `LIMITS` that this machine runs side by side."""
    cases = [Case(threads=n) for n in LIMITS if n <= all_threads()]
    return {one.case.threads: Ratio(one.ratio, one.ratio_of_fastest) for one in measure(cases)}


def lines(ratios: Mapping[int, Ratio]) -> list[str]:
    """What was measured, in words, and what was not."""
    return [
        f"{_threads(n)}: {ratios[n].median:.2f} times the plain loop in the median, "
        f"{ratios[n].of_fastest:.2f} by the fastest repeats of both, at least {limit:g} wanted"
        if n in ratios
        else f"{_threads(n)}: not measured, for this machine does not run so many side by side"
        for n, limit in LIMITS.items()
    ]


def failures(ratios: Mapping[int, Ratio]) -> list[str]:
    """A sentence for each number of threads on which the kernel is too slow."""
    return [
        f"the kernel is too slow on {_threads(n)}: {ratio.of_fastest:.2f} times the plain loop by "
        f"the fastest repeats, but it must be at least {LIMITS[n]:g} times on a machine that does "
        "nothing else"
        for n, ratio in ratios.items()
        if not ratio.of_fastest >= LIMITS[n]
    ]


def _threads(count: int) -> str:
    return f"{count} thread" + ("s" if count > 1 else "")
