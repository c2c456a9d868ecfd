"""What a problem is, whose error is charted against its cost."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ...method import Method

Changes = Mapping[str, Any]
"""Parameters of a method, by name, that differ from those of the problem's own."""


class Solution(NamedTuple):
    """An error, as a part of what is known, and the processor time of the steps, s."""

    error: float
    core_seconds: float


@dataclass(frozen=True)
class Problem:
    """A problem whose answer is known from elsewhere than our default.

    Attributes
    ----------
    name, title : for the command line and the files; a few words
    error : what of it is in error, and by whose answer, in words
    cells : m, coarse to fine
    solve : by cell (m), method, and model of the stones (None without); raises what the solver does
    method : the package's default for its materials, with the viscosity where that is part of the
        problem
    dimensions : in which the number of points and with it the cost grows
    yields : whether the material does, or is elastic
    known_to : uncertainty of the answer, a part of it; 0 where it is exact
    fine : finer cells, on which each choice is measured alone at the longer step
    dear : still finer ones, on which no more than some changes are measured
    only : changes that are measured in place of all that there are
    models : of the stones; the first is the full one
    """

    name: str
    title: str
    error: str
    cells: tuple[float, ...]
    solve: Callable[[float, Method, str | None], Solution]
    method: Method = Method(volumetric_strain="point")  # noqa: RUF009 (frozen)
    dimensions: int = 2
    yields: bool = False
    known_to: float = 0.0
    fine: tuple[float, ...] = ()
    dear: Mapping[float, tuple[Changes, ...]] = field(default_factory=dict)
    only: tuple[Changes, ...] = ()
    models: tuple[str | None, ...] = (None,)
