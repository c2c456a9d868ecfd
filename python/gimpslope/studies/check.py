"""One quantity held against what is known of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self


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
    def bound(self) -> str | None:
        """Which bound `expected` is, "≤" or "≥"; None where it is a value."""
        if math.isfinite(self.low):
            return None if math.isfinite(self.high) else "≥"
        return "≤"

    @property
    def error(self) -> float | None:
        """`got` less `expected`; None where `expected` is a bound."""
        return self.got - self.expected if self.bound is None else None
