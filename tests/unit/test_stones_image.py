"""Slopes out of label images: regions, content by area and by points, labels, refusals."""

import h5py
import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from gimpslope.materials import Elastic
from gimpslope.scene import Scene
from gimpslope.stones.sources.image import from_image

SOIL = Elastic(density=1800, young=30e6, poisson=0.3)
GRANITE = Elastic(density=2600, young=20e9, poisson=0.2)
BASALT = Elastic(density=2900, young=30e9, poisson=0.2)

# Rows from the top: a slope of four rows with two stones of 2 and one of 3.
SMALL = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1, 1, 0, 0, 0, 0],
        [1, 2, 1, 0, 0, 0],
        [2, 1, 3, 3, 0, 0],
        [1, 1, 1, 1, 1, 1],
    ]
)


def slope_with_discs(columns, seed):
    """The study's slope, 11 m wide, with 48 discs of 0.54 m; labels 0, 1, 2 and the pixel, m."""
    pixel = 11 / columns
    rows = round(9 / pixel)
    x, y = np.meshgrid((np.arange(columns) + 0.5) * pixel, (np.arange(rows)[::-1] + 0.5) * pixel)
    labels = np.where(x + y <= 11, 1, 0)
    rng = np.random.default_rng(seed)
    centres = np.empty((0, 2))
    while len(centres) < 48:
        centre = rng.random(2) * (10, 8.7)
        clear = centre.min() > 0.3 and centre.sum() < 11 - 0.4
        if clear and np.all(np.hypot(*(centres - centre).T) > 0.62):
            centres = np.vstack([centres, centre])
    for centre in centres:
        labels[np.hypot(x - centre[0], y - centre[1]) <= 0.27] = 2
    return labels, pixel


def pieces_of(labels, label):
    """Sizes of the regions of a label, pixels, by filling one after the other."""
    left = {(int(r), int(c)) for r, c in np.argwhere(labels == label)}
    sizes = []
    while left:
        edge, size = [left.pop()], 0
        while edge:
            r, c = edge.pop()
            size += 1
            near = {(r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)} & left
            left -= near
            edge += near
        sizes.append(size)
    return sorted(sizes)


def test_small_image_pixel_by_pixel():
    outline, stones = from_image(SMALL, 0.5)
    assert outline.area == pytest.approx(15 * 0.25, rel=1e-3)
    assert outline.bounds == (0, 0, 3, 2)
    assert [stone.area / 0.25 for stone in stones] == pytest.approx([1, 1, 2], rel=1e-3)
    expected = [(0.25, 0.75), (0.75, 1.25), (1.5, 0.75)]
    np.testing.assert_allclose([stone.centroid for stone in stones], expected, atol=1e-4)


def test_outline_follows_the_edges_of_the_pixels():
    outline, _ = from_image(SMALL, 1.0)
    corners = [(0, 0), (6, 0), (6, 1), (4, 1), (4, 2), (3, 2), (3, 3), (2, 3), (2, 4), (0, 4)]
    assert outline.polygon.symmetric_difference(shapely.Polygon(corners)).area < 20 * 1e-4


@pytest.mark.parametrize(("columns", "seed"), [(250, 1), (330, 2), (440, 3)])
def test_content_is_kept_by_area_and_by_points(columns, seed):
    labels, pixel = slope_with_discs(columns, seed)
    share = np.mean(labels[labels > 0] == 2)
    outline, stones = from_image(labels, pixel)
    assert len(stones) == 48
    assert stones.content(outline) == pytest.approx(share, abs=1e-6)
    for spacing in np.multiply(pixel, (0.5, 0.61, 2 / 3, 0.8, 1, 1.1)):
        assert stones.point_content(outline, spacing) == pytest.approx(share, abs=2e-3)


def test_scene_at_the_spacing_of_the_pixels_is_the_image():
    labels, pixel = slope_with_discs(220, seed=4)
    outline, stones = from_image(labels, pixel)
    scene = Scene(outline, SOIL, stones=stones, stone=GRANITE, cell=2 * pixel)
    upwards = labels[::-1]
    np.testing.assert_array_equal(scene.points.material, upwards[upwards > 0] - 1)


def test_a_point_on_the_edge_of_two_pixels_is_in_one_of_them():
    labels = np.random.default_rng(5).integers(2, 4, (9, 12)) * np.array([[1, 0, 0, 1] * 3])
    labels[labels == 0] = 1
    _, stones = from_image(labels, 0.1, background=None)
    columns, rows = np.meshgrid(np.arange(1, 12), np.arange(1, 9))
    points = 0.1 * np.stack([columns, rows], axis=-1).reshape(-1, 2)
    inside = stones.numbers(points) >= 0
    np.testing.assert_array_equal(inside, labels[::-1][1:, 1:].ravel() > 1)
    counts = np.sum([stone.contains(points) for stone in stones], axis=0)
    assert counts.max() == 1


def test_touching_stones_of_different_labels_neither_merge_nor_overlap():
    labels = np.ones((6, 8), dtype=int)
    labels[2:4, 1:3], labels[2:4, 3:7], labels[4, 2:6] = 5, 6, 7
    outline, stones = from_image(labels, 0.3, background=None)
    assert [stone.area / 0.09 for stone in stones] == pytest.approx([4, 8, 4])
    assert len(stones.overlaps()) == len(stones.outside(outline)) == 0
    assert Scene(outline, SOIL, stones=stones, stone=GRANITE, cell=0.3).points.material.sum() == 64


def test_pixels_that_touch_at_a_corner_are_two_stones():
    labels = np.ones((4, 4), dtype=int)
    labels[1, 1] = labels[2, 2] = 2
    _, stones = from_image(labels, 0.1, background=None)
    assert len(stones) == 2
    assert len(stones.overlaps()) == 0


def test_stones_at_the_sides_of_the_slope_and_of_one_pixel():
    labels = np.ones((5, 7), dtype=int)
    labels[[0, 4, 0, 4, 2, 2], [0, 0, 6, 6, 0, 3]] = 2
    outline, stones = from_image(labels, 0.2, background=None)
    assert len(stones) == 6
    assert len(stones.outside(outline)) == 0
    assert outline.bounds == pytest.approx((0, 0, 1.4, 1))
    scene = Scene(outline, SOIL, stones=stones, stone=GRANITE, cell=0.2)
    assert scene.points.material.sum() == 6 * 4


@given(arrays(np.int8, (6, 6), elements=st.sampled_from([1, 1, 1, 2, 3])))
def test_any_image_gives_the_regions_that_filling_finds(labels):
    labels[0, 0] = 1
    pieces = {label: pieces_of(labels, label) for label in (2, 3)}
    try:
        outline, stones = from_image(labels, 1.0, background=None)
    except ValueError as refusal:
        assert "without anything inside" in str(refusal)
        outer = pieces_of(np.pad(labels == 2, 1), 0), pieces_of(np.pad(labels == 3, 1), 0)
        assert max(map(len, outer)) > 1
        return
    areas = [stone.area for stone in stones]
    assert len(stones) == sum(map(len, pieces.values()))
    ordered = sorted(areas[: len(pieces[2])]) + sorted(areas[len(pieces[2]) :])
    assert ordered == pytest.approx(pieces[2] + pieces[3], abs=2e-3)
    assert len(stones.overlaps()) == len(stones.outside(outline)) == 0
    assert outline.area == 36


def test_stones_are_numbered_by_label_then_upwards():
    labels = np.ones((7, 7), dtype=int)
    labels[[1, 5, 3, 3], [1, 5, 1, 5]] = 2
    labels[5, 1] = 9
    _, stones = from_image(labels, 1.0, background=None, stones=[9, 2])
    expected = [(1.5, 1.5), (5.5, 1.5), (1.5, 3.5), (5.5, 3.5), (1.5, 5.5)]
    np.testing.assert_allclose([stone.centroid for stone in stones], expected, atol=1e-3)


def test_materials_for_all_stones_or_by_label():
    both = {2: GRANITE, 3: BASALT}
    kinds = {
        name: [stone.material for stone in from_image(SMALL, 0.5, material=given).stones]
        for name, given in {"all": GRANITE, "both": both, "one": {3: BASALT}, "none": None}.items()
    }
    assert kinds["all"] == [GRANITE] * 3
    assert kinds["both"] == [GRANITE, GRANITE, BASALT]
    assert kinds["one"] == [None, None, BASALT]
    assert kinds["none"] == [None] * 3


COLOURS = {0: (255, 255, 255), 1: (139, 90, 43), 2: (128, 128, 128), 3: (0, 0, 128)}


def save(tmp_path, mode):
    """The small image as a picture, and how its labels are called."""
    path = tmp_path / f"{mode}.png"
    grey = Image.fromarray(SMALL.astype(np.uint8))
    if mode == "L":
        grey.save(path)
        return path, {"background": 0, "soil": 1, "stones": (2, 3)}
    if mode == "I;16":
        Image.fromarray((300 * SMALL).astype(np.uint16)).save(path)
        return path, {"background": 0, "soil": 300, "stones": (600, 900)}
    grey.putpalette([channel for colour in COLOURS.values() for channel in colour])
    if mode == "RGBA":
        rgba = np.array(grey.convert("RGBA"))
        rgba[SMALL == 0] = 0
        Image.fromarray(rgba).save(path)
        return path, {"background": "#00000000", "soil": "#8b5a2b"}
    (grey.convert("RGB") if mode == "RGB" else grey).save(path)
    return path, {"background": "white", "soil": (139, 90, 43), "stones": ["#808080", "#000080"]}


@pytest.mark.parametrize("mode", ["L", "I;16", "P", "RGB", "RGBA"])
def test_pictures_give_what_the_array_gives(tmp_path, mode):
    path, labels = save(tmp_path, mode)
    outline, stones = from_image(path, 0.5, **labels)
    assert outline == from_image(SMALL, 0.5).outline
    assert sorted(s.centroid for s in stones) == sorted(
        s.centroid for s in from_image(SMALL, 0.5).stones
    )


def test_a_palette_has_numbers_and_colours(tmp_path):
    path, colours = save(tmp_path, "P")
    by_colour = from_image(path, 0.5, **colours)
    by_number = from_image(str(path), 0.5, material={"#808080": GRANITE, 3: BASALT})
    assert by_number.outline == by_colour.outline
    assert [stone.material for stone in by_number.stones] == [GRANITE, GRANITE, BASALT]
    assert by_number.stones.shapes == by_colour.stones.shapes
    with pytest.raises(ValueError, match=r"^material must have groups .* once, got one of 2$"):
        from_image(path, 0.5, material={"#808080": GRANITE, 2: BASALT})


def test_colours_that_two_palette_entries_share_are_no_label(tmp_path):
    path = tmp_path / "shared.png"
    image = Image.fromarray(SMALL.astype(np.uint8))
    image.putpalette([255] * 3 + [9, 9, 9] * 2 + [0, 0, 128])
    image.save(path)
    assert len(from_image(path, 0.5).stones) == 3
    with pytest.raises(ValueError, match=r"^soil must be .* 1 \(36\.67%\), .*'#090909'$"):
        from_image(path, 0.5, soil="#090909")


def changed(*places, label):
    labels = SMALL.copy()
    for place in places:
        labels[place] = label
    return labels


@pytest.mark.parametrize(
    ("image", "arguments", "text"),
    [
        (SMALL, {"soil": 4}, r"^soil must be a label of the image, 0 \(50\.00%\).*; got 4$"),
        (SMALL, {"soil": 0}, "^soil must differ from background, got 0 for both"),
        (SMALL, {"background": 7}, "^background must be a label of the image, .* got 7$"),
        (SMALL, {"soil": "brown"}, "^soil must be a label of the image, .* got 'brown'$"),
        (SMALL, {"soil": "browm"}, "^soil must be a whole number, a colour .* got 'browm'$"),
        (SMALL, {"soil": (139, 90, 256)}, r"^soil must be a whole .* got \(139, 90, 256\)$"),
        (SMALL, {"stones": [2]}, r"^stones must name all other labels, got none for 3 \(6\.67%\)$"),
        (SMALL, {"stones": []}, r"^stones must name all .* for 2 \(6\.67%\), 3 \(6\.67%\)$"),
        (SMALL, {"stones": [2, 4]}, r"^stones\[1\] must be a label of the image, .* got 4$"),
        (SMALL, {"stones": [2, 3, 2]}, r"^stones\[2\] must differ from .*, got 2$"),
        (SMALL, {"stones": [1, 2, 3]}, r"^stones\[0\] must differ from background, .* got 1$"),
        (SMALL, {"material": {1: GRANITE}}, "^material must have groups of stones, .* of 1$"),
        (SMALL, {"material": {8: GRANITE}}, "^material must be a label of the image, .* got 8$"),
        (SMALL, {"pixel": 0}, "^pixel must be a finite number > 0, got 0$"),
        (
            SMALL * [1, 1, 0, 1, 1, 1],
            {},
            r"^image must show soil and stones in one piece, .* got 2: 2 m2 near \(.*, 1 m2",
        ),
        (
            changed((3, 1), label=0),
            {},
            r"^image must show a slope without holes, got 0\.25",
        ),
        (
            changed(np.s_[1:4, 0], np.s_[1:4, 2], (1, 1), (3, 1), label=3),
            {},
            r"^image must show stones of label 3 without anything inside, got 0\.25 m2 near",
        ),
    ],
)
def test_refusal_of_images_and_labels(image, arguments, text):
    with pytest.raises(ValueError, match=text):
        from_image(image, **{"pixel": 0.5, **arguments})


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"image": SMALL / 2}, r"^image must be .* whole numbers .* got float64 of shape \(5, 6\)"),
        ({"image": SMALL[0]}, r"^image must be .* got int64 of shape \(6,\)"),
        ({"image": np.empty((0, 3), dtype=int)}, r"^image must be .* of shape \(0, 3\)"),
        ({"soil": 1.0}, r"^soil must be a whole number, a colour .* got 1\.0"),
        ({"soil": True}, "^soil must be a whole number, a colour .* got True"),
        ({"material": {2: "granite"}}, r"^material\[2\] must be a material, got 'granite'"),
        ({"material": 3}, "^material must be a material, a mapping .* got 3"),
        ({"stones": 2.5}, r"^stones must be a label, some labels or None, got 2\.5"),
        ({"pixel": "1 cm"}, "^pixel must be a finite number > 0, got '1 cm'"),
    ],
)
def test_refusal_of_the_wrong_type(arguments, text):
    with pytest.raises(TypeError, match=text):
        from_image(**{"image": SMALL, "pixel": 0.5, **arguments})


def test_refusal_of_files(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.png"):
        from_image(tmp_path / "none.png", 0.5)
    Image.fromarray(SMALL.astype(np.float32)).save(tmp_path / "float.tif")
    with pytest.raises(ValueError, match=r"^image must be a picture .* numbers are not whole"):
        from_image(tmp_path / "float.tif", 0.5)
    with pytest.raises(FileNotFoundError, match=r"^image must be an existing .*none\.png'$"):
        from_image(str(tmp_path / "none.png"), 0.5)
    with pytest.raises(FileNotFoundError, match=r"^image must be an existing file, got '\.'$"):
        from_image(".", 0.5)
    h5py.File(tmp_path / "run.h5", "w").close()
    with pytest.raises(ValueError, match=r"^image must be a picture .*run\.h5': it is no picture"):
        from_image(tmp_path / "run.h5", 0.5)
    noise = np.random.default_rng(1).integers(0, 255, (99, 99)).astype(np.uint8)
    Image.fromarray(noise).save(tmp_path / "cut.png")
    (tmp_path / "cut.png").write_bytes((tmp_path / "cut.png").read_bytes()[:500])
    with pytest.raises(ValueError, match=r"^image must be a picture .*cut\.png'"):
        from_image(tmp_path / "cut.png", 0.5)
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(ValueError, match=r"^image must be a picture .* got '.*text\.png'"):
        from_image(tmp_path / "text.png", 0.5)


def test_a_picture_of_blended_colours_is_refused_unless_its_stones_are_named(tmp_path):
    levels = np.arange(100, dtype=np.uint8).reshape(10, 10)
    Image.fromarray(levels).save(tmp_path / "blended.png")
    with pytest.raises(
        ValueError, match=r"^image must have at most 64 colours of stones .* got 98, "
    ):
        from_image(tmp_path / "blended.png", 0.5)
    assert len(from_image(tmp_path / "blended.png", 0.5, stones=range(2, 100)).stones) == 98
    assert len(from_image(levels, 0.5).stones) == 98


def picture_of(labels):
    return np.array([COLOURS[label] for label in range(3)], dtype=np.uint8)[labels]


def test_noise_is_not_taken_for_stones(tmp_path):
    labels, pixel = slope_with_discs(220, seed=1)
    noise = np.random.default_rng(1).integers(0, 2, (*labels.shape, 3))
    Image.fromarray((picture_of(labels) - noise).astype(np.uint8)).save(tmp_path / "noisy.png")
    named = {"background": "white", "soil": (139, 90, 43)}
    with pytest.raises(ValueError, match=r"^stones must be given where .*, got 22 such labels of "):
        from_image(tmp_path / "noisy.png", pixel, **named)
    with pytest.raises(ValueError, match=r"got 1 such labels of [\d,]+ pixels, 3 \("):
        from_image(np.where(noise[..., 0] & noise[..., 1], 3, labels), pixel)


@pytest.mark.parametrize("factor", [2, 3, 4])
def test_smooth_edges_are_not_taken_for_stones(tmp_path, factor):
    labels, pixel = slope_with_discs(220, seed=1)
    named = {"background": "white", "soil": (139, 90, 43)}
    size = tuple(factor * side for side in labels.shape[::-1])
    for name, method in (("smooth", Image.BILINEAR), ("sharp", Image.NEAREST)):
        Image.fromarray(picture_of(labels)).resize(size, method).save(tmp_path / f"{name}.png")
    with pytest.raises(ValueError, match=r"^stones must be given .* \d+ such labels of [\d,]+ pix"):
        from_image(tmp_path / "smooth.png", pixel / factor, **named)
    assert len(from_image(tmp_path / "sharp.png", pixel / factor, **named).stones) == 48


def test_many_stones_of_one_pixel_have_to_be_named():
    labels = np.ones((30, 30), dtype=int)
    labels[1::2, 1::2] = 7
    with pytest.raises(ValueError, match=r"got 1 such labels of 225 pixels, 7 \(25.00%\); name "):
        from_image(labels, 0.1, background=None)
    assert len(from_image(labels, 0.1, background=None, stones=7).stones) == 225
    larger = np.kron(labels, np.ones((2, 2), dtype=int))
    assert len(from_image(larger, 0.1, background=None).stones) == 225
    for row in (labels[1:2], labels[:, 1:2].T):
        assert len(from_image(row, 0.1, background=None).stones) == 15
        assert len(from_image(row.T, 0.1, background=None).stones) == 15
