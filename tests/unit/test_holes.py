"""Holes in the union of squares around points."""

from __future__ import annotations

import numpy as np
import pytest

from gimpslope._check import FloatArray
from gimpslope.analysis.holes import holes


def lattice() -> FloatArray:
    """Points 0.1 m apart on a square of 4 m, away from the origin."""
    line = np.arange(0.05, 4.0, 0.1)
    return np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2) - (7.0, 2.0)


def without(place: FloatArray, centre: tuple[float, float], half: float) -> FloatArray:
    kept: FloatArray = place[(np.abs(place - centre) > half).any(axis=1)]
    return kept


@pytest.mark.parametrize(("half", "expected"), [(0.0, 0), (0.4, 0), (0.66, 1)])
def test_a_hole_is_twice_the_reach_wide(half: float, expected: int) -> None:
    """Give or take a ninth."""
    assert holes(without(lattice(), (-5.0, 0.0), half), reach=0.5) == expected


def test_holes_are_counted_and_notches_are_not() -> None:
    place = without(without(lattice(), (-6.0, 0.0), 0.3), (-4.0, 1.0), 0.3)
    assert holes(place, reach=0.2) == 2
    assert holes(without(place, (-5.0, 2.0), 0.5), reach=0.2) == 2


def test_a_point_far_away_costs_nothing() -> None:
    assert holes(np.vstack([lattice(), [[1e6, -1e6]]]), reach=0.2) == 0
