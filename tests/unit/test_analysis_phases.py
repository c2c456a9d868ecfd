"""Phases of a slide from curves of kinetic energy that are known by formula."""

from pathlib import Path

import numpy as np
import pytest

from gimpslope.analysis import phases_of
from gimpslope.energy import Energy


def energy(time, kinetic):
    time = np.asarray(time, dtype=float)
    none = np.zeros(len(time))
    return Energy(Path("made.h5"), time, none.astype(int), kinetic, none, none, none)


def triangle(until=20.0):
    """Rises to 8 J/m at 2 s, falls to zero at 10 s and stays there."""
    time = np.linspace(0, until, 2001)
    return energy(time, np.interp(time, [0, 2, 10], [0, 8, 0]))


@pytest.mark.parametrize("share", [0.001, 0.01, 0.1, 0.37])
def test_phases_of_a_triangle(share):
    found = phases_of(triangle(), share)
    assert found.acceleration == found.peak == pytest.approx(2.0)
    assert found.rest == pytest.approx(10 - 8 * share)
    assert found.deceleration == pytest.approx(8 - 8 * share)
    assert found.stable == pytest.approx(10 + 8 * share)
    assert found.end == 20.0


def test_one_per_cent_unless_told():
    assert phases_of(triangle()).rest == pytest.approx(10 - 0.08)


def test_rest_is_interpolated_between_rows():
    found = phases_of(energy([0, 1, 2, 3, 4], np.array([0.0, 100.0, 3.0, 0.0, 0.0])))
    assert found.rest == pytest.approx(2 + 2 / 3)


def test_a_slide_that_moves_again_is_not_at_rest_before():
    curve = np.array([0, 10, 5, 0.01, 0.01, 4, 0.01, 0.0])
    found = phases_of(energy(np.arange(8), curve))
    assert 5 < found.rest < 6


def test_what_is_not_reached_is_none():
    rising = phases_of(triangle(until=1.5))
    assert (rising.peak, rising.rest, rising.end) == (None, None, 1.5)
    assert rising.acceleration is rising.deceleration is rising.stable is None
    falling = phases_of(triangle(until=5))
    assert falling.peak == pytest.approx(2.0)
    assert falling.rest is falling.deceleration is falling.stable is None


def test_a_slope_that_never_moves_is_at_rest_from_the_start():
    found = phases_of(energy(np.arange(5), np.zeros(5)))
    assert (found.peak, found.rest, found.stable) == (0.0, 0.0, 4.0)


@pytest.mark.parametrize("share", [0.0, 1.0, -0.1, float("nan")])
def test_other_shares_are_refused(share):
    with pytest.raises(ValueError, match=r"share must be a number in \(0, 1\), got"):
        phases_of(triangle(), share)


def test_no_rows_are_refused():
    with pytest.raises(ValueError, match=r"energy rows.*made\.h5"):
        phases_of(energy([], np.array([])))
