"""The peak of the kinetic energy, between the rows and through the waves in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gimpslope._check import FloatArray
from gimpslope.analysis import smooth_peak
from gimpslope.energy import Energy


def energy(time: FloatArray, kinetic: FloatArray) -> Energy:
    flat = np.zeros_like(time)
    return Energy(Path("made"), time, flat.astype(np.int64), kinetic, flat, flat, 1.0 + time)


def test_the_peak_lies_between_rows() -> None:
    time = np.arange(0.0, 3.0, 0.005)
    found = smooth_peak(energy(time, 5.0 - 20.0 * (time - 1.6012) ** 2))
    assert found == pytest.approx((1.6012, 5.0, 2.6012))


@pytest.mark.parametrize("interval", [0.005, 0.01])
def test_waves_do_not_move_it(interval: float) -> None:
    """Of a tenth of a percent, which put the highest row up to 0.03 s off, and of periods that the
    window of 0.2 s holds twice or more."""
    time = np.arange(0.0, 3.0, interval)
    for period in (0.021, 0.043, 0.07, 0.1):
        for phase in (0.0, 1.5, 3.0, 4.5):
            rough = 1e-3 * np.sin(2 * np.pi * time / period + phase)
            found = smooth_peak(energy(time, 1e5 * (1 - (time - 1.603) ** 2 + rough)))
            assert found is not None
            assert found.time == pytest.approx(1.603, abs=3e-3)
            assert found.kinetic == pytest.approx(1e5, rel=2e-4)
            assert found.max_speed == pytest.approx(2.603, abs=3e-3)


def test_a_peak_without_a_parabola_is_its_row() -> None:
    """Of a slide that grows the faster the longer, and is lower in the last row alone."""
    time = np.arange(0.0, 3.0, 0.005)
    kinetic = np.exp(20 * time)
    kinetic[-1] = kinetic[-3]
    assert smooth_peak(energy(time, kinetic)) == (time[-2], kinetic[-2], 1.0 + time[-2])


def test_no_peak_while_energy_grows() -> None:
    time = np.arange(0.0, 1.0, 0.005)
    assert smooth_peak(energy(time, time**2)) is None
