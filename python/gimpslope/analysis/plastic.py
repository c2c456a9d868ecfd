"""The plastic zone: where the equivalent plastic strain is above a threshold."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _check
from ..snapshot import Snapshot

PLASTIC_THRESHOLD = 0.01
"""Equivalent plastic strain above which a point counts as part of the plastic zone. It is above the
elastic strains of the study's soil, about 0.5 %, and far below those in a sliding band."""


class PlasticShare(NamedTuple):
    """Share of the mass of the soil, and of the stones, that is plastic, in [0, 1].

    None where there is no soil, or no stone.
    """

    soil: float | None
    stone: float | None


def plastic_points(state: Snapshot, threshold: float = PLASTIC_THRESHOLD) -> npt.NDArray[np.bool_]:
    """Which points, of soil or stone, have an equivalent plastic strain above it, shape (n,).

    Raises `TypeError` or `ValueError` for a threshold that is no finite number >= 0.
    """
    above: npt.NDArray[np.bool_]
    above = state.plastic_strain > _check.not_negative("threshold", threshold)
    return above


def plastic_zone(state: Snapshot, threshold: float = PLASTIC_THRESHOLD) -> npt.NDArray[np.bool_]:
    """Which points are soil with an equivalent plastic strain above the threshold, shape (n,)."""
    return plastic_points(state, threshold) & (state.points.stone < 0)


def plastic_share(state: Snapshot, threshold: float = PLASTIC_THRESHOLD) -> PlasticShare:
    """Which share of the mass of the soil, and of the stones, is above the threshold."""
    above, mass = plastic_points(state, threshold), state.points.mass

    def share(part: npt.NDArray[np.bool_]) -> float | None:
        return float(mass[above & part].sum() / mass[part].sum()) if part.any() else None

    return PlasticShare(share(state.points.stone < 0), share(state.points.stone >= 0))
