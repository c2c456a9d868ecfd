"""What a problem with a known answer is made of."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Check:
    """One quantity held against theory, a measurement or a published result.

    Attributes
    ----------
    quantity : what it is, with its unit
    expected : the known value, or the bound
    got : the computed value
    low, high : where `got` must lie, ends included
    why : the reason of the tolerance, in one line
    order : observed order of convergence, where one was observed
    """

    quantity: str
    expected: float
    got: float
    low: float
    high: float
    why: str
    order: float | None = None

    @classmethod
    def near(
        cls,
        quantity: str,
        *,
        expected: float,
        got: float,
        within: float,
        why: str,
        order: float | None = None,
    ) -> Self:
        """`got` must be `expected` but for `within`, in the unit of both."""
        return cls(quantity, expected, got, expected - within, expected + within, why, order)

    @classmethod
    def at_most(
        cls, quantity: str, *, bound: float, got: float, why: str, order: float | None = None
    ) -> Self:
        """`got` must not exceed the bound."""
        return cls(quantity, bound, got, -math.inf, bound, why, order)

    @classmethod
    def at_least(
        cls, quantity: str, *, bound: float, got: float, why: str, order: float | None = None
    ) -> Self:
        """`got` must reach the bound."""
        return cls(quantity, bound, got, bound, math.inf, why, order)

    @property
    def holds(self) -> bool:
        """Whether `got` lies where it must."""
        return bool(self.low <= self.got <= self.high)

    @property
    def error(self) -> float | None:
        """`got` less `expected`; None where `expected` is a bound."""
        bounded = math.isfinite(self.low) and math.isfinite(self.high)
        return self.got - self.expected if bounded else None


@dataclass(frozen=True)
class Outcome:
    """What a problem came to: its checks, and a figure of the computed against the known."""

    checks: list[Check]
    figure: Figure


@dataclass(frozen=True)
class Problem:
    """A problem with a known answer.

    Attributes
    ----------
    name : for the command line and the files
    title : a few words
    run : solves it, quickly or in full, and checks it
    """

    name: str
    title: str
    run: Callable[[bool], Outcome]
