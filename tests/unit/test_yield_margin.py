"""Stones that cannot yield are not asked whether they do, and nothing depends on it."""

import numpy as np
import pytest

import gimpslope as gs
from gimpslope.studies.bench.cases import Case

STEPS = 800
FIELDS = ("position", "velocity", "stress", "volume", "plastic_strain")


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("instruction_set", gs.kernel.instruction_sets())
def test_the_bits_are_those_of_a_run_that_asks_every_point_in_every_step(
    instruction_set: str, precision: str
) -> None:
    case = Case(points=3000, stones=0.4, instruction_set=instruction_set, precision=precision)
    bounded, asked = case.solver(), case.solver()
    bounded.advance(STEPS)
    for _ in range(STEPS):
        asked.advance(1)  # stresses may be set between calls: no bound outlives one
    for field in FIELDS:
        np.testing.assert_array_equal(getattr(bounded, field), getattr(asked, field), field)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_rows_within_one_call_have_the_bits_of_a_call_each(precision: str) -> None:
    case = Case(points=3000, stones=0.4, precision=precision)
    together, apart = case.solver(), case.solver()
    times = np.linspace(0.0, 0.1, 41)[1:]
    together.advance_through(times)
    for time in times:
        apart.advance_to(time)
    assert together.steps == apart.steps > 2 * len(times)
    for field in FIELDS:
        np.testing.assert_array_equal(getattr(together, field), getattr(apart, field), field)


def test_its_stones_begin_to_yield_one_after_the_other() -> None:
    solver = Case(points=3000, stones=0.4).solver()
    stones = solver.material == 1
    yielding = []
    for _ in range(2):
        solver.advance(STEPS // 2)
        yielding.append(int((solver.plastic_strain[stones] > 0).sum()))
    assert 0 < yielding[0] < yielding[1] < stones.sum() / 10
