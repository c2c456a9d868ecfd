"""Stones as data: ellipses, overlaps and distances held against known geometry, collections."""

import itertools
import json
import math
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

from gimpslope.materials import Elastic
from gimpslope.outline import Outline
from gimpslope.stones import Ellipse, Stone, Stones, contact

GRANITE = Elastic(density=2600, young=50e9, poisson=0.25)
CHALK = Elastic(density=2000, young=5e9, poisson=0.25)
SLOPE = Outline.slope()
TRIANGLE = [(0, 0), (1, 0), (0, 1)]


def box(x, y, width, height):
    return Outline([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])


def edge_of(ellipse, n=100_000):
    turns = np.linspace(0, 2 * np.pi, n)
    circle = np.stack([np.cos(turns), np.sin(turns)])
    return (ellipse.half_axes @ circle).T + ellipse.centre


def furthest(ellipse, normal):
    """The point of an ellipse that is furthest along a direction, S S^T n / |S^T n|."""
    half = ellipse.half_axes
    return ellipse.centre + half @ (half.T @ normal) / np.hypot(*(half.T @ normal))


def touching(aspect, seed, gap=0.0):
    """Two ellipses with a common tangent, `gap` apart across it."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(0, 360, 3)
    normal = np.array([math.cos(angles[2]), math.sin(angles[2])])
    first = Ellipse(rng.uniform(-3, 3, 2), (1.0, 1.0 / aspect), angles[0])
    at_origin = Ellipse((0, 0), (0.7, 0.7 / rng.uniform(1, aspect)), angles[1])
    place = furthest(first, normal) + gap * normal - furthest(at_origin, -normal)
    return first, Ellipse(place, at_origin.axes, at_origin.angle)


def test_ellipse_is_where_its_parameters_say():
    ellipse = Ellipse((3, 1), (4, 2), 30)
    cos, sin = math.cos(math.pi / 6), math.sin(math.pi / 6)
    ends = [(3 + 2 * cos, 1 + 2 * sin), (3 - sin, 1 + cos), (3 - 2 * cos, 1 - 2 * sin)]
    assert ellipse.contains(ends).all()
    beyond = np.array([3, 1]) + (1 + 1e-8) * np.subtract(ends, (3, 1))
    assert not ellipse.contains(beyond).any()
    assert ellipse.area == pytest.approx(2 * math.pi)
    assert ellipse.centroid == (3, 1)


@pytest.mark.parametrize("angle", [0, 17, 45, 90, -100, 400])
def test_bounds_of_an_ellipse_are_its_extremes(angle):
    ellipse = Ellipse((0.5, -2), (0.86, 0.34), angle)
    edge = edge_of(ellipse)
    low, high = np.reshape(ellipse.bounds, (2, 2))
    np.testing.assert_allclose(low, edge.min(axis=0), atol=1e-8)
    np.testing.assert_allclose(high, edge.max(axis=0), atol=1e-8)


def test_ellipse_contains_what_its_equation_says():
    ellipse = Ellipse((0.3, 0.2), (2, 0.5), 70)
    points = np.random.default_rng(1).uniform(-1.5, 1.5, (5000, 2))
    turn = math.radians(70)
    x, y = (points - (0.3, 0.2)).T
    along, across = math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x
    np.testing.assert_array_equal(ellipse.contains(points), along**2 + (across / 0.25) ** 2 <= 1)
    assert ellipse.contains(np.empty((0, 2))).shape == (0,)


def test_polygon_of_an_ellipse_is_inscribed_and_fine():
    ellipse = Ellipse((1, 2), (0.86, 0.34), 25)
    assert ellipse.polygon.area == pytest.approx(ellipse.area, rel=1.1e-4)
    assert ellipse.contains(np.array(ellipse.polygon.exterior.coords)).all()


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("centre", (0, math.nan), ValueError),
        ("centre", (0, 0, 0), ValueError),
        ("centre", "origin", TypeError),
        ("axes", (1, 0), ValueError),
        ("axes", (-1, 1), ValueError),
        ("axes", 1.0, ValueError),
        ("angle", math.inf, ValueError),
        ("angle", None, TypeError),
    ],
)
def test_ellipse_refusal_names_the_parameter(name, value, error):
    with pytest.raises(error, match=f"^{name}.* must be .*got"):
        Ellipse(**{"centre": (0, 0), "axes": (1, 1), name: value})


@pytest.mark.parametrize("aspect", [1.0, 2.5, 20.0, 1000.0])
@pytest.mark.parametrize("seed", range(20))
def test_ellipses_that_touch_do_not_overlap_but_those_a_hair_nearer_do(aspect, seed):
    assert len(Stones(touching(aspect, seed)).overlaps()) == 0
    assert len(Stones(touching(aspect, seed, gap=1e-7)).overlaps()) == 0
    np.testing.assert_array_equal(Stones(touching(aspect, seed, gap=-1e-7)).overlaps(), [(0, 1)])


@pytest.mark.parametrize("aspect", [1.0, 2.5, 20.0, 1000.0])
@pytest.mark.parametrize("gap", [1e-6, 0.1, 30.0])
def test_distance_of_ellipses_is_that_of_their_parallel_tangents(aspect, gap):
    for seed in range(20):
        np.testing.assert_allclose(
            Stones(touching(aspect, seed, gap)).gaps(), gap, rtol=0, atol=1e-12
        )
    assert (Stones(touching(aspect, 1, -0.01)).gaps() == 0).all()


def test_an_ellipse_within_another_overlaps_it():
    inner, outer = Ellipse((0.1, 0), (0.2, 0.1), 20), Ellipse((0, 0), (2, 1), 50)
    assert len(Stones([inner, outer]).overlaps()) == 1
    assert len(Stones([outer, outer]).overlaps()) == 1
    assert (Stones([outer, outer]).gaps() == 0).all()
    assert (Stones([inner, outer]).gaps() == 0).all()


@pytest.mark.parametrize("angle", [0, 35, 90])
@pytest.mark.parametrize("side", [(-1, 0), (0, -1), (math.sqrt(0.5), math.sqrt(0.5))])
def test_ellipse_within_the_slope_up_to_its_face(angle, side):
    side = np.array(side)
    corner = {-1: (0.0, 4.0), 0: (3.0, 0.0)}.get(side[0], (6.5, 4.5))
    at_origin = Ellipse((0, 0), (0.86, 0.34), angle)

    def at(margin):
        place = corner - furthest(at_origin, side) - margin * side
        return Stones([Ellipse(place, at_origin.axes, angle)])

    assert len(at(0.0).outside(SLOPE)) == 0
    assert len(at(1e-7).outside(SLOPE)) == 0
    np.testing.assert_array_equal(at(-1e-7).outside(SLOPE), [0])
    np.testing.assert_allclose(at(0.25).margins(SLOPE), 0.25, atol=1e-12)


def test_ellipse_in_a_notched_outline():
    notched = Outline([(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)])
    clear, at_notch = Ellipse((2, 0.5), (1, 1)), Ellipse((2, 0.5 + 1e-6), (1, 1))
    np.testing.assert_array_equal(Stones([clear, at_notch]).outside(notched), [1])
    np.testing.assert_array_equal(Stones([Ellipse((2, 3), (0.1, 0.1))]).outside(notched), [0])
    assert Stones([Ellipse((2, 0.5), (0.5, 0.5))]).margins(notched) == pytest.approx(0.25)


def test_margins_refuse_a_stone_outside():
    stones = Stones([Ellipse((1, 1), (1, 1)), Ellipse((0.4, 3), (1, 1)), box(9, 5, 1, 1)])
    with pytest.raises(ValueError, match=r"stones must lie within the outline, got \[1, 2\] out"):
        stones.margins(SLOPE)


@pytest.mark.parametrize(
    ("ellipse", "overlaps", "distance"),
    [
        (Ellipse((0.5, 0.5), (0.1, 0.2)), True, 0),  # inside the box
        (Ellipse((0.5, 0.5), (9, 8), 10), True, 0),  # around it
        (Ellipse((1.2, 0.5), (1, 0.1)), True, 0),  # across a side
        (Ellipse((1.5, 0.5), (1, 0.2)), False, 0),  # touches a side
        (Ellipse((1.5 + 1e-6, 0.5), (1, 0.2)), False, 1e-6),
        (Ellipse((1.5 - 1e-6, 0.5), (1, 0.2)), True, 0),
        (Ellipse((4, 5), (4, 4)), False, 3),  # nearest to a corner: 5 - 2
        (Ellipse((0.5, -2), (8, 2), 90), True, 0),
        (Ellipse((0.5, -3), (2, 5)), False, 0.5),
    ],
)
def test_ellipse_and_box(ellipse, overlaps, distance):
    for stones in (Stones([box(0, 0, 1, 1), ellipse]), Stones([ellipse, box(0, 0, 1, 1)])):
        assert stones.overlaps().tolist() == [[0, 1]] * overlaps
        np.testing.assert_allclose(stones.gaps(), distance, atol=1e-12)


def test_boxes_may_touch_and_share_corners():
    stones = Stones([box(0, 0, 1, 1), box(1, 0, 1, 1), box(1, 1, 1, 1), box(2 - 1e-6, 0, 1, 1)])
    np.testing.assert_array_equal(stones.overlaps(), [(1, 3)])


def test_distances_against_points_on_the_edges():
    rng = np.random.default_rng(5)
    shapes = [
        Ellipse(rng.uniform(0, 6, 2), rng.uniform(0.3, 2, 2), rng.uniform(0, 180))
        for _ in range(12)
    ]
    stones = Stones(shapes)
    edges = [edge_of(shape, 1000) for shape in shapes]
    for number, gap in enumerate(stones.gaps()):
        others = np.concatenate([edge for n, edge in enumerate(edges) if n != number])
        nearest = min(np.hypot(*(others - point).T).min() for point in edges[number][::4])
        overlapped = (stones.overlaps() == number).any()
        assert gap == (0 if overlapped else pytest.approx(nearest, abs=1e-3))
    assert 0 < (stones.gaps() == 0).sum() < 12


def test_gaps_of_many_shapes_are_the_least_of_all_pairs():
    rng = np.random.default_rng(2)
    stones = Stones.of_ellipses(
        rng.uniform(0, 9, (30, 2)), rng.uniform(0.05, 1, (30, 2)), rng.uniform(0, 180, 30)
    ) + Stones([box(*place, 0.3, 0.2) for place in rng.uniform(0, 9, (10, 2))])
    pairs = list(itertools.product(stones.shapes, repeat=2))
    apart = contact.distance(pairs).reshape(len(stones), len(stones))
    np.fill_diagonal(apart, np.inf)
    np.testing.assert_allclose(stones.gaps(), apart.min(axis=1), atol=1e-12)


def test_a_single_stone_has_no_neighbour():
    assert Stones([box(0, 0, 1, 1)]).gaps() == [math.inf]
    assert len(Stones().gaps()) == len(Stones().overlaps()) == len(Stones().outside(SLOPE)) == 0


def test_numbers_are_those_of_the_stones_that_contain_the_points():
    rng = np.random.default_rng(3)
    stones = Stones.of_ellipses(
        rng.uniform(0, 5, (20, 2)), rng.uniform(0.1, 2, (20, 2)), rng.uniform(0, 180, 20)
    ) + Stones([box(1, 1, 1, 1), Outline([(0, 0), (3, 0), (0, 3)])])
    points = rng.uniform(-0.5, 5.5, (3000, 2))
    held = np.array([stone.contains(points) for stone in stones])
    last = np.where(held.any(axis=0), len(stones) - 1 - held[::-1].argmax(axis=0), -1)
    numbers = stones.numbers(points)
    np.testing.assert_array_equal(numbers, last)
    assert numbers.dtype == np.int32
    assert (numbers == -1).any() and (numbers == 21).any()


def test_a_point_on_two_edges_is_of_the_later_stone():
    stones = Stones([box(0, 0, 1, 1), box(1, 0, 1, 1), Ellipse((2.5, 0.5), (1, 1))])
    np.testing.assert_array_equal(
        stones.numbers([(0, 0), (1, 0.5), (2, 0.5), (3, 0.5), (3.1, 0.5), (0, 1 + 1e-10)]),
        [0, 1, 2, 2, -1, 0],
    )


def test_content_by_area_and_by_points():
    stones = Stones([box(0, 0, 0.5, 1), Ellipse((1.5, 0.5), (0.8, 0.8))])
    slope = box(0, 0, 2, 1)
    area = 0.5 + math.pi * 0.16
    assert stones.area == pytest.approx(area)
    assert stones.content(slope) == pytest.approx(area / 2)
    assert stones.point_content(slope, 0.01) == pytest.approx(area / 2, abs=1e-3)
    counts = stones.point_counts(slope, 0.01)
    assert counts[0] == 50 * 100
    assert counts[1] == pytest.approx(math.pi * 1600, rel=5e-3)
    np.testing.assert_array_equal(
        Stones([box(0, 0, 1, 1), box(5, 5, 1, 1)]).point_counts(slope, 0.5), [4, 0]
    )


def test_content_is_of_the_union_within_the_outline():
    slope = box(0, 0, 4, 2)
    assert Stones([Ellipse((50, 50), (1, 0.5))]).content(slope) == 0
    assert Stones([box(3, 0, 2, 1)]).content(slope) == pytest.approx(1 / 8)
    assert Stones([box(0, 0, 2, 1), box(1, 0, 2, 1)]).content(slope) == pytest.approx(3 / 8)
    assert Stones([box(0, 0, 1, 1)] * 3).content(slope) == pytest.approx(1 / 8)
    half = Stones([Ellipse((0, 1), (1, 1)), Ellipse((3, 1), (1, 0.5))])
    area = math.pi / 4 * (0.5 + 0.5)
    assert half.content(slope) == pytest.approx(area / 8, rel=1e-4)
    assert half.content(slope) == pytest.approx(half.point_content(slope, 0.005), abs=1e-3)
    touching = Stones([box(0, 0, 1, 1), box(1, 0, 1, 1), Ellipse((3, 0.5), (1, 1))])
    assert touching.content(slope) == touching.area / 8


def test_sizes_are_diameters_of_circles_of_equal_area():
    stones = Stones([Ellipse((0, 0), (0.54, 0.54)), Ellipse((2, 0), (4, 1)), box(5, 0, 2, 2)])
    np.testing.assert_allclose(stones.sizes, [0.54, 2, 4 / math.sqrt(math.pi)])
    assert stones.mean_size == pytest.approx(stones.sizes.mean())
    np.testing.assert_allclose(stones.centroids, [(0, 0), (2, 0), (6, 1)], atol=1e-15)
    with pytest.raises(ValueError, match="stones must not be empty for a mean size"):
        _ = Stones().mean_size


def test_mass_takes_each_material_and_the_default_for_those_without():
    stones = Stones([Stone(box(0, 0, 2, 1), GRANITE), Stone(box(3, 0, 1, 1))])
    assert stones.mass(CHALK) == pytest.approx(2 * 2600 + 2000)
    assert stones.with_material(CHALK).mass(GRANITE) == pytest.approx(3 * 2000)
    assert stones[0].material is GRANITE
    with pytest.raises(ValueError, match=r"material must be given, for stones\[1\] has none"):
        stones.mass()


def test_slices_and_sums_are_stones():
    stones = Stones.of_ellipses([(0, 0), (2, 0), (4, 0)], (1, 0.5), material=GRANITE)
    assert isinstance(stones[1], Stone) and isinstance(stones[:2], Stones)
    assert stones[:1] + stones[1:] == stones
    assert stones + Stones([box(9, 0, 1, 1)]) == Stones([*stones, box(9, 0, 1, 1)])
    assert [stone.shape.centre[0] for stone in stones] == [0, 2, 4]
    assert len(stones) == 3 and stones[2] in stones and not Stones()
    assert hash(stones) == hash(Stones(list(stones)))


def test_sums_with_lists_either_way():
    stones, none, shapes = Stones([box(0, 0, 1, 1)]), [], [Ellipse((3, 0), (1, 1))]
    assert shapes + stones == Stones([*shapes, *stones])
    assert stones + shapes == Stones([*stones, *shapes])
    assert none + stones == stones == stones + none
    with pytest.raises(TypeError, match=r"^stones must be a sequence of .* got 3"):
        3 + stones


def test_index_arrays_and_masks_choose_stones():
    stones = Stones.of_ellipses([(0, 0), (2, 0), (4, 0)], [(1, 1), (0.2, 0.2), (2, 2)])
    assert stones[stones.sizes > 0.5] == stones[[0, 2]] == stones[::2]
    assert stones[np.array([2, -1, 0])] == Stones([stones[2], stones[2], stones[0]])
    assert stones[[]] == stones[[False] * 3] == stones[np.array([])] == Stones()
    assert isinstance(stones[np.argmax(stones.sizes)], Stone)
    with pytest.raises(IndexError):
        stones[[True, False]]
    with pytest.raises(IndexError):
        stones[[3]]


def test_empty_lists_are_no_stones():
    assert Stones.of_ellipses([], (1, 0.5)) == Stones.of_ellipses([], [], []) == Stones()
    assert Stones.of_polygons([]) == Stones()
    none = Stones()
    assert none.content(SLOPE) == none.point_content(SLOPE, 1) == none.mass() == none.area == 0
    assert none.margins(SLOPE).shape == none.sizes.shape == none.point_counts(SLOPE, 1).shape
    assert len(Stones([box(0, 0, 1, 1)]).numbers([])) == 0


def test_arrays_spread_over_the_stones():
    stones = Stones.of_ellipses([(0, 0), (2, 0)], [(1, 0.5), (2, 1)], [10, 20])
    assert stones[1] == Stone(Ellipse((2, 0), (2, 1), 20))
    assert Stones.of_ellipses(np.empty((0, 2)), (1, 1)) == Stones()
    triangles = Stones.of_polygons([[(0, 0), (1, 0), (0, 1)], [(3, 0), (4, 0), (4, 1), (3, 1)]])
    np.testing.assert_allclose(triangles.areas, [0.5, 1])


@pytest.mark.parametrize(
    ("make", "error", "text"),
    [
        (lambda: Stones(3), TypeError, "^stones must be a sequence of .* got 3"),
        (lambda: Stones([box(0, 0, 1, 1), "b"]), TypeError, r"^stones\[1\] must be .* got 'b'"),
        (lambda: Stone((0, 1)), TypeError, r"^shape must be an Outline or .* got \(0, 1\)"),
        (lambda: Stone(box(0, 0, 1, 1), 3), TypeError, "^material must be .* got 3"),
        (lambda: Stones.of_ellipses([(0, 0)], [(1, 1)] * 2), ValueError, r"^axes .*\(1, 2\), got"),
        (lambda: Stones.of_ellipses([(0, 0)], 1.0), ValueError, r"^axes must .*\(1, 2\), got 1.0"),
        (lambda: Stones.of_ellipses([(0, 0)], (1, 1), [1, 2]), ValueError, r"^angles .*\(1\), got"),
        (lambda: Stones.of_ellipses([(0, 0)], [(1, 1), 1]), ValueError, r"^axes must .*got"),
        (lambda: Stones.of_ellipses([0, 0], (1, 1)), ValueError, "^centres must .*got"),
        (
            lambda: Stones.of_ellipses([(1, 1), (2, 2)], [(1, -1), (1, 1)]),
            ValueError,
            r"^axes\[0\]\[1\] must .*got -1.0",
        ),
        (lambda: Stones.of_ellipses([(0, 0)], []), ValueError, r"^axes must .*\(1, 2\), got"),
        (lambda: Stones.of_polygons(3), TypeError, "^polygons must be a sequence of .*got 3"),
        (
            lambda: Stones.of_polygons([[(0, 0), (1, 0)]]),
            ValueError,
            r"^polygons\[0\]: vertices must be .*got 2",
        ),
        (
            lambda: Stones.of_polygons([TRIANGLE, [(0, 0), (1, 1), (1, 0), (0, 1)]]),
            ValueError,
            r"^polygons\[1\]: vertices must form a simple polygon, got one with Self-inter",
        ),
        (
            lambda: Stones.of_polygons([TRIANGLE, TRIANGLE[0]]),
            ValueError,
            r"^polygons\[1\] must be an array of finite numbers of shape \(k, 2\), got .*\(2,\)",
        ),
        (lambda: Stones().content("x"), TypeError, "^outline must be an Outline, got 'x'"),
        (lambda: Stones().outside("x"), TypeError, "^outline must be an Outline, got 'x'"),
        (lambda: Stones().margins("x"), TypeError, "^outline must be an Outline, got 'x'"),
        (lambda: Stones().point_content("x", 1), TypeError, "^outline must be an Outline, got"),
        (lambda: Stones().point_counts("x", 1), TypeError, "^outline must be an Outline, got"),
        (lambda: Stones().plot(outline="x"), TypeError, "^outline must be an Outline, got"),
        (lambda: Stones()[[0.5]], TypeError, "^index must be .*got float64 of shape"),
        (lambda: Stones()[np.zeros((1, 2), int)], TypeError, r"^index must be .*of shape \(1, 2"),
        (lambda: Stones([box(0, 0, 1, 1)]).numbers([0, 1]), ValueError, "^points must be .*got"),
        (lambda: Stones().point_counts(SLOPE, 0), ValueError, "^spacing must be .*got 0"),
    ],
)
def test_refusals_name_the_parameter(make, error, text):
    with pytest.raises(error, match=text):
        make()


def test_round_trip_through_json():
    stones = Stones([Stone(Ellipse((1 / 3, 2), (0.1, 0.2), math.pi), CHALK), box(3, 3, 1, 1)])
    assert Stones.from_dict(json.loads(json.dumps(stones.to_dict()))) == stones


def test_picture_shows_every_stone_where_it_is():
    stones = Stones([Ellipse((1, 1), (2, 1), 30), box(2, 0, 2, 2)])
    html = stones._repr_html_()
    picture = ElementTree.fromstring(html[html.index("<svg") : html.index("</svg>") + 6])
    frame, group = picture
    width, height = float(frame.get("width")), float(frame.get("height"))
    ellipse, polygon = group
    # 4 m less what the turned ellipse leaves free on the left are 320 pixels wide.
    left = 1 - math.hypot(math.cos(math.pi / 6), 0.5 * math.sin(math.pi / 6))
    scale = width / (4 - left)
    assert width == pytest.approx(320) and height == pytest.approx(2 * scale, abs=0.01)
    assert float(ellipse.get("cx")) == pytest.approx((1 - left) * scale, abs=0.01)
    assert float(ellipse.get("cy")) == pytest.approx(1 * scale, abs=0.01)
    assert float(ellipse.get("rx")) == pytest.approx(scale, abs=0.01)
    assert ellipse.get("transform").startswith("rotate(-30.00 ")
    corners = [tuple(map(float, corner.split(","))) for corner in polygon.get("points").split()]
    np.testing.assert_allclose(
        corners,
        [((x - left) * scale, (2 - y) * scale) for x, y in stones[1].shape.vertices],
        atol=0.06,
    )


def test_table_tells_number_area_sizes_and_mass():
    stones = Stones([box(0, 0, 1, 1), Ellipse((3, 0), (0.5, 0.5))])
    facts = stones.with_material(GRANITE)._repr_html_()
    assert ">2<" in facts and "1.196 m2" in facts and "0.5 to 1.13 m, mean 0.814 m" in facts
    assert f"{2600 * (1 + math.pi / 16):,.0f} kg/m" in facts
    assert "mass" not in stones._repr_html_()
    assert "1 without a material" in (stones[:1] + stones[1:].with_material(CHALK))._repr_html_()
    assert repr(stones) == "<Stones: 2 of 1.196 m2, mean size 0.814 m>"
    assert repr(Stones()) == "<Stones: none>" and "svg" not in Stones()._repr_html_()


def test_plot_draws_stones_and_outline_to_scale():
    stones = Stones([Ellipse((1, 2), (2, 1), 30), box(3, 1, 2, 1)])
    axes = Figure().add_subplot()
    assert stones.plot(axes, SLOPE) is axes
    drawn = [path.vertices for path in axes.collections[0].get_paths()]
    np.testing.assert_allclose(
        [path.min(axis=0) for path in drawn], [s.shape.bounds[:2] for s in stones], atol=1e-3
    )
    np.testing.assert_allclose(
        [path.max(axis=0) for path in drawn], [s.shape.bounds[2:] for s in stones], atol=1e-3
    )
    np.testing.assert_array_equal(axes.patches[0].get_xy()[:4], SLOPE.vertices)
    assert axes.get_aspect() == 1 and axes.get_xlabel() == "x (m)"
    alone = stones.plot(Figure().add_subplot())
    assert not alone.patches and 4.9 < alone.get_xlim()[1] < 5.2
    assert not Stones().plot(Figure().add_subplot()).patches
