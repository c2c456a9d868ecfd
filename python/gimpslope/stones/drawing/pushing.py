"""Stones that are too near pushed apart until all keep their distance."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..._check import FloatArray
from .room import Flags, Near, Room
from .rounding import rounded
from .watch import Watch

_MOST_SWEEPS = 3000
_MOST_PUSHES = 5_000_000
_MOST_LOOKS = 8_000_000
_PATIENCE = 200
_PROGRESS = 0.99
_STALLED = 1000
_GAIN = 0.95
_KICK = 0.01
_SLACK = 0.02
_JUMPS = 200
_LEEWAY = 0.5


class Pushed(NamedTuple):
    """Places (n, 2), m, which stones keep their distance there, the number of sweeps it took, and
    by how much the nearest were too near, m, when all together were so by the least."""

    places: FloatArray
    free: Flags
    sweeps: int
    lack: float


def pushed_apart(
    room: Room, areas: FloatArray, rng: np.random.Generator, places: FloatArray
) -> Pushed:
    """Stones pushed apart until all keep their distance, or until that does not get on.

    In a sweep all that are too near move a little. When 200 sweeps do not get on, the stone that is
    most in the way jumps to where there is room. It ends when 1,000 sweeps have not brought what
    all lack down by 5 %, after 3,000 sweeps, or as many as push 5 million stones, or after 8
    million looks at a pair. None leaves the outline.

    Parameters
    ----------
    areas : of the stones, m2, shape (n,)
    places : to start from, inside the outline, m, shape (n, 2)
    """
    most_sweeps = min(_MOST_SWEEPS, _MOST_PUSHES // len(areas))
    places = places.copy()
    watch = Watch(room, places, _LEEWAY * math.sqrt(areas.mean()))
    best, least, largest = math.inf, math.inf, math.inf
    since, stalled, sweeps = 0, 0, 0
    while True:
        near, edge = watch.near(places)
        lack = float(near.lack.sum() + edge.lack.sum())
        stalled += 1
        if lack < _GAIN * least:
            least, stalled = lack, 0
            largest = float(max(near.lack.max(initial=0), edge.lack.max(initial=0)))
        spent = sweeps == most_sweeps or watch.looks > _MOST_LOOKS or stalled > _STALLED
        if lack == 0 or spent:
            return Pushed(places, _free(near, edge, len(areas)), sweeps, largest)
        since = 0 if lack < _PROGRESS * best else since + 1
        best, sweeps = min(best, lack), sweeps + 1
        if since > _PATIENCE:
            _jump(room, areas, rng, places, near, edge)
            best = math.inf
        else:
            _push(room, areas, rng, places, near, edge)


def _push(
    room: Room,
    areas: FloatArray,
    rng: np.random.Generator,
    places: FloatArray,
    near: Near,
    edge: Near,
) -> None:
    """Move stones apart along the shortest way, the smaller of two more, and those at an edge off
    it; all a little further than they must, and a little at random, so that none lock."""
    sizes = np.sqrt(areas)
    share = (areas[near.second] / (areas[near.first] + areas[near.second]))[:, np.newaxis]
    more = near.lack + _SLACK * np.minimum(sizes[near.first], sizes[near.second])
    apart = more[:, np.newaxis] * near.direction
    off = (edge.lack + _SLACK * sizes[edge.first])[:, np.newaxis] * edge.direction
    push = np.zeros_like(places)
    np.add.at(push, near.first, -share * apart)
    np.add.at(push, near.second, (1 - share) * apart)
    np.add.at(push, edge.first, -off)
    moved = np.unique(np.concatenate([near.first, near.second, edge.first]))
    push[moved] += _KICK * sizes[moved, np.newaxis] * (2 * rng.random((len(moved), 2)) - 1)
    pushed = rounded(places[moved] + push[moved], room.outline)
    inside = room.outline.contains(pushed)
    places[moved[inside]] = pushed[inside]


def _jump(
    room: Room,
    areas: FloatArray,
    rng: np.random.Generator,
    places: FloatArray,
    near: Near,
    edge: Near,
) -> None:
    """Move the stone that is most in the way to that of some random places which is furthest from
    any other stone, all taken for circles."""
    in_the_way = np.concatenate([near.second, edge.first])
    number = int(np.argmax(np.bincount(in_the_way, np.concatenate([near.lack, edge.lack]))))
    found = room.random_points(rng, _JUMPS)
    found = found[room.outline.contains(found)]
    others = np.arange(len(areas)) != number
    if len(found) and others.any():
        x, y = (found[:, np.newaxis] - places[others]).transpose(2, 0, 1)
        free = np.sqrt(x * x + y * y) - np.sqrt(areas[others] / math.pi)
        places[number] = found[np.argmax(free.min(axis=1))]


def _free(near: Near, edge: Near, n: int) -> Flags:
    """Which stones remain when those near an edge are taken away, and the later of each pair."""
    free = np.ones(n, dtype=np.bool_)
    free[edge.first] = False
    for one, other in zip(near.first, near.second, strict=True):
        free[other] &= ~free[one]
    return free
