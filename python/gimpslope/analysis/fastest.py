"""The fastest point of a slide."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ..snapshot import Snapshot


class FastestPoint(NamedTuple):
    """The fastest point: when (s), its number, where it is (x, y; m), and its speed (m/s)."""

    time: float
    number: int
    position: tuple[float, float]
    speed: float


def fastest_point(state: Snapshot) -> FastestPoint:
    """The fastest point of one moment; the first of several that are as fast."""
    speed = state.speed
    number = int(np.argmax(speed))
    x, y = state.position[number].tolist()
    return FastestPoint(state.time, number, (x, y), float(speed[number]))


def fastest_of(states: Iterable[Snapshot]) -> FastestPoint:
    """The fastest point of several moments; the first of several that are as fast.

    Raises `ValueError` if there are none.
    """
    found = [fastest_point(state) for state in states]
    if not found:
        raise ValueError("states must be at least one snapshot, got none")
    return max(found, key=lambda point: point.speed)
