"""What is asked of a plan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .. import _check
from .quantities import DEFAULT, check_names


@dataclass(frozen=True)
class Target:
    """What is wanted, how well, and in which time.

    Parameters
    ----------
    error : a share of each quantity, in (0, 1)
    quantities : names, see `QUANTITIES`
    budget : wall time that pilots and run may take, s, > 0

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range, or a quantity unknown.
    """

    error: float = 0.05
    quantities: Sequence[str] = DEFAULT
    budget: float = 600.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "error", _check.in_range("error", self.error, 0, 1, "()"))
        object.__setattr__(self, "quantities", check_names(self.quantities))
        object.__setattr__(self, "budget", _check.positive("budget", self.budget))
