"""What grids tell of one quantity: its value without grid, the error of that, and what a finer grid
would leave of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..studies.richardson import Extrapolation, extrapolate
from .quantities import QUANTITIES

_CAUTION = 3.0
_FIRST_ORDER = 1.0
_SLOWEST = 0.5
_MOST_LEVELS = 8


@dataclass(frozen=True)
class Estimate:
    """One quantity on some grids, each with half the cell of the one before.

    All errors are shares of the value.

    Attributes
    ----------
    name : one of `QUANTITIES`
    cells : m, coarse to fine
    raw : the values as computed, SI units
    fixed : error that finer grids leave as it is, that of savings
    late : error that finer grids add, whose slides end early
    """

    name: str
    cells: tuple[float, ...]
    raw: tuple[float, ...]
    fixed: float = 0.0
    late: float = 0.0

    @property
    def value(self) -> float:
        """Best value, SI units: the extrapolated one where the grids approach a limit, else the
        finest."""
        limit = self._found.limit if self._found else math.nan
        return self.raw[-1] if math.isnan(limit) else limit

    @property
    def behaviour(self) -> str:
        """What the last three grids do, in the words of `Extrapolation`; "too few grids" of two;
        "not reached" where the last one has no value."""
        if not all(map(math.isfinite, self.raw[-3:])):
            return "not reached"
        return self._found.behaviour if self._found else "too few grids"

    @property
    def error(self) -> float:
        """Estimated error of the value; infinite where it is not reached."""
        return self._of_grid + self.fixed

    @property
    def raw_error(self) -> float:
        """Estimated error of the finest grid's own value, as a share of the best one."""
        return abs(self.raw[-1] / self.value - 1) + self.error if self.value else math.inf

    def predicted(self, levels: int) -> float:
        """The error once the cell has been halved so many times more, by the observed order, or
        first order where none is settled; where the grids diverge, as it is now."""
        return self._after(levels, self._order)

    def at_worst(self, levels: int) -> float:
        """The same with the least order that is trusted, a half; none where they diverge."""
        return self._after(levels, min(self._order, _SLOWEST))

    def levels(self, error: float) -> int | None:
        """How often the cell is to be halved for an error; None if that cannot be told."""
        enough = (n for n in range(_MOST_LEVELS) if self.predicted(n) <= error)
        return next(enough, None)

    def _after(self, levels: int, order: float) -> float:
        late = self.late if levels else 0.0
        return self._of_grid * 2 ** (-order * levels) + self.fixed + late

    @property
    def _found(self) -> Extrapolation | None:
        last = self.raw[-3:]
        return extrapolate(last) if len(last) == 3 and all(map(math.isfinite, last)) else None

    @property
    def _of_grid(self) -> float:
        if self.behaviour == "not reached" or self.value == 0:
            return math.inf
        if self._found is not None:
            return self._found.uncertainty / abs(self.value)
        return _CAUTION * abs(self.raw[-1] - self.raw[0]) / abs(self.value)

    @property
    def _order(self) -> float:
        if self.behaviour == "converges" and self._found is not None:
            order = self._found.orders[-1]
            return order if math.isfinite(order) else _FIRST_ORDER
        return 0.0 if self.behaviour in ("diverges", "not reached") else _FIRST_ORDER

    @property
    def shown(self) -> str:
        """The best value with its error, in words."""
        quantity = QUANTITIES[self.name]
        if not math.isfinite(self.error):
            return "not reached"
        value = self.value / quantity.scale
        return f"{value:.4g} ± {abs(value) * self.error:.2g} {quantity.unit}"
