"""How long the whole reference study takes at the paper's own time step, extrapolated."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from .cases import SLOPE_A

TIME_STEP = 1e-5  # s
STEPS = 1_000_000  # of each slope
SLOPES = 4


@dataclass(frozen=True)
class StudyTime:
    """Extrapolated times, s.

    Attributes
    ----------
    slope : of one slope, by the number of threads
    study : of all slopes on as many cores as the largest number of threads
    at_once : slopes that run at the same time in it, with one thread each; 1 where they run one
        after the other with all threads
    cores : that number
    """

    slope: dict[int, float]
    study: float
    at_once: int
    cores: int


def extrapolate(rates: Mapping[int, float]) -> StudyTime:
    """The times from measured point-steps a second by the number of threads.

    Slopes that run side by side are taken to be as fast as each alone. Raises `ValueError` if there
    are no rates.
    """
    if not rates:
        raise ValueError("rates must hold a number of threads, got none")
    slope = {threads: SLOPE_A * STEPS / rate for threads, rate in rates.items()}
    cores = max(rates)
    ways = {1: SLOPES * slope[cores]}
    if 1 in rates and cores > 1:
        ways[min(cores, SLOPES)] = math.ceil(SLOPES / cores) * slope[1]
    at_once = min(ways, key=ways.__getitem__)
    return StudyTime(slope=slope, study=ways[at_once], at_once=at_once, cores=cores)
