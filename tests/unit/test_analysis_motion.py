"""Fastest points, displacements and run-out of points whose motion is given."""

import numpy as np
import pytest
from made_snapshot import made

from gimpslope.analysis import (
    fastest_of,
    fastest_point,
    mass_percentile,
    max_displacement,
    run_out,
)

HUNDRED = np.column_stack([np.arange(100.0), np.zeros(100)])


def test_percentiles_of_equal_masses():
    values = np.random.default_rng(1).permutation(np.arange(1.0, 101.0))
    mass = np.full(100, 0.1)
    for percentile in (0.5, 1, 50, 99, 99.5, 100):
        assert mass_percentile(values, mass, percentile) == np.ceil(percentile)


@pytest.mark.parametrize("count", [3, 6, 9, 13])
def test_rounding_of_sums_does_not_push_a_percentile_on(count):
    for mass in (0.1, 0.3):
        found = [
            mass_percentile(np.arange(count), np.full(count, mass), 100 * part / count)
            for part in range(1, count + 1)
        ]
        assert found == list(range(count))


def test_percentiles_weigh_by_mass():
    values, mass = np.array([3.0, 1.0, 2.0]), np.array([1.0, 8.0, 1.0])
    assert mass_percentile(values, mass, 80) == 1.0
    assert mass_percentile(values, mass, 81) == 2.0
    assert mass_percentile(values, mass, 91) == 3.0


@pytest.mark.parametrize("percentile", [0, 101, -1, float("inf")])
def test_other_percentiles_are_refused(percentile):
    with pytest.raises(ValueError, match=r"percentile must be a number in \(0, 100\], got"):
        mass_percentile(np.ones(3), np.ones(3), percentile)


def test_displacements_each_for_itself():
    moved = np.array([(3.0, -4.0), (-6.0, 0.0), (0.0, 1.0)])
    found = max_displacement(made(moved + 10, start=np.full((3, 2), 10.0)))
    assert found == pytest.approx((6.0, 6.0, 4.0))
    assert found == made(moved, start=np.zeros((3, 2))).max_displacement


def test_one_flying_point_does_not_count_at_99_per_cent():
    moved = np.column_stack([np.linspace(0, 1, 100), -np.linspace(0, 2, 100)])
    moved[-1] = 500.0
    state = made(HUNDRED + moved, start=HUNDRED)
    assert max_displacement(state).horizontal == 500.0
    robust = max_displacement(state, 99)
    assert robust.horizontal == pytest.approx(98 / 99)
    assert robust.vertical == pytest.approx(2 * 98 / 99)
    assert robust.total == pytest.approx(np.sqrt(5) * 98 / 99)


def test_run_out_is_the_way_of_the_front():
    assert run_out(made(HUNDRED)) == run_out(made(HUNDRED), 99) == 0.0
    moved = np.add(HUNDRED, (2.5, 0.0))
    moved[0, 0] = 400.0
    state = made(moved, start=HUNDRED)
    assert run_out(state) == pytest.approx(400 - 99)
    assert run_out(state, 99) == pytest.approx(2.5 + 1)  # the point before it is the front now
    assert run_out(state, 50) == pytest.approx(2.5 + 1)
    heavy = made(moved, start=HUNDRED, mass=np.append(np.ones(99), 1e6))
    assert run_out(heavy, 50) == pytest.approx(2.5)


def test_fastest_point():
    velocity = np.zeros((100, 2))
    velocity[7], velocity[8] = (3.0, -4.0), (4.9, 0.0)
    found = fastest_point(made(HUNDRED, velocity=velocity, time=1.5))
    assert found == (1.5, 7, (7.0, 0.0), 5.0)


def test_fastest_of_several_moments_is_the_first_of_the_fastest():
    speeds = [1.0, 4.0, 2.0, 4.0]
    states = [
        made(HUNDRED, velocity=np.full((100, 2), (speed, 0.0)), time=time)
        for time, speed in enumerate(speeds)
    ]
    assert fastest_of(iter(states)) == (1, 0, (0.0, 0.0), 4.0)
    with pytest.raises(ValueError, match="at least one snapshot"):
        fastest_of([])
