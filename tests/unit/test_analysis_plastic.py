"""The plastic zone, and the connected bands in it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_snapshot import made

from gimpslope.analysis import plastic_bands, plastic_share, plastic_zone
from gimpslope.analysis.components import CORNERS, EDGES, components, neighbours
from gimpslope.analysis.islands import islands

CELL = 0.2  # four points of side 0.1 m a cell
LATTICE = np.stack(np.meshgrid(np.arange(40), np.arange(30)), axis=-1).reshape(-1, 2)
PLACES = (LATTICE + 0.5) * 0.1


def state(plastic, **more):
    return made(PLACES, plastic_strain=np.where(plastic, 0.5, 0.0), **more)


def box(left, bottom, right, top):
    """The points in a box of which the sides are given in cells."""
    x, y = LATTICE.T / 2
    return (left <= x) & (x < right) & (bottom <= y) & (y < top)


def test_shares_of_soil_and_stone():
    stone = np.where(box(0, 0, 5, 15), 0, -1)  # a quarter of the points
    strain = np.where(LATTICE[:, 1] < 3, 0.02, 0.0)  # a tenth of the rows
    strain[stone >= 0] = np.where(LATTICE[stone >= 0, 1] < 6, 0.02, 0.0)
    found = plastic_share(made(PLACES, plastic_strain=strain, stone=stone))
    assert found == pytest.approx((0.1, 0.2))
    none = made(PLACES, plastic_strain=strain, stone=stone)
    assert plastic_share(none, threshold=0.02) == (0.0, 0.0)


def test_shares_weigh_by_mass():
    strain, mass = np.array([0.1, 0.0, 0.0]), np.array([3.0, 1.0, 2.0])
    found = plastic_share(made(np.zeros((3, 2)), plastic_strain=strain, mass=mass))
    assert found == (0.5, None)


def test_the_zone_is_soil_above_the_threshold():
    strain = np.array([0.01, 0.011, 0.011])
    zone = plastic_zone(made(np.zeros((3, 2)), plastic_strain=strain, stone=[-1, -1, 0]))
    assert zone.tolist() == [False, True, False]
    with pytest.raises(ValueError, match=r"threshold must be a finite number >= 0, got -1"):
        plastic_zone(state(box(0, 0, 1, 1)), threshold=-1)


def test_two_bands_a_cell_apart_are_two_and_the_larger_is_first():
    small, large = box(0, 0, 8, 2), box(0, 3, 20, 5)
    bands = plastic_bands(state(small | large), CELL)
    assert len(bands) == 2
    np.testing.assert_allclose(bands.area, (20 * 2 * CELL**2, 8 * 2 * CELL**2))
    np.testing.assert_array_equal(bands.label == 0, large)
    np.testing.assert_array_equal(bands.label == 1, small)
    np.testing.assert_array_equal(bands.label == -1, ~(small | large))


def test_cells_that_share_a_corner_are_connected():
    corner = box(2, 2, 4, 4) | box(4, 4, 6, 6) | box(6, 2, 8, 4)
    assert len(plastic_bands(state(corner), CELL)) == 1
    apart = box(2, 2, 4, 4) | box(5, 4, 7, 6)
    assert len(plastic_bands(state(apart), CELL)) == 2


def test_a_band_across_the_whole_is_one():
    diagonal = np.abs(LATTICE[:, 0] - LATTICE[:, 1]) < 2
    winding = box(0, 0, 20, 1) | box(19, 0, 20, 5) | box(0, 4, 20, 5) | box(0, 4, 1, 9)
    for region in (diagonal, winding):
        bands = plastic_bands(state(region), CELL, least=0)
        assert bands.area == pytest.approx([0.01 * region.sum()])


def test_points_are_where_they_are_now():
    two = box(0, 0, 4, 2) | box(10, 0, 14, 2)
    moved = PLACES - np.where(box(10, 0, 14, 2)[:, np.newaxis], (6 * CELL, 0.0), 0.0)
    start = state(two)
    assert len(plastic_bands(start, CELL)) == 2
    now = made(moved, start=PLACES, plastic_strain=start.plastic_strain)
    assert len(plastic_bands(now, CELL)) == 1


def test_cells_are_counted_from_the_origin():
    columns = box(0, 0, 1, 5) | box(2, 0, 3, 5)  # with an empty column between them
    assert len(plastic_bands(state(columns), CELL)) == 2
    assert len(plastic_bands(state(columns), CELL, origin=(0.1, 0.0))) == 1


def test_small_regions_and_stones_are_no_bands():
    regions = box(0, 0, 5, 5) | box(10, 10, 11, 12)
    assert plastic_bands(state(regions), CELL).area == pytest.approx([25 * CELL**2])
    assert len(plastic_bands(state(regions), CELL, least=0.08)) == 2
    stone = np.where(box(0, 0, 5, 5), 0, -1)
    assert len(plastic_bands(state(regions, stone=stone), CELL)) == 0


def test_areas_are_the_present_ones():
    region = box(0, 0, 5, 5)
    grown = state(region, volume=np.full(len(PLACES), 0.013))
    assert plastic_bands(grown, CELL).area == pytest.approx([1.3 * 25 * CELL**2])


def test_no_band_in_an_elastic_slope():
    bands = plastic_bands(state(np.zeros(len(PLACES), dtype=bool)), CELL)
    assert len(bands) == 0 and (bands.label == -1).all()


@pytest.mark.parametrize(
    ("name", "value"), [("cell", 0.0), ("least", -1.0), ("origin", (0.0,)), ("threshold", -0.1)]
)
def test_refusals_name_the_parameter(name, value):
    arguments = {"cell": CELL} | {name: value}
    with pytest.raises(ValueError, match=rf"{name} must be .*got"):
        plastic_bands(state(box(0, 0, 1, 1)), **arguments)


@given(st.integers(1, 30), st.data())
def test_components_agree_with_merging_sets_one_by_one(count, data):
    end = st.integers(0, count - 1)
    pairs = data.draw(st.lists(st.tuples(end, end), max_size=40))
    sets = [{number} for number in range(count)]
    for first, second in pairs:
        merged = sets[first] | sets[second]
        for number in merged:
            sets[number] = merged
    found = components(count, np.array(pairs, dtype=np.int64).reshape(-1, 2))
    assert found.tolist() == [min(members) for members in sets]


CELLS = st.sets(st.tuples(st.integers(-4, 4), st.integers(-4, 4)), max_size=40)


@pytest.mark.parametrize(("steps", "order"), [(CORNERS, np.inf), (EDGES, 1)])
@given(cells=CELLS)
def test_neighbours_share_a_corner_or_an_edge(cells, steps, order):
    places = np.array(sorted(cells), dtype=np.int64).reshape(-1, 2)
    pairs = neighbours(places, steps).tolist()
    distance = np.linalg.norm(places[:, np.newaxis] - places, ord=order, axis=2)
    wanted = {frozenset(pair) for pair in np.argwhere(distance == 1).tolist()}
    assert {frozenset(pair) for pair in pairs} == wanted
    assert len(pairs) == len(wanted)


def test_islands_are_what_bands_go_around():
    """A frame of one cell around a stone of 4 x 3 cells, one of them plastic soil, and a second
    hole; a bay that is open to one side is none."""
    frame = box(2, 2, 8, 7) & ~box(3, 3, 7, 6) | box(3, 3, 4, 4)
    second = box(12, 2, 17, 7) & ~box(13, 3, 16, 6)
    bay = second & ~box(14, 6, 15, 7)
    stone = np.where(box(3, 3, 7, 6) & ~box(3, 3, 4, 4), 0, -1)
    bands = plastic_bands(state(frame | second, stone=stone), CELL)
    np.testing.assert_allclose(bands.islands, (11 * CELL**2, 9 * CELL**2))
    bands = plastic_bands(state(frame | bay, stone=stone), CELL)
    np.testing.assert_allclose(bands.islands, [11 * CELL**2])
    assert len(plastic_bands(state(frame | second), CELL, least=0.4).islands) == 1


def test_no_way_leads_between_cells_that_touch_at_a_corner():
    ring = np.array([(0, 1), (1, 0), (2, 1), (1, 2)])
    assert islands(ring).tolist() == [1]
    assert islands(ring[:3]).tolist() == []
    assert islands(ring[:0]).tolist() == []
    cut = np.array([(0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (3, 0), (3, 1), (3, 2)])
    assert islands(cut).tolist() == []
    far = np.concatenate([ring, [(10**9, -(10**9))]])
    assert islands(far).tolist() == [1]


@given(CELLS)
def test_islands_agree_with_walking_in_from_outside(cells):
    everything = {(x, y) for x in range(-6, 7) for y in range(-6, 7)}
    reached, ahead = set(), [(-6, -6)]
    while ahead:
        x, y = ahead.pop()
        if (x, y) in everything - cells - reached:
            reached.add((x, y))
            ahead += [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]
    places = np.array(sorted(cells), dtype=np.int64).reshape(-1, 2)
    assert islands(places).sum() == len(everything - cells - reached)
