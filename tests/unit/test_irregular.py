"""Irregular outlines: area, centroid, aspect and roundness are as asked for, for any seed."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from gimpslope.stones.drawing.irregular import outline

EVERY = {
    "seed": st.integers(0, 2**32),
    "corners": st.integers(3, 40),
    "roundness": st.floats(0, 1),
    "aspect": st.floats(1, 5),
}


def draw(seed, corners=7, roundness=0.3, aspect=1.5):
    return outline(np.random.default_rng(seed), corners, roundness, aspect)


def radii_of_gyration(vertices):
    """Along x and y, and the product moment, by a fan of triangles around the origin.

    The mean of q_i q_j over a triangle with a corner at 0 and the others at a and b is
    (2 a_i a_j + 2 b_i b_j + a_i b_j + b_i a_j) / 12.
    """
    a, b = vertices, np.roll(vertices, -1, axis=0)
    share = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    mean = 2 * a[:, :, None] * a[:, None] + 2 * b[:, :, None] * b[:, None]
    mean += a[:, :, None] * b[:, None] + b[:, :, None] * a[:, None]
    moments = np.einsum("n,nij->ij", share, mean / 12)
    return math.sqrt(moments[0, 0]), math.sqrt(moments[1, 1]), moments[0, 1]


def isoperimetric_quotient(vertices):
    polygon = shapely.Polygon(vertices)
    return 4 * math.pi * polygon.area / polygon.length**2


@given(**EVERY)
def test_simple_counterclockwise_of_area_one_around_the_origin(seed, corners, roundness, aspect):
    polygon = shapely.Polygon(draw(seed, corners, roundness, aspect))
    assert polygon.is_valid
    assert polygon.exterior.is_ccw
    assert polygon.area == pytest.approx(1, rel=1e-12)
    assert (polygon.centroid.x, polygon.centroid.y) == pytest.approx((0, 0), abs=1e-12)


@given(**EVERY)
def test_every_point_is_seen_from_the_centroid(seed, corners, roundness, aspect):
    x, y = draw(seed, corners, roundness, aspect).T
    assert np.all(x * np.roll(y, -1) - y * np.roll(x, -1) > 0)


@given(**EVERY)
def test_aspect_is_met_with_the_long_axis_along_x(seed, corners, roundness, aspect):
    along, across, product = radii_of_gyration(draw(seed, corners, roundness, aspect))
    assert along / across == pytest.approx(aspect, rel=1e-12)
    assert product == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("aspect", [1.0, 2.0])
def test_extents_follow_the_aspect(aspect):
    ratios = [np.divide(*np.ptp(draw(seed, 8, 0.5, aspect), axis=0)) for seed in range(300)]
    assert np.median(ratios) == pytest.approx(aspect, rel=0.02)
    assert np.min(ratios) > 0.7 * aspect
    assert np.max(ratios) < 1.4 * aspect


@pytest.mark.parametrize("corners", [3, 4, 5, 8])
def test_rounder_means_a_larger_isoperimetric_quotient(corners):
    for seed in range(100):
        quotients = [
            isoperimetric_quotient(draw(seed, corners, roundness))
            for roundness in (0, 0.1, 0.3, 0.6, 1)
        ]
        assert np.all(np.diff(quotients) > 0)


@pytest.mark.parametrize("corners", [3, 6, 11, 20])
def test_sharp_outlines_have_the_corners_asked_for(corners):
    for seed in range(100):
        vertices = draw(seed, corners, roundness=0)
        sides = np.roll(vertices, -1, axis=0) - vertices
        assert len(vertices) == corners
        assert np.linalg.norm(sides, axis=1).min() > 0.1 / corners


def test_a_triangle_of_equal_radii_of_gyration_is_equilateral():
    for seed in range(20):
        sides = np.diff(draw(seed, 3, roundness=0, aspect=1), axis=0, append=np.nan)[:2]
        assert np.linalg.norm(sides, axis=1) ** 2 == pytest.approx(4 / math.sqrt(3))


def turns(vertices):
    side = np.roll(vertices, -1, axis=0) - vertices
    back = np.roll(side, 1, axis=0)
    cross = back[:, 0] * side[:, 1] - back[:, 1] * side[:, 0]
    return np.degrees(np.arctan2(cross, np.sum(back * side, axis=1)))


def test_full_roundness_leaves_no_corner_and_none_leaves_them_all():
    for seed in range(50):
        assert np.abs(turns(draw(seed, 4, roundness=1, aspect=1))).max() < 25
        assert np.abs(turns(draw(seed, 4, roundness=0, aspect=1))).max() > 80


@pytest.mark.parametrize("corners", [3, 5, 9])
@pytest.mark.parametrize("roundness", [0.05, 0.4, 0.95])
def test_arcs_take_up_their_share_of_the_sides(corners, roundness):
    arcs = draw(4, corners, roundness).reshape(corners, -1, 2)
    first, middle, last = arcs[:, 0], arcs[:, arcs.shape[1] // 2], arcs[:, -1]
    corner = 2 * middle - (first + last) / 2  # of a quadratic arc, B(1/2) = (A + 2 C + D) / 4
    straight = np.linalg.norm(np.roll(first, -1, axis=0) - last, axis=1)
    side = np.linalg.norm(np.roll(corner, -1, axis=0) - corner, axis=1)
    np.testing.assert_allclose(straight / side, 1 - roundness, rtol=1e-9)


def test_a_seed_gives_the_same_outline_and_another_seed_another():
    np.testing.assert_array_equal(draw(5), draw(5))
    assert not np.allclose(draw(5), draw(6))


@pytest.mark.parametrize(
    ("corners", "roundness", "aspect", "error", "text"),
    [
        (2, 0.3, 1.5, ValueError, "^corners must be a whole number >= 3, got 2"),
        (5.0, 0.3, 1.5, TypeError, "^corners must be a whole number >= 3, got 5.0"),
        (5, -0.1, 1.5, ValueError, r"^roundness must be a number in \[0, 1\], got -0.1"),
        (5, 1.01, 1.5, ValueError, r"^roundness must be a number in \[0, 1\], got 1.01"),
        (5, 0.3, 0.99, ValueError, "^aspect must be a finite number >= 1, got 0.99"),
        (5, 0.3, math.inf, ValueError, "^aspect must be a finite number >= 1, got inf"),
        (5, 0.3, "2", TypeError, "^aspect must be a finite number >= 1, got '2'"),
    ],
)
def test_refusal_names_parameter_and_value(corners, roundness, aspect, error, text):
    with pytest.raises(error, match=text):
        outline(np.random.default_rng(1), corners, roundness, aspect)


def test_refuses_what_is_no_generator():
    with pytest.raises(TypeError, match=r"^rng must be a numpy\.random\.Generator, got 7"):
        outline(7, 5, 0.3, 1.5)
