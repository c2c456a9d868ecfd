"""Stones that are too near pushed apart until all keep their distance."""

from __future__ import annotations

import math

import numpy as np

from ..._check import FloatArray
from .room import Flags, Near, Room
from .rounding import rounded

_MOST_SWEEPS = 3000
_MOST_PUSHES = 5_000_000
_PATIENCE = 200
_PROGRESS = 0.99
_KICK = 0.01
_SLACK = 0.02
_JUMPS = 200


def pushed_apart(
    room: Room, areas: FloatArray, rng: np.random.Generator, places: FloatArray
) -> tuple[FloatArray, Flags, int]:
    """Places (n, 2), m, which stones keep their distance there, and the number of sweeps it took.

    In a sweep all that are too near move a little. When 200 sweeps do not get on, the stone that is
    most in the way jumps to where there is room. It ends after 3,000 sweeps, or after as many as
    push 5 million stones. None leaves the outline.

    Parameters
    ----------
    areas : of the stones, m2, shape (n,)
    places : to start from, inside the outline, m, shape (n, 2)
    """
    everyone, most_sweeps = np.arange(len(areas)), min(_MOST_SWEEPS, _MOST_PUSHES // len(areas))
    places = places.copy()
    best, since, sweeps = math.inf, 0, 0
    while True:
        near, edge = room.near_stones(places, everyone), room.near_edges(places, everyone)
        lack = float(near.lack.sum() + edge.lack.sum())
        if lack == 0 or sweeps == most_sweeps:
            return places, _free(near, edge, len(areas)), sweeps
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
