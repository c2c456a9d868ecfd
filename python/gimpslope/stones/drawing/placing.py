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
_TRIES_IF_TOO_MANY = 10
_ALMOST = 0.999


class StonesDoNotFit(ValueError):
    """No places were found for all of the stones.

    Attributes
    ----------
    count, content : number of stones that had places, and the share of the outline that they cover
    wanted, wanted_content : the same of all stones
    gap, margin : least distances, from each other and from the edge, m
    needed : share of the room that all take with their gaps, side by side; above 1 they cannot fit
    tries : random places tried
    sweeps : times that all stones were pushed apart
    lack : by how much the nearest of all were still too near when pushing had got furthest, m;
        infinite without pushing
    """

    def __init__(
        self,
        count: int,
        content: float,
        wanted: int,
        wanted_content: float,
        gap: float,
        margin: float,
        needed: float,
        tries: int,
        sweeps: int,
        lack: float,
    ) -> None:
        super().__init__(
            count, content, wanted, wanted_content, gap, margin, needed, tries, sweeps, lack
        )
        self.count, self.content = count, content
        self.wanted, self.wanted_content = wanted, wanted_content
        self.gap, self.margin, self.needed = gap, margin, needed
        self.tries, self.sweeps, self.lack = tries, sweeps, lack

    def __str__(self) -> str:
        return (
            f"the stones must fit into the outline, got places for {self.count} of {self.wanted}, "
            f"which cover {100 * self.content:.3g} of {100 * self.wanted_content:.3g} % of it, "
            f"with a gap of {self.gap:.4g} m and a margin of {self.margin:.4g} m, {self._tried}"
        )

    @property
    def _tried(self) -> str:
        if not self.tries:
            return "without a try, for the margin leaves no room for the largest"
        places = f"after {self.tries} random places"
        if self.needed > 1:
            return f"{places}, for with their gaps all take {self.needed:.3g} times the room"
        return (
            f"{places} and {self.sweeps} sweeps of pushing all apart, "
            f"which at best left some {self.lack:.2g} m too near"
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
        If the margin leaves a stone no room, stones and gaps have more area than the outline, or
        pushing came to no end.
    """
    needed = _needed(room, areas)

    def refusal(placed: Flags, tried: int, sweeps: int = 0, lack: float = np.inf) -> StonesDoNotFit:
        return StonesDoNotFit(
            int(placed.sum()),
            float(areas[placed].sum() / room.outline.area),
            len(areas),
            float(areas.sum() / room.outline.area),
            room.gap,
            room.margin,
            needed,
            tried,
            sweeps,
            lack,
        )

    if _no_room_for_the_largest(room):
        raise refusal(np.zeros(len(areas), dtype=np.bool_), 0)
    if needed > 1:
        _, placed, tried = _at_random(room, areas, rng, min(tries, _TRIES_IF_TOO_MANY))
        raise refusal(placed, tried)
    places, placed, tried = _at_random(room, areas, rng, tries)
    if placed.all():
        return places
    pushed = pushed_apart(room, areas, rng, places)
    if not pushed.free.all():
        best = max(placed, pushed.free, key=lambda flags: float(areas[flags].sum()))
        raise refusal(best, tried, pushed.sweeps, pushed.lack)
    return pushed.places


def _no_room_for_the_largest(room: Room) -> bool:
    """Whether no point is as far from the edge as the margin and a circle inside a stone ask."""
    radius = room.reaches.min(axis=1).max()
    return bool(room.outline.polygon.buffer(-_ALMOST * (room.margin + radius)).is_empty)


def _needed(room: Room, areas: FloatArray) -> float:
    """The area of stones grown by half the gap as a share of that of the outline grown by as much
    of that as exceeds the margin, in which they lie side by side.

    A convex body of area A and perimeter P grown by t has the area A + P t + pi t2 (Steiner), no
    polygon has more; its perimeter is 2 pi times its mean reach (Cauchy).
    """
    half = room.gap / 2
    beyond = max(half - room.margin, 0.0)
    perimeters = 2 * np.pi * room.reaches.mean(axis=1)
    grown = (areas + perimeters * half + np.pi * half**2).sum()
    outline = room.outline.polygon
    return float(grown / (outline.area + outline.length * beyond + np.pi * beyond**2))


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
        new[room.near_edges(places, room.beside_edges(places, trying)).first] = False
        pairs = room.pairs(places, np.flatnonzero(placed | new))
        near = room.near_stones(places, pairs[:, new[pairs].any(axis=0)])
        new[np.where(new[near.second], near.second, near.first)] = False
        placed |= new
    return places, placed, int(tried.sum())
