"""The study's stones: the paper's sizes and points, shared places, and distances kept."""

import math

import numpy as np
import pytest

from gimpslope.outline import Outline
from gimpslope.stones import Ellipse
from gimpslope.studies import reference_stones

SLOPE = Outline.slope()
KINDS = ("arbitrary", "round", "oval")
SEEDS = range(1, 6)

each_draw = pytest.mark.parametrize("seed", SEEDS)
each_kind = pytest.mark.parametrize("kind", KINDS)


@each_draw
@each_kind
def test_stones_hold_the_papers_points(kind, seed):
    counts = reference_stones.stones(kind, seed).point_counts(SLOPE, 0.05)
    assert counts.sum() == pytest.approx(4400, abs=10)
    assert counts.min() > 0


@each_draw
@each_kind
def test_stones_keep_a_tenth_of_a_metre(kind, seed):
    stones = reference_stones.stones(kind, seed)
    assert len(stones.outside(SLOPE)) == len(stones.overlaps()) == 0
    assert stones.gaps().min() >= 0.1 - 1e-9
    assert stones.margins(SLOPE).min() >= 0.1 - 1e-9


@each_draw
def test_rounds_and_ovals_have_exactly_the_papers_sizes(seed):
    rounds, ovals = (reference_stones.stones(kind, seed) for kind in ("round", "oval"))
    assert len(rounds) == len(ovals) == 48
    assert {stone.shape.axes for stone in rounds} == {(0.54, 0.54)}
    assert {stone.shape.axes for stone in ovals} == {(0.86, 0.34)}
    angles = np.array([stone.shape.angle for stone in ovals])
    # Any angle: 48 of them leave no 30 degrees out.
    assert np.diff(np.sort(angles)).max() < 30


@each_draw
def test_irregular_stones_are_of_mixed_size_and_have_the_area_of_the_rounds(seed):
    stones = reference_stones.stones("arbitrary", seed)
    assert stones.area == pytest.approx(48 * math.pi / 4 * 0.54**2, rel=1e-5)
    assert not any(isinstance(stone.shape, Ellipse) for stone in stones)
    large, small = stones.sizes[:48], stones.sizes[48:]
    assert len(small) == 32 and small.max() < 0.3 < 0.34 < large.min()
    assert large.max() > 1.5 * large.min() and large.max() > 0.54 > large.min()


@each_draw
def test_the_kinds_share_their_places(seed):
    arbitrary, rounds, ovals = (
        reference_stones.stones(kind, seed).centroids[:48] for kind in KINDS
    )
    np.testing.assert_array_equal(rounds, ovals)
    np.testing.assert_allclose(arbitrary, rounds, atol=2e-6)


@each_draw
@each_kind
def test_a_grid_of_half_the_resolution_still_holds_every_stone(kind, seed):
    assert reference_stones.stones(kind, seed).point_counts(SLOPE, 0.1).min() > 0


def test_seeds_differ():
    places = np.array([reference_stones.stones("round", seed).centroids for seed in SEEDS])
    assert len(np.unique(places.reshape(-1, 2), axis=0)) == 5 * 48


@pytest.mark.parametrize(
    ("kind", "seed", "error", "text"),
    [
        ("soil", 1, ValueError, "^kind must be one of 'arbitrary', 'round', 'oval', got 'soil'"),
        (None, 1, TypeError, "^kind must be .* got None"),
        ("oval", -1, ValueError, "^seed must be a whole number >= 0, got -1"),
        ("oval", 1.0, TypeError, "^seed must be a whole number >= 0, got 1.0"),
    ],
)
def test_refusals_name_the_parameter(kind, seed, error, text):
    with pytest.raises(error, match=text):
        reference_stones.stones(kind, seed)
