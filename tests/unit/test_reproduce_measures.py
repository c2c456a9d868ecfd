"""What the claims are judged by, on states with counted answers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import synthetic_run as synthetic
from made_snapshot import made

from gimpslope.studies.reproduce import measures

LINE = np.column_stack([np.arange(8.0), np.zeros(8)])
"""Eight points of unit mass, one metre apart: the last two are the front quarter."""


def test_the_front_is_a_quarter_of_the_mass() -> None:
    ahead = measures.front(made(LINE))
    assert ahead.tolist() == [False] * 5 + [True] * 3  # the sixth point holds the 75th percent
    heavy = made(LINE, mass=np.array([1.0, 1, 1, 1, 1, 1, 1, 21]))
    assert measures.front(heavy).tolist() == [False] * 7 + [True]


def test_the_bottom_is_soil_that_lay_below_two_metres() -> None:
    start = np.array([(0, 0.5), (0, 1.5), (0, 1.9), (0, 2.5), (0, 0.7)])
    state = made(
        start - (0, 0.4),
        start,
        plastic_strain=np.array([0.0, 0.5, 0.0, 0.0, 0.9]),
        stone=np.array([-1, -1, -1, -1, 0]),
        mass=np.array([1.0, 2.0, 3.0, 10.0, 10.0]),
    )
    assert measures.bottom_intact(state) == pytest.approx(4 / 6)


def test_what_has_moved_far_and_is_in_front() -> None:
    start = LINE - np.column_stack([[0, 4.5, 0, 0, 0, 3.5, 4.5, 4.5], np.zeros(8)])
    assert measures.far_front(made(LINE, start)) == pytest.approx(2 / 3)
    assert math.isnan(measures.far_front(made(LINE)))


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> measures.Measures:
    path = tmp_path_factory.mktemp("measured") / "run.h5"
    return measures.measure(synthetic.write_run(path))


def test_figures_of_a_run_that_moves_by_formula(measured: measures.Measures) -> None:
    """Its speed is largest at 2 s, where the fastest points, at the right, move by sqrt(5) a."""
    mass, a = synthetic.POINTS.mass, synthetic.SHARE
    assert measured.mass == pytest.approx(mass.sum() / 1e3)
    assert measured.peak_time == pytest.approx(2.0)
    assert measured.peak_energy == pytest.approx(synthetic.kinetic(2.0) / 1e3)
    speed = np.sqrt(5) * a
    assert measured.early_speed == pytest.approx(synthetic.rate(0.5) * speed.max())
    assert measured.late_speed == pytest.approx(synthetic.rate(3.5) * speed.max())
    assert measured.fast_share == pytest.approx(mass[speed >= 1].sum() / mass.sum())
    moved = synthetic.travel(4.0) * speed
    assert measured.near_share == pytest.approx(mass[moved < 2].sum() / mass.sum())
    assert measured.total == pytest.approx(moved.max())
    assert measured.horizontal == pytest.approx(synthetic.travel(4.0) * 2 * a.max())
    assert measured.vertical == pytest.approx(measured.horizontal / 2)
    assert measured.sideways == pytest.approx(2 / 5**0.5)
    soil, strain = synthetic.POINTS.stone < 0, 0.5 * synthetic.travel(4.0) * a**2
    assert measured.plastic_soil == pytest.approx(
        mass[soil & (strain > 0.01)].sum() / mass[soil].sum()
    )
    assert measured.plastic_stone == 0.0
    assert measured.deceleration == pytest.approx(measured.rest_time - 2.0)
    early = 0.5 * synthetic.travel(1.0) * a**2 > 0.01
    assert measured.early_bands == 1.0 and early.any()
    assert math.isnan(measured.late_bands)  # the run ends at 4 s


def test_what_is_not_reached_is_no_figure(tmp_path: Path) -> None:
    rising = measures.measure(synthetic.write_run(tmp_path / "rising.h5", until=1.0))
    unknown = {name for name, value in rising.to_dict().items() if math.isnan(value)}
    assert {"mass", "early_speed", "early_bands", "early_islands"} == set(
        measures.FIGURES
    ) - unknown
    falling = measures.measure(synthetic.write_run(tmp_path / "falling.h5", until=3.0))
    known = {name for name, value in falling.to_dict().items() if not math.isnan(value)}
    assert known == {
        *("mass", "early_speed", "early_bands", "early_islands"),
        *("peak_energy", "peak_time", "peak_speed", "fast_share", "peak_bands"),
    }
