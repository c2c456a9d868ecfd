"""Stones watched while they move: who is too near is looked for among those that were not far."""

from __future__ import annotations

import numpy as np

from ..._check import FloatArray
from .room import Near, Room


class Watch:
    """Who is too near in a room, as n stones move.

    Their neighbours are looked for anew when one has moved along x or y by more than `leeway`, m,
    which has no bearing on what is found. `looks` is the number of pairs looked at so far.
    """

    def __init__(self, room: Room, places: FloatArray, leeway: float) -> None:
        self._room, self._leeway = room, leeway
        self.looks = 0
        self._look_around(places)

    def near(self, places: FloatArray) -> tuple[Near, Near]:
        """Stones that are too near to each other, and to edges, at places (n, 2), m."""
        if np.abs(places - self._seen).max() > self._leeway:
            self._look_around(places)
        stones = self._room.near_stones(places, self._pairs)
        edges = self._room.near_edges(places, self._at_edges)
        self.looks += stones.measured + edges.measured
        return stones, edges

    def _look_around(self, places: FloatArray) -> None:
        everyone = np.arange(len(places))
        self._seen = places.copy()
        self._pairs = self._room.pairs(places, everyone, self._leeway)
        self._at_edges = self._room.beside_edges(places, everyone, self._leeway)
        self.looks += self._pairs.shape[1] + self._at_edges.shape[1]
