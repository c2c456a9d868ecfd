"""Bands: connected regions of plastic soil."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .. import _check
from .._check import FloatArray
from ..snapshot import Snapshot
from .components import CORNERS, components, neighbours
from .islands import islands
from .plastic import PLASTIC_THRESHOLD, plastic_zone

LEAST_BAND = 0.1
"""Area below which a connected region does not count as a band, m2."""


@dataclass(frozen=True, eq=False)
class Bands:
    """Connected regions of plastic soil, the largest first.

    Attributes
    ----------
    label : number of the band that a point is part of, -1 in none, shape (n,)
    area : present area of the points of each band, m2, shape (k,)
    islands : areas of what the bands go around, such as stones, m2, shape (j,), the largest first
    """

    label: npt.NDArray[np.int32]
    area: FloatArray
    islands: FloatArray

    def __len__(self) -> int:
        return len(self.area)


def plastic_bands(
    state: Snapshot,
    cell: float,
    *,
    origin: tuple[float, float] = (0.0, 0.0),
    threshold: float = PLASTIC_THRESHOLD,
    least: float = LEAST_BAND,
) -> Bands:
    """Connected regions of the plastic zone.

    The points above the threshold are put into the square cells that they are in at that time. Two
    cells that hold such points and share an edge or a corner are connected. Islands are the regions
    of other cells, connected by edges, that bands of all sizes enclose on every side.

    Parameters
    ----------
    state : where the points are, and their plastic strain
    cell : side of a cell, m, > 0; points closer than two cells may count as connected
    origin : a corner of a cell, m
    threshold : equivalent plastic strain, >= 0
    least : regions of a smaller area, m2, >= 0, are no bands, and no islands

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range.
    """
    cell, least = _check.positive("cell", cell), _check.not_negative("least", least)
    corner = _check.array("origin", origin, (2,))
    plastic = np.flatnonzero(plastic_zone(state, threshold))
    places = np.floor((state.position[plastic] - corner) / cell).astype(np.int64)
    cells, cell_of = np.unique(places, axis=0, return_inverse=True)
    region = components(len(cells), neighbours(cells, CORNERS))[cell_of.reshape(-1)]
    area = np.bincount(region, state.volume[plastic], minlength=len(cells)).astype(np.float64)
    counted = np.flatnonzero((area > 0) & (area >= least))
    order = counted[np.argsort(-area[counted], kind="stable")]
    number = np.full(len(cells), -1, dtype=np.int32)
    number[order] = np.arange(len(order))
    label = np.full(len(state.position), -1, dtype=np.int32)
    label[plastic] = number[region]
    enclosed = np.sort(islands(cells) * cell**2)[::-1]
    return Bands(label, area[order], enclosed[enclosed >= least])
