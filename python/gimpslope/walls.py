"""Walls: the condition on each of the four sides of the background grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import ClassVar

from . import _check
from ._record import Record


@dataclass(frozen=True)
class Free(Record):
    """No wall."""

    kind: ClassVar[str] = "free"


@dataclass(frozen=True)
class Roller(Record):
    """No velocity normal to the wall, either way; free along it."""

    kind: ClassVar[str] = "roller"


@dataclass(frozen=True)
class Fixed(Record):
    """No velocity at all."""

    kind: ClassVar[str] = "fixed"


@dataclass(frozen=True)
class Coulomb(Record):
    """A wall that may be left but not entered, with friction along it.

    Parameters
    ----------
    friction : coefficient mu of Coulomb friction, >= 0 (a ratio of forces, not an angle)

    Raises
    ------
    TypeError, ValueError
        If the coefficient is not a finite number >= 0.
    """

    friction: float
    kind: ClassVar[str] = "coulomb"

    def __post_init__(self) -> None:
        self._store(friction=_check.not_negative("friction", self.friction))


Wall = Free | Roller | Fixed | Coulomb


@dataclass(frozen=True)
class Walls(Record):
    """The walls on the four sides. A wall holds on every grid node on it or beyond it.

    Parameters
    ----------
    left, right, bottom, top : `Free()`, `Roller()`, `Fixed()` or `Coulomb(friction)`

    Raises
    ------
    TypeError
        If a side is anything else.
    """

    left: Wall = Fixed()
    right: Wall = Free()
    bottom: Wall = Fixed()
    top: Wall = Free()

    def __post_init__(self) -> None:
        allowed = "Free(), Roller(), Fixed() or Coulomb(friction)"
        for side in fields(self):
            _check.instance(side.name, getattr(self, side.name), Wall, allowed)

    def to_core(self, positions: Sequence[float]) -> list[tuple[str, float, float]]:
        """The walls as the compiled kernel takes them: (kind, friction, position) a side.

        `positions` and the result are in the order left, right, bottom, top; positions in m.
        """
        sides = (self.left, self.right, self.bottom, self.top)
        return [
            (wall.kind, wall.friction if isinstance(wall, Coulomb) else 0.0, position)
            for wall, position in zip(sides, positions, strict=True)
        ]
