"""Which cases are worth their cost."""

from __future__ import annotations

from collections.abc import Sequence

from .measure import Measured

LEAST = 0.1
"""Share by which an error must be smaller to be worth a higher cost."""


def held(measured: Sequence[Measured]) -> dict[Measured, float]:
    """The error that each case may be trusted with: the largest on its grid and all finer ones with
    the same changes, for a smaller one is luck that a finer grid takes back."""
    return {one: max(other.error for other in measured if _refines(other, one)) for one in measured}


def is_finest(one: Measured, measured: Sequence[Measured]) -> bool:
    """Whether no finer grid was measured with the same changes, so that its error is on trust."""
    return not any(_refines(other, one) for other in measured if other != one)


def front(measured: Sequence[Measured]) -> list[Measured]:
    """The cases that no cheaper one comes near, by errors that hold; cheapest first."""
    errors, best, found = held(measured), float("inf"), []
    for one in sorted(measured, key=lambda one: (one.core_seconds, errors[one])):
        if errors[one] < (1 - LEAST) * best:
            best = errors[one]
            found.append(one)
    return found


def cheapest(measured: Sequence[Measured], error: float) -> Measured | None:
    """The cheapest case whose error holds below a given one; None if there is none."""
    errors = held(measured)
    enough = [one for one in measured if errors[one] <= error]
    return min(enough, key=lambda one: one.core_seconds, default=None)


def _refines(other: Measured, one: Measured) -> bool:
    """Whether a case is another, or that on a finer grid."""
    same = (other.case.changes, other.case.model) == (one.case.changes, one.case.model)
    return same and other.case.cell <= one.case.cell
