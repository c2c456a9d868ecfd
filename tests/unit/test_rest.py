"""When a slide has come to rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import gimpslope as gs
from gimpslope.rest import Rest
from gimpslope.studies import reference

SLIDE = gs.Slide(10.0).until_rest()
INTERVAL = 0.005


def end_of(front: Callable[[float], float], kinetic: Callable[[float], float]) -> float:
    """When a slide ends whose front is at front(t) and whose energy is kinetic(t); one point stays
    behind."""
    time = 0.0
    rest = Rest(SLIDE, lambda: np.array([(0.0, 0.0), (5.0 + front(time), 0.0)]))
    for number in range(1, round(SLIDE.duration / INTERVAL) + 1):
        time = number * INTERVAL
        if rest.reached({"time": time, "kinetic": kinetic(time), "max_speed": 0.0}):
            return time
    return SLIDE.duration


def stopping(time: float) -> float:
    return max(0.0, np.sin(np.pi * min(time, 2.0) / 2.0))


def test_front_that_stops_ends_the_slide() -> None:
    """After the half second in which it is looked at, and the swing of its energy before."""
    calm = 2.0 - 2.0 / np.pi * np.arcsin(SLIDE.rest_ratio)
    stops = end_of(lambda t: 4.0 * (1 - np.cos(np.pi * min(t, 2.0) / 2.0)), stopping)
    assert calm + SLIDE.rest_time <= stops <= 2.0 + SLIDE.rest_time + 0.1


@pytest.mark.parametrize("tau", [0.5, 1.0, 2.0, 5.0])
def test_front_that_creeps_is_followed_until_what_it_has_to_go_is_small(tau: float) -> None:
    """u = 8 m (1 - e^(-t / tau)): linear extrapolation overstates what is to come, so that the
    change left is less than asked for; it ends before the duration if it can."""

    def front(time: float) -> float:
        return 8.0 * (1 - np.exp(-time / tau))

    stops = end_of(front, stopping)
    assert 1 - front(stops) / front(10.0) < SLIDE.rest_change
    rate = np.exp(-(8.5 - SLIDE.rest_time) / tau) / tau
    if rate * 1.5 < SLIDE.rest_change:
        assert stops <= 8.6


def test_front_that_swings_is_not_at_rest() -> None:
    """Though it is where it was after every half second."""
    stops = end_of(lambda t: 8.0 + 0.05 * np.sin(2 * np.pi * t / SLIDE.rest_time), stopping)
    assert stops > 9.5


def test_quiet_moment_is_not_rest() -> None:
    """A slope that stops for less than half a second and goes on, twice."""
    moving = lambda t: abs(np.sin(np.pi * t / 3.0)) if t < 6.0 else 0.0  # noqa: E731
    assert end_of(lambda t: min(t, 6.0), moving) >= 6.0 + SLIDE.rest_time


def figures(run: gs.Run) -> np.ndarray:
    summary = run.summary
    names = ("peak_kinetic_energy", "time_of_peak", "speed_at_peak")
    return np.array([*(summary[name] for name in names), *run.max_displacement(), run.run_out()])


CASES = [(name, reading, 0.2) for name in reference.SLOPES for reading in reference.READINGS]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "reading", "cell"), [*CASES, ("soil", "literal", 0.1)])
def test_figures_at_rest_are_those_of_the_end(
    name: str, reading: str, cell: float, tmp_path: Path
) -> None:
    """Within 0.2 % of those after 10 s."""
    setup = reference.setup(name, reading=reading, cell=cell, stone_model=model_of(name))
    whole = setup.simulate(tmp_path / "whole.h5", progress=False)
    stages = replace(setup.stages, slide=setup.stages.slide.until_rest())
    short = replace(setup, stages=stages).simulate(tmp_path / "short.h5", progress=False)
    off = figures(short) / figures(whole) - 1
    print(f"{name} {reading} {cell} m: {short.status_detail}, off by {100 * abs(off).max():.3f} %")
    assert abs(off).max() < 0.002
    assert "at rest" in short.status_detail
    assert short.energy.time[-1] < (6.5 if reading == "literal" else 10.0)


def model_of(name: str) -> str:
    return "deformable" if name == "soil" else "rigid"
