"""How many stones of which sizes: a list, a number, a share of the area, or lattice points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ... import _check
from ..._check import FloatArray
from ...outline import Outline
from ..rows import all_rows, refuse_not_positive
from .rounding import rounded
from .sizes import Law

Size = float | Sequence[float] | FloatArray | Law

_BLOCK = 256
_MOST_STONES = 100_000


@dataclass(frozen=True)
class Amount:
    """What a draw is to meet: exactly one of `count`, `content` and `points`; 0 is no stones.

    None of them is given where the sizes are a list.

    Parameters
    ----------
    count : number of stones
    content : share of the outline's area, in [0, 1)
    points : number of points in stones, of the outline's lattice of the spacing `spacing` (m)
    """

    count: int | None
    content: float | None
    points: int | None
    spacing: float | None

    def __post_init__(self) -> None:
        if self.count is not None:
            _check.whole("count", self.count, 0)
        if self.content is not None:
            _check.in_range("content", self.content, 0, 1, "[)")
        if self.points is not None:
            _check.whole("points", self.points, 0)
        if self.spacing is not None:
            _check.positive("spacing", self.spacing)
        if (self.points is None) != (self.spacing is None):
            raise ValueError(
                "spacing must be given with points and only then, "
                f"got {self.spacing} with points {self.points}"
            )

    def sizes(
        self, name: str, size: Size, outline: Outline, rng: np.random.Generator
    ) -> FloatArray:
        """Sizes of the stones to draw, diameters of circles of equal area, m, shape (n,).

        A list as it is; else a fixed size or draws from a law, the largest first, as many as were
        asked for or as meet the area most nearly, but at least one unless none are wanted.
        """
        if not isinstance(size, Law) and np.ndim(size) > 0:
            self._check_given(0, f"with a list as {name}")
            listed = all_rows(name, size, ())
            refuse_not_positive(name, listed)
            return listed
        self._check_given(1, f"unless {name} is a list")
        size = size if isinstance(size, Law) else _check.positive(name, size)
        if 0 in (self.count, self.content, self.points):
            return np.empty(0)
        if isinstance(size, Law):
            return rounded(-np.sort(-self._from_law(size, outline, rng)), outline)
        return self._alike(size, outline)

    def _check_given(self, wanted: int, when: str) -> None:
        given = {name: getattr(self, name) for name in ("count", "content", "points")}
        given = {name: value for name, value in given.items() if value is not None}
        if len(given) != wanted:
            number = ("none", "exactly one")[wanted]
            raise ValueError(
                f"{number} of count, content and points must be given {when}, got {given or 'none'}"
            )

    def area(self, outline: Outline) -> float:
        """The area to meet, m2, where no number of stones is given."""
        if self.content is not None:
            return self.content * outline.area
        assert self.points is not None and self.spacing is not None
        return self.points * self.spacing**2

    def _alike(self, size: float, outline: Outline) -> FloatArray:
        count = self.count
        if count is None:
            count = max(1, round(self.area(outline) / float(_area(size))))
        _refuse_too_many(count)
        return np.full(count, size)

    def _from_law(self, law: Law, outline: Outline, rng: np.random.Generator) -> FloatArray:
        if self.count is not None:
            _refuse_too_many(self.count)
            return law.quantile(rng.random(self.count))
        wanted, sizes = self.area(outline), np.empty(0)
        while _area(sizes).sum() < wanted:
            sizes = np.concatenate([sizes, law.quantile(rng.random(_BLOCK))])
            _refuse_too_many(len(sizes))
        covered = np.cumsum(_area(sizes))
        return sizes[: 1 + int(np.argmin(np.abs(covered - wanted)))]


def _area(size: npt.ArrayLike) -> FloatArray:
    area: FloatArray = math.pi / 4 * np.square(size)
    return area


def _refuse_too_many(count: int) -> None:
    if count > _MOST_STONES:
        raise ValueError(
            f"a draw must be of at most {_MOST_STONES:,} stones, got {count:,}; "
            "ask for fewer or larger ones"
        )
