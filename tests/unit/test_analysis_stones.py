"""Stones that move, turn and deform by formula."""

from dataclasses import replace

import numpy as np
import pytest
import synthetic_run as synthetic
from made_snapshot import made

from gimpslope.analysis import first_outlines, rigid_motion, stone_motion, stone_outlines

RNG = np.random.default_rng(7)
STONE = np.array([0, 1, -1, 2, 1, 0, 0, 2, 1, -1, 2, 2, 0, 1])
START = RNG.random((len(STONE), 2)) * (4, 3)
MASS = 1 + RNG.random(len(STONE))


def turned(places, angle):
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return places @ np.array([(cos, sin), (-sin, cos)])


def centres(places):
    return np.array(
        [np.average(places[k == STONE], axis=0, weights=MASS[k == STONE]) for k in range(3)]
    )


def moved(shifts, angles):
    """Each stone turned about its centre of mass, and shifted; soil anywhere."""
    places = START + 5.0
    for k, (shift, angle) in enumerate(zip(shifts, angles, strict=True)):
        arms = START[k == STONE] - centres(START)[k]
        places[k == STONE] = centres(START)[k] + shift + turned(arms, angle)
    return places


def test_a_rigid_motion_is_found_exactly():
    shifts = np.array([(1.0, -2.0), (0.0, 0.0), (30.0, 0.5)])
    angles = np.array([30.0, -170.0, 0.0])
    found = rigid_motion(STONE, MASS, START, moved(shifts, angles), 3)
    np.testing.assert_allclose(found.before, centres(START), atol=1e-13)
    np.testing.assert_allclose(found.after - found.before, shifts, atol=1e-12)
    np.testing.assert_allclose(found.rotation, angles, atol=1e-11)
    np.testing.assert_allclose(found.misfit, 0, atol=1e-13)


def test_stretch_is_misfit_not_rotation():
    """A cross stretched by e along one arm and shortened along the other does not turn, and each of
    its points is off by e times its distance from the centre."""
    cross = np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    stretched = turned(cross * (1.1, 0.9), 25.0)
    found = rigid_motion(np.zeros(4, dtype=np.int32), np.ones(4), cross, stretched, 1)
    assert found.rotation == pytest.approx([25.0])
    assert found.misfit == pytest.approx([0.1])


def test_the_rotation_is_the_one_with_the_least_misfit():
    after = START + 0.3 * RNG.random(START.shape)
    found = rigid_motion(STONE, MASS, START, after, 3)
    for k in range(3):
        before, now = START[k == STONE] - found.before[k], after[k == STONE] - found.after[k]
        tried = found.rotation[k] + np.array([-1e-3, 0, 1e-3, 5, 90, 180])
        off = [np.sum((turned(before, angle) - now) ** 2, axis=1) for angle in tried]
        misfit = np.sqrt(np.average(off, axis=1, weights=MASS[k == STONE]))
        assert np.argmin(misfit) == 1
        assert misfit[1] == pytest.approx(found.misfit[k])


def test_whole_turns_are_counted():
    angles = np.arange(0, 1000, 125.0)
    states = [
        made(moved(np.zeros((3, 2)), (angle, -angle, 0)), START, stone=STONE, mass=MASS, time=time)
        for time, angle in enumerate(angles)
    ]
    motion = stone_motion(iter(states), 3)
    np.testing.assert_allclose(
        motion.rotation, np.column_stack([angles, -angles, 0 * angles]), atol=1e-9
    )
    np.testing.assert_allclose(motion.time, np.arange(8))


def test_translation_and_deformation_over_time():
    shifts = np.array([(1.0, -2.0), (0.0, 0.0), (30.0, 0.5)])
    states = [
        made(moved(part * shifts, np.zeros(3)), START, stone=STONE, mass=MASS)
        for part in (0.0, 0.5, 1.0)
    ]
    motion = stone_motion(states, 3)
    assert motion.centroid.shape == (3, 3, 2)
    np.testing.assert_allclose(motion.translation[1], 0.5 * shifts, atol=1e-12)
    np.testing.assert_allclose(motion.translation[2], shifts, atol=1e-12)
    np.testing.assert_allclose(motion.deformation, 0, atol=1e-12)


def test_deformation_is_a_share_of_the_size():
    cross = np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    state = made(cross * (1.1, 0.9), cross, stone=np.zeros(4))
    size = 2 * np.sqrt(4 * 0.01 / np.pi)  # of four points of 0.01 m2
    assert stone_motion([state], 1).deformation == pytest.approx(np.array([[0.1 / size]]))


def test_a_stone_of_one_point_has_no_rotation():
    motion = stone_motion(
        [made([(1.0, 2.0), (3.0, 1.0)], [(0.0, 0.0), (3.0, 1.0)], stone=[0, -1])], 1
    )
    assert np.isnan(motion.rotation).all()
    assert motion.deformation == 0
    np.testing.assert_allclose(motion.centroid, [[(1.0, 2.0)]])


def test_without_stones_there_is_no_motion():
    motion = stone_motion([made(START), made(START)], 0)
    assert motion.rotation.shape == motion.deformation.shape == (2, 0)
    assert motion.translation.shape == (2, 0, 2)


def test_what_cannot_be_answered_is_refused():
    with pytest.raises(ValueError, match="at least one snapshot"):
        stone_motion([], 1)
    with pytest.raises(ValueError, match=r"stone must name each of the 4 stones.*stones\[3\]"):
        rigid_motion(STONE, MASS, START, START, 4)


def test_outlines_move_with_the_points():
    scene, points = synthetic.SCENE, synthetic.POINTS
    whole = made(
        np.add(turned(points.position, 40.0), (3.0, 1.0)),
        points.position,
        stone=points.stone,
        mass=points.mass,
    )
    (outline,) = stone_outlines(scene, whole)
    (start,) = first_outlines(scene)
    corners = {(0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0)}
    assert set(map(tuple, start)) == corners
    np.testing.assert_allclose(outline, np.add(turned(start, 40.0), (3.0, 1.0)), atol=1e-12)


def test_outlines_stay_true_to_a_slope_that_settled():
    """The outline is that of the unloaded slope, so that the way to the trigger counts too."""
    scene, points = synthetic.SCENE, synthetic.POINTS
    settled = points.position - (0.0, 0.02)
    state = made(settled, settled, stone=points.stone, mass=points.mass)
    (outline,) = stone_outlines(scene, state)
    np.testing.assert_allclose(outline, first_outlines(scene)[0] - (0.0, 0.02), atol=1e-12)
    again = replace(state, position=points.position)
    np.testing.assert_allclose(
        stone_outlines(scene, again)[0], first_outlines(scene)[0], atol=1e-12
    )
