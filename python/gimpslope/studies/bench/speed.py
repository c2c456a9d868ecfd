"""The speed of cases, beside the plain loop and the multiply-adds that the processor can do."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ... import _core
from ..._check import FloatArray
from ...solver import Solver
from . import flops
from .cases import Case
from .in_turn import Work, rates, ratio

_PEAK_SHARE = 0.15  # of a repeat, for the multiply-adds
_LEAST_BUFFER = 64  # bytes


@dataclass(frozen=True)
class Measurement:
    """Speed of one case: median and extremes over the repeats, in point-steps a second.

    Attributes
    ----------
    case : what was stepped
    points : its number of points
    instruction_set : what it ran on
    median, slowest, fastest : point-steps a second
    plain : of the plain loop on one thread, point-steps a second
    ratio : how many times faster than the plain loop
    ratio_of_fastest : of the fastest repeats of both, which others on the machine disturb least
    to_standard : how many times faster than the standard case of this size and number of threads;
        None where that was not measured beside it
    flops : floating-point operations counted a point-step; None where they are not
    peak : those that as many threads can do in fused multiply-adds, FLOP/s
    peak_share : share of them that the kernel reaches; None likewise
    bytes_per_point : memory of points and grid
    parts : shares of the time of the steps: stress, move, nodes, sort
    """

    case: Case
    points: int
    instruction_set: str
    median: float
    slowest: float
    fastest: float
    plain: float
    ratio: float
    ratio_of_fastest: float
    to_standard: float | None
    flops: float | None
    peak: float
    peak_share: float | None
    bytes_per_point: float
    parts: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """The fields by name, with those of the case among them."""
        fields: dict[str, Any] = asdict(self)
        case: dict[str, Any] = fields.pop("case")
        return case | fields


def measure(cases: Sequence[Case]) -> list[Measurement]:
    """Step cases in turn, with their plain loops and the processor's multiply-adds in between."""
    solvers = {case: case.solver() for case in cases}
    speeds = rates(_works(solvers))
    return [_measurement(case, solver, speeds) for case, solver in solvers.items()]


def _works(solvers: dict[Case, Solver]) -> dict[Hashable, Work]:
    works: dict[Hashable, Work] = {case: Work(solver.advance) for case, solver in solvers.items()}
    for case in solvers:
        if _plain(case) not in works:
            works[_plain(case)] = Work(case.plain().advance)
        if _peak(case) not in works:
            works[_peak(case)] = Work(_machine(case).multiply_add, _PEAK_SHARE)
    return works


def _measurement(case: Case, solver: Solver, speeds: dict[Hashable, FloatArray]) -> Measurement:
    points, steps, plain = len(solver), speeds[case], speeds[_plain(case)]
    peak = speeds[_peak(case)] * _machine(case).multiply_add(1)
    known = case.shape in flops.NODES and case.scheme == "usf"
    counted = flops.per_point_step(case.shape) if known else None
    return Measurement(
        case=case,
        points=points,
        instruction_set=solver.instruction_set,
        median=points * float(np.median(steps)),
        slowest=points * float(steps.min()),
        fastest=points * float(steps.max()),
        plain=points * float(np.median(plain)),
        ratio=ratio(steps, plain),
        ratio_of_fastest=float(steps.max() / plain.max()),
        to_standard=ratio(steps, speeds[case.standard]) if case.standard in speeds else None,
        flops=counted,
        peak=float(np.median(peak)),
        peak_share=None if counted is None else counted * points * ratio(steps, peak),
        bytes_per_point=solver.bytes / points,
        parts=_shares(solver.seconds),
    )


def _shares(seconds: dict[str, float]) -> dict[str, float]:
    """Each entry as a share of all."""
    whole = sum(seconds.values())
    return {name: spent / whole for name, spent in seconds.items()}


def _plain(case: Case) -> Hashable:
    return "plain", case.points, case.stones, case.instruction_set


def _peak(case: Case) -> Hashable:
    return "peak", case.threads, case.instruction_set


def _machine(case: Case) -> _core.Machine:
    return _core.Machine(
        threads=case.threads, bytes=_LEAST_BUFFER, instruction_set=case.instruction_set
    )
