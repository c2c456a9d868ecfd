"""Random stones: sizes by law, amounts met, distances kept, and refusals that come to an end."""

import math
import pickle

import numpy as np
import pytest

from gimpslope import stones
from gimpslope.materials import Elastic
from gimpslope.outline import Outline
from gimpslope.stones import Ellipse, LogNormal, PowerLaw, Stones, StonesDoNotFit, Uniform
from gimpslope.stones.drawing import pushing, reach
from gimpslope.stones.drawing.irregular import outline
from gimpslope.stones.drawing.room import Room
from gimpslope.stones.drawing.watch import Watch

SLOPE = Outline.slope()
NOTCHED = Outline([(0, 0), (9, 0), (9, 2), (4, 2), (3, 5), (2, 2), (0, 8)])
ROCK = Elastic(density=2400, young=20e9, poisson=0.2)
SHARES = np.linspace(0, 1, 1001)


def assert_apart(found, outline, gap, margin):
    """By the exact measure of distance, which the draw itself does not use."""
    assert len(found.overlaps()) == 0
    assert len(found.outside(outline)) == 0
    assert found.gaps().min() >= gap - 1e-9
    assert found.margins(outline).min() >= margin - 1e-9


@pytest.mark.parametrize(
    ("law", "share_below"),
    [
        (Uniform(0.2, 0.8), lambda d: (d - 0.2) / 0.6),
        (
            PowerLaw(2.5, 0.1, 2.0),
            lambda d: (0.1**-2.5 - d**-2.5) / (0.1**-2.5 - 2.0**-2.5),
        ),
        (
            LogNormal(0.4, 0.5, 0.2, 1.0),
            lambda d: (phi(d) - phi(0.2)) / (phi(1.0) - phi(0.2)),
        ),
    ],
)
def test_quantiles_invert_the_law(law, share_below):
    sizes = law.quantile(SHARES)
    assert sizes[0] == pytest.approx(law.low) and sizes[-1] == pytest.approx(law.high)
    np.testing.assert_allclose([share_below(d) for d in sizes], SHARES, atol=1e-9)


def phi(d, median=0.4, sigma=0.5):
    return 0.5 * math.erfc(-math.log(d / median) / sigma / math.sqrt(2))


def test_draws_follow_the_power_law():
    found = stones.rounds(Outline.slope(90, 20), PowerLaw(2.0, 0.5, 5.0), count=1000, gap=0, seed=1)
    above = [(found.sizes > d).mean() for d in (0.5, 1.0, 2.0, 4.0)]
    exact = [(d**-2.0 - 5.0**-2.0) / (0.5**-2.0 - 5.0**-2.0) for d in (0.5, 1.0, 2.0, 4.0)]
    # Three standard deviations of a share among 1,000.
    np.testing.assert_allclose(above, exact, atol=3 * math.sqrt(0.25 / 1000))


@pytest.mark.parametrize("gap", [0.0, 0.03, 0.1])
@pytest.mark.parametrize("outline", [SLOPE, NOTCHED], ids=["slope", "notched"])
@pytest.mark.parametrize(
    "draw",
    [
        lambda outline, gap: stones.rounds(outline, 0.5, content=0.3, gap=gap, seed=3),
        lambda outline, gap: stones.ellipses(outline, (0.9, 0.3), content=0.25, gap=gap, seed=3),
        lambda outline, gap: stones.polygons(
            outline, PowerLaw(1.5, 0.2, 1.2), content=0.3, gap=gap, seed=3
        ),
    ],
    ids=["rounds", "ellipses", "polygons"],
)
def test_stones_keep_their_distance(draw, outline, gap):
    assert_apart(draw(outline, gap), outline, gap, gap)


def test_margin_may_differ_from_the_gap():
    found = stones.rounds(SLOPE, 0.5, content=0.3, gap=0.02, margin=0.4, seed=1)
    assert_apart(found, SLOPE, 0.02, 0.4)
    assert found.gaps().min() < 0.1
    touching_edge = stones.rounds(SLOPE, 0.5, content=0.3, gap=0.1, margin=0, seed=1)
    assert touching_edge.margins(SLOPE).min() < 0.1


def test_sixty_percent_of_rounds_a_hundredth_of_their_diameter_apart():
    found = stones.rounds(SLOPE, 0.54, content=0.6, gap=0.0054, seed=1)
    assert found.content(SLOPE) == pytest.approx(0.6, abs=found[0].area / SLOPE.area / 2)
    assert_apart(found, SLOPE, 0.0054, 0.0054)


def test_dense_ovals_and_polygons_of_a_power_law():
    ovals = stones.ellipses(SLOPE, (0.86, 0.344), content=0.45, gap=0.0054, seed=1)
    assert ovals.content(SLOPE) == pytest.approx(0.45, abs=ovals[0].area / SLOPE.area / 2)
    assert_apart(ovals, SLOPE, 0.0054, 0.0054)
    mixed = stones.polygons(SLOPE, PowerLaw(2.0, 0.2, 1.5), content=0.55, gap=0.02, seed=1)
    assert_apart(mixed, SLOPE, 0.02, 0.02)


def test_a_stone_that_only_just_fits_finds_its_place():
    box = Outline([(0, 0), (1, 0), (1, 1), (0, 1)])
    found = stones.rounds(box, 0.79, count=1, gap=0.1, seed=1)
    assert found[0].shape.centre == pytest.approx((0.5, 0.5), abs=0.01)


@pytest.mark.parametrize("content", [0.001, 0.05, 0.2])
@pytest.mark.parametrize("size", [0.5, Uniform(0.2, 0.9)])
def test_content_is_met_to_one_stone(content, size):
    found = stones.rounds(SLOPE, size, content=content, gap=0.02, seed=4)
    assert abs(found.area - content * SLOPE.area) <= found.areas.max()


@pytest.mark.parametrize(
    "draw",
    [
        lambda **amount: stones.rounds(SLOPE, 0.54, **amount),
        lambda **amount: stones.ellipses(SLOPE, Uniform(0.3, 0.8), aspect=(1, 2.5), **amount),
        lambda **amount: stones.polygons(SLOPE, LogNormal(0.4, 0.4, 0.15, 1), **amount),
    ],
    ids=["rounds", "ellipses", "polygons"],
)
@pytest.mark.parametrize("points", [1100, 4400, 4444])
def test_points_are_met_by_scaling_the_smallest_stones_by_at_most_five_percent(draw, points):
    found = draw(points=points, spacing=0.05, gap=0.05, seed=2)
    assert found.point_counts(SLOPE, 0.05).sum() == pytest.approx(points, abs=1)
    assert_apart(found, SLOPE, 0.05, 0.05)
    wanted = draw(content=points * 0.05**2 / SLOPE.area, gap=0.05, seed=2)
    factors = found.sizes / wanted.sizes
    scaled = np.abs(factors - 1) > 1e-9
    assert scaled.any() and 0.95 - 1e-9 <= factors.min() <= factors.max() <= 1.05 + 1e-9
    np.testing.assert_allclose(factors[scaled], factors[scaled][0], rtol=1e-9)
    assert found.sizes[scaled].max() <= 1.05 * found.sizes[~scaled].min(initial=np.inf)


def test_points_out_of_reach_are_refused():
    for points in (2, 470):
        with pytest.raises(ValueError, match=rf"^points must be within reach .* got {points}$"):
            stones.rounds(SLOPE, 1.0, points=points, spacing=0.05, seed=1)


def test_a_list_of_sizes_keeps_its_order():
    found = stones.rounds(SLOPE, [0.3, 1.5, 0.7], seed=1)
    np.testing.assert_array_equal([stone.shape.axes[0] for stone in found], [0.3, 1.5, 0.7])
    axes = [(0.3, 0.2), (1.5, 0.5), (0.7, 0.7)]
    ovals = stones.ellipses(SLOPE, axes, angle=[10, 20, 30], seed=1, material=ROCK)
    assert [stone.shape.axes for stone in ovals] == axes
    assert [stone.shape.angle for stone in ovals] == [10, 20, 30]
    assert all(stone.material is ROCK for stone in ovals)


def test_sizes_of_fixed_axes_are_exact_and_angles_any():
    found = stones.ellipses(SLOPE, (0.86, 0.34), count=48, seed=1)
    assert {stone.shape.axes for stone in found} == {(0.86, 0.34)}
    angles = np.array([stone.shape.angle for stone in found])
    assert 0 <= angles.min() < 30 and 150 < angles.max() < 180
    assert {s.shape.angle for s in stones.ellipses(SLOPE, (1, 0.5), count=5, angle=30, seed=1)} == {
        30
    }


def test_polygons_look_as_asked():
    look = {"corners": 6, "roundness": 0, "aspect": 2.0, "angle": 30}
    found = stones.polygons(SLOPE, 0.6, count=12, seed=1, **look)
    np.testing.assert_allclose(found.sizes, 0.6, rtol=1e-5)
    assert {len(stone.shape.vertices) for stone in found} == {6}
    for stone in found:
        angle, aspect = principal_axis(np.array(stone.shape.vertices))
        assert angle == pytest.approx(30, abs=0.5) and aspect == pytest.approx(2, rel=0.01)


def principal_axis(vertices):
    """Direction of the longer principal axis, degrees, and ratio of both, by a fine lattice."""
    points = Outline(vertices).lattice(0.002)
    spread, axes = np.linalg.eigh(np.cov(points.T))
    return math.degrees(math.atan2(*axes[::-1, 1])) % 180, math.sqrt(spread[1] / spread[0])


def test_places_fill_the_slope_evenly():
    x, y = np.concatenate(
        [stones.rounds(SLOPE, 0.05, count=300, gap=0, seed=seed).centroids for seed in range(5)]
    ).T
    # Areas of the slope left of x = 3 m and below y = 3 m; four deviations of a share of 1,500.
    assert (x < 3).mean() == pytest.approx((2 * 9 + 8.5) / 58.5, abs=2 / math.sqrt(1500))
    assert (y < 3).mean() == pytest.approx((11 + 8) / 2 * 3 / 58.5, abs=2 / math.sqrt(1500))


def test_one_seed_gives_the_same_stones_and_another_gives_others():
    first, again, other = (
        stones.polygons(SLOPE, 0.5, content=0.3, gap=0.05, seed=seed) for seed in (7, 7, 8)
    )
    assert first == again
    assert first != other


def test_what_does_not_fit_ends_in_an_error_that_says_how_far_it_got():
    with pytest.raises(StonesDoNotFit, match=r"got places for \d+ of 31, which cover") as refusal:
        stones.rounds(SLOPE, 1.5, content=0.95, gap=0.0, seed=1)
    error = refusal.value
    assert 8 < error.count < error.wanted == 31
    assert error.content == pytest.approx(error.count * math.pi / 4 * 1.5**2 / SLOPE.area)
    assert error.wanted_content == pytest.approx(0.95, abs=0.02)
    assert error.tries > 100 and error.sweeps > 100
    assert 0 < error.lack < 1.5 and f"left some {error.lack:.2g} m too near" in str(error)
    assert isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.lack == error.lack


def test_it_says_how_near_pushing_came():
    # 10.5 m upright need 0.85 m more at either end than there is between 0.1 m and 8.9 m.
    with pytest.raises(StonesDoNotFit) as refusal:
        stones.ellipses(SLOPE, (10.5, 1), count=1, angle=90, seed=1)
    assert 0.85 < refusal.value.lack < 2 * 0.85 + 0.3
    assert refusal.value.needed < 1


def test_pushing_that_does_not_get_on_ends_early():
    with pytest.raises(StonesDoNotFit) as refusal:
        stones.rounds(SLOPE, 0.54, content=0.6, seed=1)
    assert 1000 < refusal.value.sweeps < 3000


@pytest.mark.parametrize("looks", [20_000, 200_000])
def test_pushing_ends_after_so_many_looks_at_pairs(monkeypatch, looks):
    monkeypatch.setattr(pushing, "_MOST_LOOKS", looks)
    seen = []
    near = Watch.near
    monkeypatch.setattr(Watch, "near", lambda watch, at: seen.append(watch) or near(watch, at))
    with pytest.raises(StonesDoNotFit) as refusal:
        stones.ellipses(SLOPE, (1.0, 0.05), content=0.3, gap=0.01, seed=1)
    assert refusal.value.sweeps + 1 == len(seen)
    assert looks < seen[0].looks < 1.5 * looks


def test_a_watch_finds_what_a_new_look_around_finds_without_so_many():
    rng = np.random.default_rng(1)
    shapes = [
        *(Ellipse((0, 0), axes, rng.uniform(0, 180)) for axes in rng.uniform(0.05, 0.9, (80, 2))),
        *(Outline(0.4 * outline(rng, 6, 0.3, 1.5)) for _ in range(20)),
    ]
    room = Room(NOTCHED, np.array([reach.reach(shape) for shape in shapes]), 0.05, 0.02)
    places = room.random_points(rng, len(shapes))
    watch, longest = Watch(room, places, 0.05), 0
    for _ in range(40):
        old, new = watch.near(places), Watch(room, places, 0.0)
        for found, expected in zip(old, new.near(places), strict=True):
            assert len(expected.lack) > 0
            for part, same in zip(found[:4], expected[:4], strict=True):
                np.testing.assert_array_equal(part, same)
        longest += new.looks
        places = places + rng.uniform(-0.005, 0.005, places.shape)
    assert watch.looks < longest


def test_enough_distance_is_told_roughly_and_less_exactly():
    rng = np.random.default_rng(2)
    ellipses = [Ellipse((0, 0), axes, 20) for axes in rng.uniform(0.1, 1, (30, 2))]
    first, second = rng.integers(0, 30, (2, 500))
    bodies = np.array([reach.reach(ellipse) for ellipse in ellipses]), first, second
    offset = rng.uniform(-1, 1, (500, 2))
    exact, rough = (reach.between(*bodies, offset, enough)[0] for enough in (np.inf, 0.1))
    near = exact < 0.1
    np.testing.assert_array_equal(rough[near], exact[near])
    assert rough[~near].min() >= 0.1 and np.all(rough <= exact) and np.any(rough < exact)


def test_stones_too_many_for_their_gap_are_counted_at_random_places():
    with pytest.raises(StonesDoNotFit, match=r"with their gaps all take 2\.04 times the ") as e:
        stones.rounds(SLOPE, 0.5, count=40, gap=2, margin=0, seed=1)
    # Rounds of 2.5 m in the slope grown by 1 m, by Steiner's formula.
    room = 58.5 + (11 + 9 + 2 + 9 * math.sqrt(2)) + math.pi
    assert e.value.needed == pytest.approx(40 * math.pi / 4 * 2.5**2 / room, rel=1e-3)
    assert 4 < e.value.count < 20 and e.value.sweeps == 0 < e.value.tries


@pytest.mark.parametrize(("diameter", "margin"), [(0.5, 20), (0.5, 3), (6.5, 0.1)])
def test_a_margin_that_leaves_no_room_is_named(diameter, margin):
    with pytest.raises(StonesDoNotFit, match=r"got places for 0 of 4, .* margin leaves no room"):
        stones.rounds(SLOPE, diameter, count=4, margin=margin, seed=1)


@pytest.mark.parametrize(
    "draw",
    [
        lambda **amount: stones.rounds(SLOPE, 0.5, seed=1, **amount),
        lambda **amount: stones.rounds(SLOPE, Uniform(0.3, 0.8), seed=1, **amount),
        lambda **amount: stones.ellipses(SLOPE, (0.5, 0.2), seed=1, **amount),
        lambda **amount: stones.ellipses(SLOPE, Uniform(0.3, 0.8), aspect=2, seed=1, **amount),
        lambda **amount: stones.polygons(SLOPE, PowerLaw(2, 0.1, 1), seed=1, **amount),
    ],
)
def test_none_may_be_asked_for(draw):
    for none in ({"count": 0}, {"content": 0}, {"content": 0.0}, {"points": 0, "spacing": 0.1}):
        assert draw(**none) == Stones()


def test_lists_of_sizes_may_be_empty():
    assert stones.rounds(SLOPE, [], seed=1) == stones.polygons(SLOPE, [], seed=1) == Stones()
    assert stones.ellipses(SLOPE, [], angle=[], seed=1) == Stones()


@pytest.mark.parametrize(
    "draw",
    [
        lambda: stones.rounds(SLOPE, 6.5, count=1, seed=1),  # the inscribed circle is of 6.1 m
        lambda: stones.rounds(SLOPE, 20.0, count=1, seed=1),
        lambda: stones.ellipses(SLOPE, (10.5, 1), count=1, angle=90, seed=1),
        lambda: stones.rounds(SLOPE, 0.5, count=3, margin=5, seed=1),
        lambda: stones.rounds(SLOPE, 0.5, count=20, gap=2, seed=1),
    ],
)
def test_stones_without_room_are_refused(draw):
    with pytest.raises(StonesDoNotFit, match="the stones must fit into the outline, got places"):
        draw()


@pytest.mark.parametrize(
    ("changes", "error", "text"),
    [
        ({"outline": "slope"}, TypeError, "^outline must be an Outline, got 'slope'"),
        ({"diameter": 0.0}, ValueError, "^diameter must be .* got 0.0"),
        ({"diameter": "big"}, TypeError, "^diameter must be .* got 'big'"),
        ({"diameter": [0.5, -1], "count": None}, ValueError, r"^diameter\[1\] must .* got -1.0"),
        ({"diameter": [0.5, 0.6]}, ValueError, "^none of count, .* got {'count': 3}"),
        ({"count": None}, ValueError, "^exactly one of count, content and points .* got none"),
        ({"content": 0.1}, ValueError, "^exactly one of .* got {'count': 3, 'content': 0.1}"),
        ({"count": -1}, ValueError, "^count must be a whole number >= 0, got -1"),
        ({"count": 2.0}, TypeError, "^count must be a whole number >= 0, got 2.0"),
        ({"count": 10**6}, ValueError, "at most 100,000 stones, got 1,000,000"),
        ({"count": None, "content": 1.0}, ValueError, r"^content must be .*\[0, 1\), got 1.0"),
        ({"count": None, "points": 5}, ValueError, "^spacing must be given with points .* None"),
        ({"spacing": 0.1}, ValueError, "^spacing must be given with points and only then, got 0.1"),
        ({"count": None, "points": 5, "spacing": 0}, ValueError, "^spacing must be .* got 0"),
        ({"seed": -1}, ValueError, "^seed must be a whole number >= 0, got -1"),
        ({"seed": None}, TypeError, "^seed must be a whole number >= 0, got None"),
        ({"gap": -0.1}, ValueError, "^gap must be .* got -0.1"),
        ({"margin": math.nan}, ValueError, "^margin must be .* got nan"),
        ({"tries": 0}, ValueError, "^tries must be a whole number >= 1, got 0"),
        ({"material": "rock"}, TypeError, "^material must be .* got 'rock'"),
    ],
)
def test_refusals_of_draws_name_the_parameter(changes, error, text):
    given = {"outline": SLOPE, "diameter": 0.5, "count": 3, "seed": 1} | changes
    with pytest.raises(error, match=text):
        stones.rounds(**given)


@pytest.mark.parametrize(
    ("draw", "error", "text"),
    [
        (lambda: Uniform(0, 1), ValueError, "^low must be .* got 0"),
        (lambda: Uniform(1, 1), ValueError, "^high must be .* > low, got 1.0 with low 1.0"),
        (lambda: PowerLaw(0, 1, 2), ValueError, "^dimension must be .* got 0"),
        (lambda: LogNormal(1, 0, 1, 2), ValueError, "^sigma must be .* got 0"),
        (lambda: LogNormal(1, 0.1, 5, 9), ValueError, "^median must be near .* got 1.0"),
        (lambda: Uniform(1, 2).quantile([0.5, 1.1]), ValueError, "^share must be .* 1.1"),
        (lambda: ovals(Uniform(1, 2)), ValueError, "^aspect must be given .* got None"),
        (lambda: ovals((1, 1), aspect=2), ValueError, "^aspect must be None .* got 2"),
        (lambda: ovals(Uniform(1, 2), aspect=0.5), ValueError, "^aspect must be .* got 0.5"),
        (lambda: ovals(Uniform(1, 2), aspect=(3, 2)), ValueError, "^aspect must have the least"),
        (lambda: ovals(Uniform(1, 2), aspect=(1, 2, 3)), ValueError, "^aspect must be a number,"),
        (lambda: ovals((1, -1)), ValueError, r"^axes\[1\] must be .* got -1.0"),
        (lambda: listed([(1, 1), (-2, 1)]), ValueError, r"^axes\[1\]\[0\] must be .* got -2.0"),
        (lambda: ovals(0.5), ValueError, r"^axes must be .*\(n, 2\), got 0.5"),
        (lambda: ovals((1, 1), angle=[1, 2]), ValueError, r"^angle must be .*\(3\), got"),
        (lambda: stony(corners=2), ValueError, "^corners must be .* got 2"),
        (lambda: stony(corners=(5, 4)), ValueError, "^corners must have the least"),
        (lambda: stony(corners=4.5), TypeError, "^corners must be .* got 4.5"),
        (lambda: stony(roundness=1.5), ValueError, "^roundness must be .* got 1.5"),
        (lambda: stony(aspect=0), ValueError, "^aspect must be .* got 0"),
    ],
)
def test_refusals_of_laws_and_shapes_name_the_parameter(draw, error, text):
    with pytest.raises(error, match=text):
        draw()


def ovals(axes, **look):
    return stones.ellipses(SLOPE, axes, count=3, seed=1, **look)


def listed(axes):
    return stones.ellipses(SLOPE, axes, seed=1)


def stony(**look):
    return stones.polygons(SLOPE, 0.5, count=3, seed=1, **look)
