"""Places for stones: at random, the largest first, then by pushing apart those that found none.

Both are bounded by counts, not by the clock, so that a draw ends the same way on every machine.
Places are rounded at every turn, so that last digits, which differ between machines, do not grow.
"""

from __future__ import annotations

import numpy as np

from ..._check import FloatArray
from .pushing import pushed_apart
from .room import Flags, Room

_SAME_GENERATION = 0.5


class StonesDoNotFit(ValueError):
    """No places were found for all of the stones.

    Attributes
    ----------
    count, content : number of stones that had places, and the share of the outline that they cover
    wanted, wanted_content : the same of all stones
    gap, margin : least distances, from each other and from the edge, m
    tries : random places tried
    sweeps : times that all stones were pushed apart
    """

    def __init__(
        self,
        count: int,
        content: float,
        wanted: int,
        wanted_content: float,
        gap: float,
        margin: float,
        tries: int,
        sweeps: int,
    ) -> None:
        super().__init__(count, content, wanted, wanted_content, gap, margin, tries, sweeps)
        self.count, self.content = count, content
        self.wanted, self.wanted_content = wanted, wanted_content
        self.gap, self.margin = gap, margin
        self.tries, self.sweeps = tries, sweeps

    def __str__(self) -> str:
        tried = (
            f"after {self.tries} random places and {self.sweeps} sweeps of pushing"
            if self.tries
            else "without a try, for with their gaps they have more area than there is"
        )
        return (
            f"the stones must fit into the outline, got places for {self.count} of {self.wanted}, "
            f"which cover {100 * self.content:.3g} of {100 * self.wanted_content:.3g} % of it, "
            f"with a gap of {self.gap:.4g} m and a margin of {self.margin:.4g} m, "
            f"{tried}"
        )


def place(room: Room, areas: FloatArray, rng: np.random.Generator, tries: int) -> FloatArray:
    """Places of the origins of stones that keep the room's gap and margin, m, shape (n, 2).

    Parameters
    ----------
    areas : of the stones, m2, shape (n,), from the largest down
    tries : random places that each stone tries before stones are pushed

    Raises
    ------
    StonesDoNotFit
        If stones and gaps have more area than the outline, or pushing came to no end.
    """
    if _cannot_fit(room, areas):
        raise _refusal(room, areas, np.zeros(len(areas), dtype=np.bool_), 0, 0)
    places, placed, tried = _at_random(room, areas, rng, tries)
    if placed.all():
        return places
    places, free, sweeps = pushed_apart(room, areas, rng, places)
    if not free.all():
        best = max(placed, free, key=lambda flags: float(areas[flags].sum()))
        raise _refusal(room, areas, best, tried, sweeps)
    return places


def _cannot_fit(room: Room, areas: FloatArray) -> bool:
    """Whether stones grown by half the gap have more area than the outline grown by as much of that
    as exceeds the margin, in which they lie side by side.

    A convex body of area A and perimeter P grown by t has the area A + P t + pi t2 (Steiner), no
    polygon has more; its perimeter is 2 pi times its mean reach (Cauchy).
    """
    half = room.gap / 2
    beyond = max(half - room.margin, 0.0)
    perimeters = 2 * np.pi * room.reaches.mean(axis=1)
    grown = (areas + perimeters * half + np.pi * half**2).sum()
    outline = room.outline.polygon
    return bool(grown > outline.area + outline.length * beyond + np.pi * beyond**2)


def _refusal(
    room: Room, areas: FloatArray, placed: Flags, tries: int, sweeps: int
) -> StonesDoNotFit:
    return StonesDoNotFit(
        int(placed.sum()),
        float(areas[placed].sum() / room.outline.area),
        len(areas),
        float(areas.sum() / room.outline.area),
        room.gap,
        room.margin,
        tries,
        sweeps,
    )


def _at_random(
    room: Room, areas: FloatArray, rng: np.random.Generator, tries: int
) -> tuple[FloatArray, Flags, int]:
    """Places, which of the stones they suit, and how many were tried.

    Stones of at least half the area of the largest without a place try at the same time; the one of
    the lower number has the right of way.
    """
    places = np.tile(room.inner_point, (len(areas), 1))
    placed = np.zeros(len(areas), dtype=np.bool_)
    tried = np.zeros(len(areas), dtype=np.int64)
    while len(waiting := np.flatnonzero(~placed & (tried < tries))):
        trying = waiting[areas[waiting] >= _SAME_GENERATION * areas[waiting[0]]]
        tried[trying] += 1
        found = room.random_points(rng, len(trying))
        inside = room.outline.contains(found)
        trying, found = trying[inside], found[inside]
        places[trying] = found
        new = np.zeros_like(placed)
        new[trying] = True
        new[room.near_edges(places, trying).first] = False
        near = room.near_stones(places, np.flatnonzero(placed | new))
        new[np.where(new[near.second], near.second, near.first)] = False
        placed |= new
    return places, placed, int(tried.sum())
