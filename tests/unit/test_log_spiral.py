"""The log-spiral bound gives the stability numbers of Chen (1975, table 9.1)."""

from __future__ import annotations

import numpy as np
import pytest

from gimpslope.studies.verify.log_spiral import stability_number


@pytest.mark.parametrize(
    ("friction", "angle", "number"),
    [(5, 90, 4.19), (20, 90, 5.50), (20, 60, 10.39), (20, 45, 16.16)],
)
def test_stability_number(friction: float, angle: float, number: float) -> None:
    """The angles are on a grid of half a degree, which leaves a number 0.1 % too large."""
    found, crest, toe = stability_number(np.radians(friction), np.radians(angle))
    assert found == pytest.approx(number, rel=2e-3)
    assert 0 < crest < toe < np.pi
