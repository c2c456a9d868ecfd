"""What grids tell of one quantity: its value without grid, the error of that, and what a finer grid
would leave of it.

Where the last three grids converge, limit and uncertainty are those of Richardson's extrapolation,
which a fourth may narrow. Elsewhere the finest value stands for itself, and its uncertainty is
three times (Eca and Hoekstra, J. Comput. Phys. 262 (2014) 104) the last change, or a quarter of the
change before if that is more: second order would have left that much, and a smaller change is
chance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile

from ..studies.richardson import CAUTION, TRUSTED, Extrapolation, extrapolate
from .quantities import QUANTITIES

_SECOND_ORDER = 1 / 4
_FIRST = 1.0  # order
_MOST_LEVELS = 8


@dataclass(frozen=True)
class Estimate:
    """One quantity on some grids, each with half the cell of the one before.

    All errors are shares of the value.

    Attributes
    ----------
    name : one of `QUANTITIES`
    cells : m, coarse to fine
    raw : the values as computed, SI units; NaN where not reached
    fixed : error that finer grids leave as it is: of savings, and of slides that end early
    """

    name: str
    cells: tuple[float, ...]
    raw: tuple[float, ...]
    fixed: float = 0.0

    @property
    def value(self) -> float:
        """Best value, SI units: the limit where the last three grids converge, else the finest."""
        return self._limit.limit if self._limit else self.raw[-1]

    @property
    def behaviour(self) -> str:
        """What the last three grids do, in the words of `Extrapolation`; "too few grids" of two;
        "not reached" where one of them has no value."""
        if not all(map(math.isfinite, self.raw[-3:])):
            return "not reached"
        return self._found.behaviour if self._found else "too few grids"

    @property
    def error(self) -> float:
        """Estimated error of the value; infinite where it is not reached."""
        return self.predicted(0)

    @property
    def raw_error(self) -> float:
        """Estimated error of the finest grid's own value, as a share of the best one."""
        return abs(self.raw[-1] / self.value - 1) + self.error if self.value else math.inf

    def predicted(self, levels: int) -> float:
        """The error once the cell has been halved so many times more, by the observed order, or
        first order where none is settled; where the grids diverge, as it is now."""
        return self._of_grid * 2 ** (-self._order * levels) + self.fixed

    def at_worst(self, levels: int) -> float:
        """The same with the least order that is trusted, a half."""
        return self._of_grid * 2 ** (-min(self._order, TRUSTED[0]) * levels) + self.fixed

    def levels(self, error: float) -> int | None:
        """How often the cell is to be halved for an error; None if that cannot be told."""
        enough = (n for n in range(_MOST_LEVELS) if self.predicted(n) <= error)
        return next(enough, None)

    @property
    def stands(self) -> str:
        """What the grids do, and what the value is for that."""
        return f"{self.behaviour}, {'limit' if self._limit else 'finest grid'}"

    @property
    def shown(self) -> str:
        """The best value with its error, in words."""
        quantity = QUANTITIES[self.name]
        if not math.isfinite(self.error):
            return "not reached"
        value = self.value / quantity.scale
        return f"{value:.4g} ± {abs(value) * self.error:.2g} {quantity.unit}"

    @cached_property
    def _found(self) -> Extrapolation | None:
        last = list(takewhile(math.isfinite, reversed(self.raw)))[::-1]
        return extrapolate(last) if len(last) >= 3 else None

    @property
    def _limit(self) -> Extrapolation | None:
        return self._found if self._found and self._found.behaviour == "converges" else None

    @property
    def _of_grid(self) -> float:
        if self.behaviour == "not reached" or self.value == 0:
            return math.inf
        if self._limit:
            return self._limit.uncertainty / abs(self.value)
        changes = [abs(a - b) for a, b in zip(self.raw, self.raw[1:], strict=False)]
        *before, last = changes[-2:]
        return CAUTION * max(last, *(_SECOND_ORDER * c for c in before), 0.0) / abs(self.value)

    @property
    def _order(self) -> float:
        if self._limit:
            order = self._limit.orders[-1]
            return order if math.isfinite(order) else _FIRST
        return 0.0 if self.behaviour in ("diverges", "not reached") else _FIRST
