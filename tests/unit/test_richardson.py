"""Extrapolation finds limit and order of sequences that have them, and says so where not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gimpslope.studies.richardson import extrapolate, extrapolate_means

CELLS = np.array([0.4, 0.2, 0.1, 0.05])


@pytest.mark.parametrize("order", [0.7, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("scale", [3.0, -0.2])
def test_power_law(order: float, scale: float) -> None:
    found = extrapolate(7.0 + scale * CELLS**order)
    assert found.behaviour == "converges"
    assert found.orders == pytest.approx((order, order), rel=1e-6)
    assert found.limit == pytest.approx(7.0, rel=1e-9)
    assert found.uncertainty == pytest.approx(1.25 * abs(scale) * 0.05**order, rel=1e-6)


def test_two_powers_lie_within_the_uncertainty() -> None:
    found = extrapolate(7.0 + 2.0 * CELLS + 3.0 * CELLS**2)
    assert found.behaviour == "converges"
    assert abs(found.limit - 7.0) < found.uncertainty


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
