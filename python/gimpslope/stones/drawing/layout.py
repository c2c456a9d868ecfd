"""From shapes to stones: places by a seed, points met by scaling, everything verified."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ... import _check
from ..._check import FloatArray
from ...materials import Material
from ...outline import Outline
from ..collection import Stones
from ..stone import Shape, Stone
from . import placing, points
from .amount import Amount
from .reach import reach
from .room import ROUNDING, Room
from .shapes import moved


@dataclass(frozen=True)
class Layout:
    """Where a draw may put its stones.

    Parameters
    ----------
    outline : of the slope
    seed : of the random numbers, a whole number >= 0
    gap : least distance between stones, m, >= 0
    margin : least distance of stones from the edge of the outline, m, >= 0; None: the gap
    tries : random places that each stone tries before stones are pushed apart, >= 1
    """

    outline: Outline
    seed: int
    gap: float
    margin: float | None
    tries: int

    def __post_init__(self) -> None:
        _check.instance("outline", self.outline, Outline, "an Outline")
        _check.whole("seed", self.seed, 0)
        _check.not_negative("gap", self.gap)
        if self.margin is not None:
            _check.not_negative("margin", self.margin)
        _check.whole("tries", self.tries, 1)

    @cached_property
    def rng(self) -> np.random.Generator:
        """The random numbers. Only `random` is used, whose stream numpy does not change."""
        return np.random.Generator(np.random.PCG64(self.seed))

    def stones(self, shapes: Sequence[Shape], amount: Amount, material: Material | None) -> Stones:
        """Stones of shapes about the origin, in their order; the largest is placed first.

        Raises
        ------
        ValueError
            `StonesDoNotFit`, or if a number of points is out of reach.
        """
        if not shapes:
            return Stones()
        areas = np.array([shape.area for shape in shapes])
        order = np.argsort(-areas, kind="stable")
        reaches = np.array([reach(shape) for shape in shapes])
        last = self._scalable(areas, order, amount)
        reaches[last] *= 1 + points.SCALE
        room = Room(self.outline, reaches[order], self.gap, self._margin)
        places = np.empty((len(shapes), 2))
        places[order] = placing.place(room, areas[order], self.rng, self.tries)
        made = [moved(shape, place) for shape, place in zip(shapes, places, strict=True)]
        if amount.points is not None and amount.spacing is not None:
            lattice = self.outline.lattice(amount.spacing)
            held = int((Stones(made).numbers(lattice) >= 0).sum())
            scalable = [shapes[n] for n in last]
            factors = points.factors(scalable, places[last], lattice, held, amount.points)
            for number, factor in zip(last.tolist(), factors, strict=True):
                made[number] = moved(shapes[number], places[number], factor)
        return self._verified(Stones([Stone(shape, material) for shape in made]))

    @property
    def _margin(self) -> float:
        return self.gap if self.margin is None else self.margin

    def _scalable(
        self, areas: FloatArray, order: npt.NDArray[np.intp], amount: Amount
    ) -> npt.NDArray[np.intp]:
        """Numbers of the stones that may be scaled to meet a number of points, the last first."""
        if amount.points is None or amount.spacing is None:
            return order[:0]
        return order[::-1][: points.n_scalable(areas[order], amount.points, amount.spacing)]

    def _verified(self, stones: Stones) -> Stones:
        """The stones, whose distances must be kept by the exact measure too."""
        if len(stones.overlaps()) or len(stones.outside(self.outline)):
            raise RuntimeError("drawn stones must neither overlap nor leave the outline, got such")
        gap, margin = stones.gaps().min(), stones.margins(self.outline).min()
        if gap < self.gap - ROUNDING or margin < self._margin - ROUNDING:
            raise RuntimeError(
                f"drawn stones must keep a gap of {self.gap} and a margin of {self._margin} m, "
                f"got {gap} and {margin}"
            )
        return stones
