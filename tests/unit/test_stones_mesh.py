"""Slopes out of meshes: pieces of groups, exact areas, formats, groups, refusals."""

import math

import meshio
import numpy as np
import pytest

from gimpslope.materials import Elastic
from gimpslope.scene import Scene
from gimpslope.stones.sources.mesh import from_mesh

SOIL = Elastic(density=1800, young=30e6, poisson=0.3)
GRANITE = Elastic(density=2600, young=20e9, poisson=0.2)
BASALT = Elastic(density=2900, young=30e9, poisson=0.2)

RAYS = 32
RADIUS = 0.6
DISC = RAYS / 2 * math.sin(2 * math.pi / RAYS) * RADIUS**2


def squares_with_discs(corners, tags):
    """Squares of side 2 from lower left corners, each with a disc in its middle.

    The discs are of triangles in the physical groups `tags`, the rest is quads in group 10.
    """
    turn = 2 * np.pi * np.arange(RAYS) / RAYS
    ray = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    local = np.vstack([[(0, 0)], RADIUS * ray, ray / np.abs(ray).max(axis=1, keepdims=True)])
    first, second = np.arange(RAYS), np.roll(np.arange(RAYS), -1)
    fan = np.stack([np.zeros(RAYS, dtype=int), 1 + first, 1 + second], axis=1)
    ring = np.stack([1 + first, 1 + RAYS + first, 1 + RAYS + second, 1 + second], axis=1)
    offsets = len(local) * np.arange(len(corners))[:, None, None]
    every = (local + 1 + np.array(corners)[:, None]).reshape(-1, 2).round(12)
    points, merged = np.unique(every, axis=0, return_inverse=True)
    merged = merged.ravel()
    cells = [
        ("triangle", merged[(fan + offsets).reshape(-1, 3)]),
        ("quad", merged[(ring + offsets).reshape(-1, 4)]),
        ("line", merged[[[1 + RAYS, 2 + RAYS]]]),
    ]
    numbers = [np.repeat(tags, RAYS), np.full(len(corners) * RAYS, 10), np.array([5])]
    return meshio.Mesh(
        np.column_stack([points, np.zeros(len(points))]),
        cells,
        cell_data={"gmsh:physical": numbers},
        field_data={
            "edge": np.array([5, 1]),
            "soil": np.array([10, 2]),
            "granite": np.array([20, 2]),
            "basalt": np.array([30, 2]),
        },
    )


def three_discs():
    return squares_with_discs([(0, 0), (2, 0), (0, 2)], [20, 20, 30])


CENTRES = [(1, 1), (3, 1), (1, 3)]


def test_outline_and_stones_have_the_areas_of_their_cells():
    outline, stones = from_mesh(three_discs(), soil="soil", stones=["granite", "basalt"])
    assert outline.area == pytest.approx(12)
    assert outline.bounds == (0, 0, 4, 4)
    np.testing.assert_allclose(stones.areas, DISC)
    np.testing.assert_allclose(stones.centroids, CENTRES)
    assert stones.content(outline) == pytest.approx(3 * DISC / 12)


def test_scene_accepts_them_with_the_content_by_points():
    outline, stones = from_mesh(
        three_discs(), soil="soil", stones=("basalt", "granite"), material={"basalt": BASALT}
    )
    scene = Scene(outline, SOIL, stones=stones, stone=GRANITE, cell=0.05)
    assert [stone.material for stone in stones] == [BASALT, None, None]
    assert np.mean(scene.points.stone >= 0) == pytest.approx(3 * DISC / 12, abs=1e-3)


def by_entities(mesh):
    """The mesh with a block for each physical group and an entity for each node, as gmsh has it."""
    blocks, entities = [], np.tile([2, 10], (len(mesh.points), 1))
    for cells, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"], strict=True):
        for tag in np.unique(tags):
            blocks.append((cells.type, cells.data[tags == tag], np.full(np.sum(tags == tag), tag)))
            entities[blocks[-1][1]] = (1 if cells.type == "line" else 2), tag
    tags = {name: [block[2] for block in blocks] for name in ("gmsh:physical", "gmsh:geometrical")}
    return meshio.Mesh(
        mesh.points,
        [block[:2] for block in blocks],
        point_data={"gmsh:dim_tags": entities},
        cell_data=tags,
        field_data=mesh.field_data,
    )


@pytest.mark.parametrize("suffix", ["22.msh", "22-binary.msh", "41.msh", "41-binary.msh", "vtu"])
def test_files_give_what_the_mesh_gives(tmp_path, suffix):
    mesh, path = three_discs(), tmp_path / f"slope{suffix if 'msh' in suffix else '.vtu'}"
    if suffix == "vtu":
        mesh.write(path)
    else:
        mesh = by_entities(mesh)
        version = "gmsh22" if suffix.startswith("22") else "gmsh"
        mesh.write(path, file_format=version, binary="binary" in suffix)
    groups = {"soil": 10, "stones": (20, 30)}
    if suffix != "vtu":
        groups = {"soil": "soil", "stones": ["granite", "basalt"]}
    outline, stones = from_mesh(str(path), **groups)
    assert outline.area == pytest.approx(12)
    np.testing.assert_allclose(stones.areas, DISC)
    np.testing.assert_allclose(stones.centroids, CENTRES)


def test_cell_data_by_name_and_cell_sets():
    mesh = three_discs()
    mesh.cell_data["region"] = [np.minimum(tags, 20) for tags in mesh.cell_data["gmsh:physical"]]
    by_data = from_mesh(mesh, soil=10, stones=20, cell_data="region", material=GRANITE).stones
    np.testing.assert_allclose(by_data.centroids, [(1, 1), (3, 1), (1, 3)])
    assert {stone.material for stone in by_data} == {GRANITE}
    mesh.cell_sets = {
        "sand": [[], np.arange(3 * RAYS), []],
        "block": [np.arange(3 * RAYS), [], []],
    }
    np.testing.assert_allclose(from_mesh(mesh, soil="sand", stones="block").stones.areas, DISC)


def grid(columns, rows, numbers):
    """Unit squares, row by row, with these numbers of groups."""
    row, column = np.divmod(np.arange(columns * rows), columns)
    low = row * (columns + 1) + column
    cells = np.stack([low, low + 1, low + columns + 2, low + columns + 1], axis=1)
    points = np.stack(np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0)), axis=-1)
    data = {"gmsh:physical": [np.ravel(numbers)]}
    return meshio.Mesh(points.reshape(-1, 2), [("quad", cells)], cell_data=data)


def test_stones_of_two_groups_that_touch_stay_apart_and_corners_do_not_join():
    mesh = grid(5, 3, [[1, 1, 1, 1, 1], [1, 2, 3, 1, 1], [1, 1, 1, 2, 1]])
    outline, stones = from_mesh(mesh, soil=1, stones=[2, 3])
    np.testing.assert_allclose(stones.centroids, [(1.5, 1.5), (3.5, 2.5), (2.5, 1.5)])
    assert len(stones.overlaps()) == len(stones.outside(outline)) == 0
    ring_of_four = grid(3, 3, [[1, 2, 1], [2, 1, 2], [1, 2, 1]])
    np.testing.assert_allclose(from_mesh(ring_of_four, soil=1, stones=2).stones.areas, [1] * 4)
    joined = grid(3, 1, [[1, 2, 2]])
    np.testing.assert_allclose(from_mesh(joined, soil=1, stones=2).stones.areas, [2])


def test_a_slope_without_stones():
    outline, stones = from_mesh(grid(3, 2, np.ones((2, 3), dtype=int)), soil=1, stones=[])
    assert (outline.area, len(stones)) == (6, 0)


GROUPS = r"\(10, 20, 30, 'soil', 'granite', 'basalt'\)"


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"soil": "sand"}, ValueError, rf"^soil must be a group .* {GROUPS}, got 'sand'"),
        ({"soil": "edge"}, ValueError, rf"^soil must be a group .* {GROUPS}, got 'edge'"),
        ({"soil": 1.5}, TypeError, rf"^soil must be a group .* {GROUPS}, got 1\.5"),
        ({"stones": 2.5}, TypeError, r"^stones must be a group or some groups, got 2\.5"),
        ({"stones": ["granite", 7]}, ValueError, r"^stones\[1\] must be a group .*, got 7"),
        ({"stones": "granite"}, ValueError, "^soil and stones must have all .* got 32 in neither"),
        (
            {"stones": ["granite", "basalt", 20]},
            ValueError,
            r"^stones\[2\] must share no cell .* got 20, 64 of whose 64 cells",
        ),
        (
            {"cell_data": "zone"},
            ValueError,
            r"^cell_data must name .*\('gmsh:physical'\), got 'zone'",
        ),
        (
            {"material": {"soil": GRANITE}},
            ValueError,
            "^material must have groups of stones, .*'soil'",
        ),
        (
            {"material": {"granite": 1}},
            TypeError,
            r"^material\['granite'\] must be a material, got 1",
        ),
        (
            {"mesh": np.eye(3)},
            TypeError,
            "^mesh must be the path of a mesh or a meshio.Mesh, got array",
        ),
    ],
)
def test_refusal_names_the_groups_that_are_there(arguments, error, text):
    good = {"mesh": three_discs(), "soil": "soil", "stones": ["granite", "basalt"]}
    with pytest.raises(error, match=text):
        from_mesh(**{**good, **arguments})


def moved(mesh, point, to):
    mesh.points[point] = to
    return mesh


def raised(mesh):
    z = np.linspace(0, 0.1, len(mesh.points))
    return meshio.Mesh(np.column_stack([mesh.points, z]), mesh.cells, cell_data=mesh.cell_data)


def with_cells(kind, corners):
    mesh = grid(2, 1, [[1, 2]])
    mesh.cells.append(meshio.CellBlock(kind, np.array([corners])))
    mesh.cell_data["gmsh:physical"].append(np.array([1]))
    return mesh


@pytest.mark.parametrize(
    ("mesh", "text"),
    [
        (
            grid(3, 3, [[2, 2, 2], [2, 1, 2], [1, 2, 2]]),
            "^mesh must show stones of group 2 without",
        ),
        (
            with_cells("triangle6", [0, 1, 2, 3, 4, 5]),
            r"^mesh must be .* straight .* 'triangle6'\]",
        ),
        (
            with_cells("tetra", [0, 1, 3, 4]),
            r"^mesh must be of triangles .* got \['quad', 'tetra'\]",
        ),
        (
            with_cells("quad", [1, 2, 5, 4]),
            "^mesh must be of cells that meet .* got 3 cells of 3 m2",
        ),
        (moved(grid(2, 1, [[1, 2]]), 1, (2.5, 0)), "^mesh must be of cells that meet side to side"),
        (raised(grid(2, 1, [[1, 2]])), r"^mesh must be in a plane .* got 0 to 0\.1 m"),
        (moved(grid(2, 1, [[1, 2]]), 0, np.nan), r"^mesh\.points must be .* finite .*, got nan"),
        (meshio.Mesh(np.eye(2), [("line", [[0, 1]])]), "^mesh must be of triangles .* got none"),
    ],
)
def test_refusal_of_meshes(mesh, text):
    with pytest.raises(ValueError, match=text):
        from_mesh(mesh, soil=1, stones=2)


def test_refusal_of_hanging_nodes_pieces_and_holes():
    points = np.array([(0, 0), (1, 0), (1, 2), (0, 2), (2, 0), (2, 1), (1, 1), (2, 2)], dtype=float)
    cells = [("quad", np.array([(0, 1, 2, 3), (1, 4, 5, 6), (6, 5, 7, 2)]))]
    hanging = meshio.Mesh(points, cells, cell_data={"gmsh:physical": [np.array([1, 2, 2])]})
    with pytest.raises(ValueError, match=r"^mesh must be of cells that meet .*"):
        from_mesh(hanging, soil=1, stones=2)
    apart = squares_with_discs([(0, 0), (5, 0)], [20, 30])
    with pytest.raises(
        ValueError, match=r"^mesh must show soil and stones in one piece, .* got 2: 4"
    ):
        from_mesh(apart, soil=10, stones=[20, 30])
    ring = squares_with_discs([(0, 0)], [20])
    ring.cells, ring.cell_data = ring.cells[1:2], {"gmsh:physical": [np.full(RAYS, 10)]}
    with pytest.raises(ValueError, match=r"^mesh must show a slope without holes, got 1\.12 m2"):
        from_mesh(ring, soil=10, stones=[])


def test_refusal_of_numbers_that_are_not_whole():
    mesh = grid(2, 1, np.array([[1.0, 2.0]]))
    with pytest.raises(TypeError, match=r"^cell_data must name whole numbers, .* of float64"):
        from_mesh(mesh, soil=1, stones=2)


@pytest.mark.parametrize("name", ["slope.msh", "slope.vtu", "slope.png"])
def test_refusal_of_files(tmp_path, name, capfd):
    with pytest.raises(FileNotFoundError, match=rf"^mesh must be an existing file, .*{name}"):
        from_mesh(tmp_path / name, soil=1, stones=2)
    (tmp_path / name).write_text("no mesh")
    with pytest.raises(
        ValueError, match=rf"^mesh must be a file that meshio reads, got '.*{name}'"
    ):
        from_mesh(tmp_path / name, soil=1, stones=2)
    assert capfd.readouterr() == ("", "")
