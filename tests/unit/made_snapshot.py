"""Snapshots made by hand, of which a test gives only what it is about."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from gimpslope.snapshot import PointsAtStart, Snapshot


def made(position: npt.ArrayLike, start: npt.ArrayLike | None = None, **given: Any) -> Snapshot:
    """Points of unit mass and square domains of side 0.1 m, at rest and elastic, all of them soil.

    `start` is where they were at the trigger, `position` itself where left out; `given` are fields
    of `Snapshot` and `PointsAtStart` in place of these.
    """
    now = np.asarray(position, dtype=np.float64)
    n = len(now)
    stone = np.asarray(given.pop("stone", np.full(n, -1)), dtype=np.int32)
    volume = np.full(n, 0.01)
    points = {
        "position": now if start is None else np.asarray(start, dtype=np.float64),
        "mass": np.ones(n),
        "volume": volume,
        "half_length": np.full((n, 2), 0.05),
        "material": (stone >= 0).astype(np.int32),
        "stone": stone,
    }
    state = {
        "time": 0.0,
        "velocity": np.zeros((n, 2)),
        "stress": np.zeros((n, 4)),
        "plastic_strain": np.zeros(n),
        "volume": volume,
    }
    points |= {name: given.pop(name) for name in points.keys() & given.keys() - {"volume"}}
    return Snapshot(**(state | given | {"position": now, "points": PointsAtStart(**points)}))
