"""Scenes: material points from outlines, and what cannot be simulated."""

import json
import math
import re
from dataclasses import FrozenInstanceError, fields, replace

import numpy as np
import pytest

from gimpslope.materials import DruckerPrager, Elastic
from gimpslope.outline import Outline
from gimpslope.scene import Scene
from gimpslope.stones import Ellipse, Stone, Stones
from gimpslope.walls import Coulomb, Fixed, Free, Roller, Walls

SOIL = DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
STONE = Elastic(density=2400, young=20e9, poisson=0.2)


def box(x, y, width, height):
    return Outline([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])


BLOCK = box(0, 0, 2, 1)


def test_study_slope():
    scene = Scene(Outline.slope(), SOIL)
    points = scene.points
    assert scene.n_points == len(points) == 23490
    np.testing.assert_allclose(points.volume, 0.0025)
    np.testing.assert_allclose(points.mass, 4.5)
    np.testing.assert_allclose(points.half_length, 0.025)
    np.testing.assert_allclose(points.position[0], (0.025, 0.025))
    assert not points.material.any()
    assert scene.materials == (SOIL,)


@pytest.mark.parametrize("points_per_cell", [1, 4, 9, 16])
def test_points_share_out_the_cell(points_per_cell):
    scene = Scene(BLOCK, SOIL, cell=0.5, points_per_cell=points_per_cell)
    assert scene.n_points == 8 * points_per_cell
    assert scene.points.volume.sum() == pytest.approx(2.0)
    assert scene.points.mass.sum() == pytest.approx(3600)
    assert (4 * scene.points.half_length.prod(axis=1)).sum() == pytest.approx(2.0)


def test_arrays_have_the_promised_form():
    points = Scene(BLOCK, SOIL, cell=0.5).points
    shapes = {field.name: getattr(points, field.name).shape for field in fields(points)}
    assert shapes == {
        "position": (32, 2),
        "half_length": (32, 2),
        "volume": (32,),
        "mass": (32,),
        "material": (32,),
        "stone": (32,),
    }
    assert points.material.dtype == points.stone.dtype == np.int32
    for field in fields(points):
        assert not getattr(points, field.name).flags.writeable


def test_points_in_stones_are_stone():
    stones = [box(0.2, 0.2, 0.4, 0.4), box(0.6, 0.2, 0.2, 0.2)]
    scene = Scene(BLOCK, SOIL, stones=stones, stone=STONE, cell=0.2)
    stone = scene.points.material == 1
    assert scene.materials == (SOIL, STONE)
    assert stone.sum() == 16 + 4
    assert scene.points.position[stone].min(axis=0) == pytest.approx((0.25, 0.25))
    assert scene.points.position[stone].max(axis=0) == pytest.approx((0.75, 0.55))
    assert scene.points.mass.sum() == pytest.approx(1800 * (2 - 0.2) + 2400 * 0.2)


def test_scene_is_frozen_and_keeps_its_stones():
    stones = [box(0.2, 0.2, 0.4, 0.4)]
    scene = Scene(BLOCK, SOIL, stones=stones, stone=STONE)
    stones.clear()
    assert len(scene.stones) == 1
    with pytest.raises(FrozenInstanceError):
        scene.cell = 0.2  # type: ignore[misc]


def test_points_are_made_once():
    scene = Scene(BLOCK, SOIL)
    assert scene.points is scene.points
    assert replace(scene, cell=0.5).n_points == 32


def test_origin_and_walls_follow_the_bounding_box():
    scene = Scene(box(-1.3, 0.7, 2, 1), SOIL)
    assert scene.origin == pytest.approx((-1.3, 0.7))
    assert scene.wall_positions == pytest.approx((-1.3, 0.7, 0.7, 1.7))


def test_wall_within_rounding_of_a_grid_line_is_put_on_it():
    outline = box(0, 0, 2 + 5e-8, 1 - 5e-8)
    walls = Walls(right=Roller(), top=Coulomb(0.2))
    assert Scene(outline, SOIL, walls=walls).wall_positions == (0, 2, 0, 1)
    assert Scene(outline, SOIL).wall_positions == outline.bounds[::2] + outline.bounds[1::2]


@pytest.mark.parametrize("wall", [Fixed(), Roller(), Coulomb(0.2)])
@pytest.mark.parametrize(
    ("side", "outline", "cells"),
    [("right", box(0, 0, 2.04, 1), "20.4"), ("top", box(3, 3, 2, 0.95), "9.5")],
)
def test_wall_off_the_grid_lines_is_refused(side, wall, outline, cells):
    assert Scene(outline, SOIL, walls=Walls(**{side: Free()}))
    with pytest.raises(ValueError, match=rf"walls\.{side} must .* {cells} cells of 0\.1 m"):
        Scene(outline, SOIL, walls=Walls(**{side: wall}))


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("outline", None, TypeError),
        ("soil", "clay", TypeError),
        ("soil", None, TypeError),
        ("walls", Fixed(), TypeError),
        ("cell", 0.0, ValueError),
        ("cell", math.nan, ValueError),
        ("cell", True, TypeError),
        ("cell", 100.0, ValueError),
        ("points_per_cell", 0, ValueError),
        ("points_per_cell", 2, ValueError),
        ("points_per_cell", 4.0, TypeError),
        ("gravity", 0.0, ValueError),
        ("gravity", -9.81, ValueError),
        ("gravity", "strong", TypeError),
    ],
)
def test_refusal_names_parameter_and_value(name, value, error):
    with pytest.raises(error, match=f"^{name} must be .*got .*") as refusal:
        replace(Scene(BLOCK, SOIL), **{name: value})
    assert str(value) in str(refusal.value)


INSIDE = box(0.2, 0.2, 0.4, 0.4)


@pytest.mark.parametrize(
    ("stones", "stone", "error", "text"),
    [
        ([INSIDE], None, ValueError, "^stone must be given .* got None with 1 such stones"),
        ([], STONE, ValueError, "^stone must be given .* got Elastic.* with 0 such stones"),
        ([INSIDE], "granite", TypeError, "^stone must be a material or None, got 'granite'"),
        (INSIDE, STONE, TypeError, "^stones must be a sequence of Stone.* got Outline"),
        (
            [INSIDE, 3],
            STONE,
            TypeError,
            r"^stones\[1\] must be a Stone, .* got 3",
        ),
        (
            [INSIDE, box(1.8, 0, 0.3, 1)],
            STONE,
            ValueError,
            r"^stones\[1\] must lie .* got 1 of 2 .*: \[1\]$",
        ),
        ([box(5, 5, 1, 1)], STONE, ValueError, r"^stones\[0\] must lie inside .* got 1 of 1"),
        (
            [INSIDE, box(1, 0.2, 0.4, 0.4), box(0.5, 0.2, 0.4, 0.4)],
            STONE,
            ValueError,
            r"^stones\[0\] must not overlap stones\[2\], got 1 pairs that overlap: \[\[0, 2\]\]",
        ),
        ([INSIDE, INSIDE], STONE, ValueError, r"overlap stones\[1\]"),
        (
            [INSIDE, box(1.51, 0.51, 0.01, 0.01)],
            STONE,
            ValueError,
            r"^cell must be small .* a point in stones\[1\], got 0\.1 m with a stone of 0\.0001",
        ),
    ],
)
def test_refusal_of_stones(stones, stone, error, text):
    with pytest.raises(error, match=text):
        Scene(BLOCK, SOIL, stones=stones, stone=stone)


@pytest.mark.parametrize("points_per_cell", [1, 9])
def test_the_cell_that_is_said_to_do_does(points_per_cell):
    """Wherever the stones lie, of which the thinner one sets it."""
    given = {"soil": SOIL, "stone": STONE, "points_per_cell": points_per_cell}
    for place in np.linspace(0.2, 0.3, 23):
        thin, wide = Ellipse((place, place), (0.3, 0.06), angle=40), box(1, 0.2, 0.1, 0.1)
        with pytest.raises(ValueError, match="is sure to do for every stone") as refusal:
            Scene(BLOCK, stones=[thin, wide], cell=2.0, **given)
        cell = float(re.search(r"; ([\d.]+) m or less", str(refusal.value)).group(1))
        assert 0.9 * math.sqrt(2 * points_per_cell) * 0.03 < cell
        assert Scene(BLOCK, stones=[thin, wide], cell=cell, **given).n_points


def test_stones_may_touch_each_other_and_the_outline():
    stones = [box(0, 0, 0.5, 0.5), box(0.5, 0, 0.5, 0.5), box(0, 0.5, 0.5, 0.5)]
    assert Scene(BLOCK, SOIL, stones=stones, stone=STONE).points.material.sum() == 3 * 100


def test_each_stone_has_its_number_and_its_material():
    granite, chalk = replace(STONE, density=2700), replace(STONE, density=2000)
    stones = [
        Stone(box(0.0, 0.0, 0.5, 0.5), granite),
        Ellipse((1.5, 0.5), (0.6, 0.3), angle=90),
        Stone(box(0.5, 0.5, 0.5, 0.5), chalk),
        Stone(box(1.0, 0.0, 0.2, 0.2), granite),
    ]
    scene = Scene(BLOCK, SOIL, stones=stones, stone=STONE)
    points = scene.points
    assert scene.materials == (SOIL, STONE, granite, chalk)
    assert scene.material_names == ("soil", "stone 1", "stone 2", "stone 3")
    of_stone = np.array([0, 2, 1, 3, 2])  # in the soil (-1), then in each
    np.testing.assert_array_equal(points.material, of_stone[points.stone + 1])
    np.testing.assert_array_equal(np.unique(points.stone), [-1, 0, 1, 2, 3])
    assert (points.stone == 0).sum() == 100
    x, y = points.position[points.stone == 1].T - [[1.5], [0.5]]
    assert ((x / 0.15) ** 2 + (y / 0.3) ** 2).max() < 1
    np.testing.assert_allclose(points.mass[points.stone == 2], 2000 * 0.0025)


def test_stones_that_all_have_a_material_need_none_for_the_rest():
    stones = Stones([INSIDE]).with_material(STONE)
    assert Scene(BLOCK, SOIL, stones=stones).materials == (SOIL, STONE)
    with pytest.raises(ValueError, match=r"^stone must be given .* with 0 such stones"):
        Scene(BLOCK, SOIL, stones=stones, stone=STONE)


def test_round_trip_through_json():
    scene = Scene(
        Outline.slope(angle=40),
        SOIL,
        stones=[box(1.1, 1.3, 0.4, 0.7), Stone(Ellipse((3, 2), (0.9, 0.4), 30), SOIL)],
        stone=STONE,
        cell=0.2,
        points_per_cell=9,
        walls=Walls(left=Roller(), bottom=Coulomb(0.2)),
        gravity=9.8,
    )
    again = Scene.from_dict(json.loads(json.dumps(scene.to_dict())))
    assert again == scene
    assert hash(again) == hash(scene)
    np.testing.assert_array_equal(again.points.material, scene.points.material)


def test_a_stone_of_the_soils_own_material_is_a_stone_but_no_further_material():
    scene = Scene(BLOCK, SOIL, stones=[INSIDE], stone=SOIL)
    assert scene.materials == (SOIL,) and scene.material_names == ("soil",)
    assert not scene.points.material.any() and (scene.points.stone == 0).sum() == 64
