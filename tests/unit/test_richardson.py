"""Extrapolation finds limit and order of sequences that have them, and says so where not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gimpslope._check import FloatArray
from gimpslope.studies.richardson import extrapolate, extrapolate_means

CELLS = np.array([0.4, 0.2, 0.1, 0.05])


def found_on(order: float, scale: float) -> FloatArray:
    return np.asarray(7.0 + scale * CELLS**order)


@pytest.mark.parametrize("order", [0.7, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("scale", [3.0, -0.2])
def test_power_law(order: float, scale: float) -> None:
    found = extrapolate(found_on(order, scale))
    assert found.behaviour == "converges"
    assert found.orders == pytest.approx((order, order), rel=1e-6)
    assert found.limit == pytest.approx(7.0, rel=1e-9)
    alone = 1.25 * abs(scale) * 0.05**order
    assert found.uncertainty == pytest.approx(alone / 3, rel=1e-6)
    assert extrapolate(found_on(order, scale)[1:]).uncertainty == pytest.approx(alone, rel=1e-6)


def test_two_powers_lie_within_the_uncertainty() -> None:
    found = extrapolate(7.0 + 2.0 * CELLS + 3.0 * CELLS**2)
    assert found.behaviour == "converges"
    assert abs(found.limit - 7.0) < found.uncertainty


@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_limits_lie_within_what_a_fourth_grid_leaves(noise: float) -> None:
    """Of sums of two powers, the first of a trusted order, with noise as a share of what the
    coarsest grid is off by: 19 of 20 of the uncertainties that the fourth grid narrows hold."""
    rng = np.random.default_rng(1)
    hold = []
    for _ in range(6000):
        order = rng.uniform(0.6, 2.0)
        higher = order + rng.uniform(0.3, 1.5)
        cells = CELLS / CELLS[0]
        values = 7.0 + cells**order + rng.uniform(-1.5, 1.5) * cells**higher
        values += noise * rng.normal(size=4)
        found = extrapolate(values)
        if (
            found.behaviour == "converges"
            and found.uncertainty < extrapolate(values[1:]).uncertainty
        ):
            hold.append(abs(found.limit - 7.0) <= found.uncertainty)
    assert len(hold) > 1000 and np.mean(hold) >= 0.95


def test_a_fourth_grid_whose_limit_differs_counts() -> None:
    """Orders of 1.25 and then 1.07."""
    before, alone = extrapolate((0.0, 0.5, 0.71)), extrapolate((0.5, 0.71, 0.81))
    found = extrapolate((0.0, 0.5, 0.71, 0.81))
    assert found.limit == alone.limit
    assert found.uncertainty == 2 * abs(alone.limit - before.limit)
    assert alone.uncertainty / 3 < found.uncertainty < alone.uncertainty


@pytest.mark.parametrize(
    ("values", "behaviour"),
    [
        ((1.0, 2.0, 1.5), "oscillates"),
        ((1.0, 2.0, 4.0), "diverges"),
        ((1.0, 2.0, 3.0), "diverges"),
        ((1.0, 2.0, 2.01), "order not settled"),
        ((1.0, 2.0, 2.9), "order not settled"),
        ((1.0, 2.0, 2.0), "order not settled"),
    ],
)
def test_what_does_not_converge_says_so(values: tuple[float, ...], behaviour: str) -> None:
    found = extrapolate(values)
    assert found.behaviour == behaviour
    assert math.isnan(found.limit) == (behaviour in ("oscillates", "diverges"))
    assert found.uncertainty >= 3 * (max(values) - min(values)) * (1 - 1e-12)


def test_results_that_agree_have_converged() -> None:
    found = extrapolate((3.0, 3.0, 3.0))
    assert (found.limit, found.uncertainty, found.behaviour) == (3.0, 0.0, "converges")


def test_refused() -> None:
    with pytest.raises(ValueError, match=r"values must be of at least three grids, got 2"):
        extrapolate((1.0, 2.0))


def test_means_over_draws() -> None:
    """Of the finest grids in a row on which all draws have a value."""
    mean = 7.0 + CELLS
    draws = np.stack([mean - 1, mean + 1], axis=1)
    expected = extrapolate(mean[1:])
    draws[0, 1] = math.nan
    found = extrapolate_means(draws)
    assert found is not None and found.orders == pytest.approx(expected.orders)
    assert found.limit == pytest.approx(7.0)
    draws[1, 0] = math.nan
    assert extrapolate_means(draws) is None
    assert extrapolate_means(np.full((4, 2), math.nan)) is None
    draws = np.stack([mean, mean], axis=1)
    draws[-1, 0] = math.nan
    assert extrapolate_means(draws) is None
