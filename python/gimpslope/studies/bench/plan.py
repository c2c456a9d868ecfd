"""Which cases are measured, and beside which others."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace

from ... import kernel
from .cases import SLOPE_A, Case

SIZES = (2_000, SLOPE_A, 94_000, 376_000)

_VARIANTS: tuple[dict[str, object], ...] = (
    {"shape": "linear"},
    {"shape": "cpgimp"},
    {"shape": "quadratic_bspline"},
    {"scheme": "usl"},
    {"scheme": "musl"},
    {"volumetric_strain": "cell_average"},
    {"ledger": True},
    {"precision": "single"},
    {"stones": 0.4},
)


def all_threads() -> int:
    """Threads that run side by side: one a processor, or one in all in a build without threads."""
    if not kernel.has_threads():
        return 1
    allowed = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(allowed(0)) if allowed else os.cpu_count() or 1


@dataclass(frozen=True)
class Plan:
    """The standard case in all sizes on all numbers of threads, and variants of it in one size.

    Parameters
    ----------
    sizes : about that many points, each >= 10; `SIZES` where left out
    threads : numbers of threads, each >= 1; one and all processors where left out

    Raises
    ------
    TypeError, ValueError
        If there is no size or no number of threads, or one of them is refused.
    """

    sizes: tuple[int, ...]
    threads: tuple[int, ...]

    def __init__(
        self, sizes: Sequence[int] | None = None, threads: Sequence[int] | None = None
    ) -> None:
        sizes = SIZES if sizes is None else sizes
        threads = (1, all_threads()) if threads is None else threads
        for name, given in (("sizes", sizes), ("threads", threads)):
            if not given:
                raise ValueError(f"{name} must hold a number, got {given!r}")
            object.__setattr__(self, name, tuple(sorted(set(given))))
        self.groups()

    @property
    def standard(self) -> Case:
        """The case whose variants are measured: the size nearest to slope A, fewest threads."""
        return Case(min(self.sizes, key=lambda n: abs(n - SLOPE_A)), min(self.threads))

    def groups(self) -> list[list[Case]]:
        """The cases of each size, which are measured in turn."""
        return [
            [Case(points, threads) for threads in self.threads]
            + (self.variants() if points == self.standard.points else [])
            for points in self.sizes
        ]

    def variants(self) -> list[Case]:
        """The standard case with one thing changed in each."""
        return [replace(self.standard, **changed) for changed in _VARIANTS]  # type: ignore[arg-type]
