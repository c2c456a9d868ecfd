"""Outlines: polygons, what is inside, and the lattice of points."""

import json
import math

import numpy as np
import pytest

from gimpslope.outline import Outline

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
L_SHAPE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]


def test_slope_of_the_study():
    slope = Outline.slope()
    np.testing.assert_allclose(slope.vertices, [(0, 0), (11, 0), (2, 9), (0, 9)], rtol=1e-15)
    assert slope.area == pytest.approx(9 * (11 + 2) / 2)
    assert slope.bounds == pytest.approx((0, 0, 11, 9))


def test_base_follows_from_the_angle():
    assert Outline.slope(height=3, crest=1, angle=30).bounds[2] == pytest.approx(1 + 3 * 3**0.5)
    assert Outline.slope(height=3, crest=1, angle=90).bounds[2] == pytest.approx(1)


def test_study_has_exactly_23490_points_in_rows_of_220_to_41():
    points = Outline.slope().lattice(0.05)
    assert points.shape == (23490, 2)
    _, rows = np.unique(np.round(points[:, 1] / 0.05 - 0.5).astype(int), return_counts=True)
    np.testing.assert_array_equal(rows, np.arange(220, 40, -1))


@pytest.mark.parametrize("shift", [(0, 0), (-3.7, 0.1), (1000.3, -57.1), (1e5 / 3, 1e5 / 7)])
@pytest.mark.parametrize("points_across", [11, 22, 55, 110, 220, 330, 440, 770, 880])
def test_face_is_inclusive_at_every_spacing_and_place(points_across, shift):
    spacing = 11 / points_across
    rows = round(9 / spacing)
    outline = Outline(Outline.slope().vertices + shift)
    assert len(outline.lattice(spacing)) == sum(points_across - row for row in range(rows))


def test_lattice_starts_half_a_spacing_from_the_corner_and_runs_row_by_row():
    points = Outline(np.add(SQUARE, (3, -2))).lattice(0.5)
    np.testing.assert_allclose(points, [(3.25, -1.75), (3.75, -1.75), (3.25, -1.25), (3.75, -1.25)])


def test_lattice_includes_the_right_and_top_edges():
    assert len(Outline([(0, 0), (1.5, 0), (1.5, 2.5), (0, 2.5)]).lattice(1.0)) == 6


def test_lattice_wider_than_the_outline_is_empty():
    assert Outline(SQUARE).lattice(3.0).shape == (0, 2)


def test_lattice_fills_the_area():
    outline = Outline([(0, 0), (5, 1), (6, 4), (2, 3), (1, 6)])
    assert len(outline.lattice(0.01)) * 0.01**2 == pytest.approx(outline.area, rel=1e-3)


def test_contains_edges_corners_and_nothing_beyond_the_tolerance():
    outline = Outline(L_SHAPE)
    inside = [(0, 0), (2, 0), (0.5, 1.9), (1, 1), (1.5, 1), (1, 1.5), (2 + 1e-9, 0.5)]
    outside = [(1.5, 1.5), (-0.1, 0), (2 + 1e-8, 0.5), (1.5, 1 + 1e-8), (3, 3)]
    assert outline.contains(inside).all()
    assert not outline.contains(outside).any()
    assert outline.contains(np.empty((0, 2))).shape == (0,)


def test_contains_agrees_with_half_planes():
    triangle = np.array([(0.1, 0.2), (3.0, 0.9), (1.2, 2.8)])
    points = np.random.default_rng(1).uniform(0, 3, (2000, 2))
    edge = np.roll(triangle, -1, axis=0) - triangle
    offset = points[:, None] - triangle
    left = edge[:, 0] * offset[..., 1] - edge[:, 1] * offset[..., 0] >= 0
    np.testing.assert_array_equal(Outline(triangle).contains(points), left.all(axis=1))


def test_direction_and_closing_vertex_do_not_matter_to_the_points():
    points = Outline(L_SHAPE).lattice(0.1)
    for vertices in (L_SHAPE[::-1], [*L_SHAPE, L_SHAPE[0]]):
        np.testing.assert_array_equal(Outline(vertices).lattice(0.1), points)
    assert len(Outline([*L_SHAPE, L_SHAPE[0]]).vertices) == 6


def test_vertices_are_a_read_only_copy():
    given = np.array(SQUARE, dtype=float)
    outline = Outline(given)
    given[0] = 0.5
    assert outline == Outline(SQUARE)
    with pytest.raises(ValueError, match="read-only"):
        outline.vertices[0] = 0.5


def test_equality_and_hash_follow_the_vertices():
    assert Outline(SQUARE) == Outline(np.array(SQUARE, dtype=np.float32))
    assert Outline(SQUARE) != Outline(L_SHAPE)
    assert Outline(SQUARE) != SQUARE
    assert hash(Outline(SQUARE)) == hash(Outline(np.where(SQUARE, SQUARE, -0.0)))


def test_round_trip_through_json_is_exact():
    outline = Outline(np.divide(L_SHAPE, 3) + math.pi)
    assert Outline.from_dict(json.loads(json.dumps(outline.to_dict()))) == outline


@pytest.mark.parametrize(
    ("vertices", "error", "text"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], ValueError, r"simple polygon.*Self-intersection\[0.5"),
        ([(0, 0), (1, 0), (2, 0)], ValueError, "simple polygon"),
        ([(0, 0), (0, 0), (0, 0)], ValueError, "vertices must be .* got"),
        ([(0, 0), (1, 0)], ValueError, "at least 3 distinct points, got 2"),
        ([(0, 0), (1, 0), (0, 0)], ValueError, "at least 3 distinct points, got 2"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], ValueError, r"shape \(k, 2\).*of shape \(3, 3\)"),
        ([0, 1, 2], ValueError, r"shape \(k, 2\), got \[0, 1, 2\] of shape \(3,\)"),
        ([(0, 0), (1, 0), (1, math.nan)], ValueError, "finite.*got nan"),
        ([(0, 0), (1, 0), (1, -math.inf)], ValueError, "finite.*got -inf"),
        ([(0, 0), (1,), (1, 1)], ValueError, r"got \[\(0, 0\), \(1,\)"),
        ([(True, False), (True, True), (False, True)], TypeError, "got .*True"),
        ("slope", TypeError, "got 'slope'"),
        (None, TypeError, "got None"),
    ],
)
def test_refuses_what_is_no_simple_polygon(vertices, error, text):
    with pytest.raises(error, match=text) as refusal:
        Outline(vertices)
    assert str(refusal.value).startswith("vertices must ")


@pytest.mark.parametrize(
    ("name", "value"),
    [("height", 0), ("height", math.nan), ("crest", 0), ("angle", 0), ("angle", 91)],
)
def test_slope_refusal_names_parameter_and_value(name, value):
    with pytest.raises(ValueError, match=f"^{name} must be .*, got {value}$"):
        Outline.slope(**{name: value})


@pytest.mark.parametrize("spacing", [0, -0.1, math.nan])
def test_lattice_refuses(spacing):
    with pytest.raises(ValueError, match=f"spacing must be .* got {spacing}"):
        Outline(SQUARE).lattice(spacing)


@pytest.mark.parametrize("points", [(0.5, 0.5), [(0.5, 0.5, 0.5)], [(0.5, math.nan)]])
def test_contains_refuses(points):
    with pytest.raises(ValueError, match=r"points must be .* of shape \(n, 2\), got"):
        Outline(SQUARE).contains(points)
