"""Places for stones: at random, the largest first, then by pushing apart those that found none.

Both are bounded by counts, not by the clock, so that a draw ends the same way on every machine.
Places are rounded at every turn, so that last digits, which differ between machines, do not grow.
"""

from __future__ import annotations

import math

import numpy as np

from .._check import FloatArray
from .reach import Numbers
from .room import Flags, Near, Room
from .rounding import rounded

_SAME_GENERATION = 0.5
_MOST_SWEEPS = 3000
_MOST_PUSHES = 5_000_000
_PATIENCE = 200
_PROGRESS = 0.99
_JUMPS = 200
_KICK = 0.01
_SLACK = 0.02


class StonesDoNotFit(ValueError):
    """No places were found for all of the stones.

    Attributes
    ----------
    count, content : number of stones that had places, and the share of the outline that they cover
    wanted, wanted_content : the same of all stones
    tries : random places tried
    sweeps : times that all stones were pushed apart
    """

    def __init__(
        self, placed: Flags, areas: FloatArray, room: Room, tries: int, sweeps: int
    ) -> None:
        self.count, self.wanted = int(placed.sum()), len(placed)
        self.content = float(areas[placed].sum() / room.outline.area)
        self.wanted_content = float(areas.sum() / room.outline.area)
        self.tries, self.sweeps = tries, sweeps
        super().__init__(
            f"the stones must fit into the outline, got places for {self.count} of {self.wanted}, "
            f"{100 * self.content:.3g} of {100 * self.wanted_content:.3g} % of its area, at a gap "
            f"of {room.gap:.4g} m and a margin of {room.margin:.4g} m after {tries} random places "
            f"and {sweeps} sweeps of pushing"
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
        If the stones have more area than the outline, or pushing does not get on for 500 sweeps or
        end within 3,000.
    """
    if areas.sum() > room.outline.area:
        raise StonesDoNotFit(np.zeros(len(areas), dtype=np.bool_), areas, room, 0, 0)
    places, placed, tried = _at_random(room, areas, rng, tries)
    if placed.all():
        return places
    places, free, sweeps = _pushed_apart(room, areas, rng, places)
    if not free.all():
        best = max(placed, free, key=lambda flags: float(areas[flags].sum()))
        raise StonesDoNotFit(best, areas, room, tried, sweeps)
    return places


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


def _pushed_apart(
    room: Room, areas: FloatArray, rng: np.random.Generator, places: FloatArray
) -> tuple[FloatArray, Flags, int]:
    """Places, which of the stones they suit, and how many sweeps it took.

    In a sweep, stones that are too near move apart along the shortest way, the smaller one more,
    and a little further at random; a stone near an edge moves off it. None leaves the outline. When
    that does not get on, the stone that is most in the way jumps to where there is most room.
    """
    sizes, most_sweeps = np.sqrt(areas), min(_MOST_SWEEPS, _MOST_PUSHES // len(areas))
    best, since, sweeps = np.inf, 0, 0
    while True:
        near, edge = _conflicts(room, places)
        lack = near.lack.sum() + edge.lack.sum()
        if lack == 0 or sweeps == most_sweeps:
            return places, _free(near.first, near.second, edge.first, len(areas)), sweeps
        since = 0 if lack < _PROGRESS * best else since + 1
        best, sweeps = min(best, lack), sweeps + 1
        if since > _PATIENCE:
            pressed = np.bincount(
                np.concatenate([near.second, edge.first]), np.concatenate([near.lack, edge.lack])
            )
            number = int(np.argmax(pressed))
            places[number] = _roomiest(room, sizes, rng, places, number)
            best = np.inf
            continue
        share = areas[near.second] / (areas[near.first] + areas[near.second])
        more = near.lack + _SLACK * np.minimum(sizes[near.first], sizes[near.second])
        push = np.zeros_like(places)
        np.add.at(push, near.first, -(more * share)[:, np.newaxis] * near.direction)
        np.add.at(push, near.second, (more * (1 - share))[:, np.newaxis] * near.direction)
        off = edge.lack + _SLACK * sizes[edge.first]
        np.add.at(push, edge.first, -off[:, np.newaxis] * edge.direction)
        moved = np.unique(np.concatenate([near.first, near.second, edge.first]))
        push[moved] += _KICK * sizes[moved, np.newaxis] * (2 * rng.random((len(moved), 2)) - 1)
        pushed = rounded(places[moved] + push[moved], room.outline)
        inside = room.outline.contains(pushed)
        places[moved[inside]] = pushed[inside]


def _conflicts(room: Room, places: FloatArray) -> tuple[Near, Near]:
    everyone = np.arange(len(places))
    return room.near_stones(places, everyone), room.near_edges(places, everyone)


def _roomiest(
    room: Room, sizes: FloatArray, rng: np.random.Generator, places: FloatArray, number: int
) -> FloatArray:
    """Of random places, the furthest from any other stone; the old one if none is in the outline.

    Stones count as circles.
    """
    found = room.random_points(rng, _JUMPS)
    found = np.concatenate([places[number : number + 1], found[room.outline.contains(found)]])
    others = np.arange(len(sizes)) != number
    x, y = (found[:, np.newaxis] - places[others]).transpose(2, 0, 1)
    free = np.sqrt(x * x + y * y) - sizes[others] / math.sqrt(math.pi)
    free = free.min(axis=1)
    return found[np.argmax(free)]


def _free(first: Numbers, second: Numbers, near_edge: Numbers, n: int) -> Flags:
    """Which stones remain when those near an edge are taken away, and the later of each pair."""
    free = np.ones(n, dtype=np.bool_)
    free[near_edge] = False
    for one, other in zip(first, second, strict=True):
        free[other] &= ~free[one]
    return free
