"""Scene files: every table becomes what it names, and nothing unknown is let through."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest
from PIL import Image

import gimpslope as gs
from gimpslope import scene_file

SOIL = """
[materials.soil]
density = 1800
young = 30e6
poisson = 0.33
friction = 22
cohesion = 1e3
"""
SLOPE = """
[outline]
height = 9
crest = 2
angle = 45
"""
GRANITE = """
[materials.granite]
law = "elastic"
density = 2600
young = 20e9
poisson = 0.2
"""
STONE = GRANITE.replace("granite", "stone")
STONES = """
[[stones]]
centre = [2.0, 3.0]
axes = [1.2, 0.6]
angle = 30
material = "granite"

[[stones]]
vertices = [[4, 1], [5, 1], [5, 2]]
"""

SOIL_OF_FILE = gs.DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
ROCK = gs.Elastic(density=2600, young=20e9, poisson=0.2)


def setup_of(folder: Path, text: str, cell: str = "cell = 0.1") -> gs.Setup:
    path = folder / "scene.toml"
    path.write_text(f"{cell}\n{text}")
    return scene_file.read(path)


def test_the_shortest_scene_has_the_defaults(tmp_path: Path) -> None:
    assert setup_of(tmp_path, SLOPE + SOIL) == gs.Setup(gs.Scene(gs.Outline.slope(), SOIL_OF_FILE))


def test_every_table(tmp_path: Path) -> None:
    text = f"""
    points_per_cell = 9
    gravity = 9.8
    {SLOPE}
    {SOIL}
    {GRANITE}
    {STONE}
    {STONES}
    [walls]
    left = "roller"
    bottom = {{ coulomb = 0.2 }}
    top = "free"
    [method]
    shape = "cpgimp"
    viscosity = 0.5
    ledger = true
    [stages]
    gravity = {{ ramp = 0.3 }}
    [stages.settling]
    damping = "local"
    [stages.slide]
    duration = 4
    [recording]
    energy_interval = 0.01
    snapshot_times = [0.5, 1.6]
    """
    stones = gs.Stones(
        [
            gs.Stone(gs.Ellipse((2, 3), (1.2, 0.6), 30), ROCK),
            gs.Outline(np.array([(4, 1), (5, 1), (5, 2)])),
        ]
    )
    expected = gs.Setup(
        gs.Scene(
            gs.Outline.slope(),
            SOIL_OF_FILE,
            stones=stones,
            stone=ROCK,
            cell=0.2,
            points_per_cell=9,
            gravity=9.8,
            walls=gs.Walls(left=gs.Roller(), bottom=gs.Coulomb(0.2)),
        ),
        gs.Method(shape="cpgimp", viscosity=0.5, ledger=True),
        gs.Stages(gs.Gravity(0.3), gs.Settling(damping="local"), gs.Slide(4.0)),
        gs.Recording(energy_interval=0.01, snapshot_times=(0.5, 1.6)),
    )
    assert setup_of(tmp_path, text, "cell = 0.2") == expected


def test_stages_in_the_words_of_their_classes(tmp_path: Path) -> None:
    text = (
        SLOPE
        + SOIL
        + """
    [stages.settling]
    unbalanced = 1e-3
    courant = 0.5
    [stages.slide]
    duration = 4
    rest_ratio = 0.01
    rest_time = 0.5
    rest_change = 0.002
    """
    )
    settling = gs.Settling(unbalanced=1e-3, courant=0.5)
    assert setup_of(tmp_path, text).stages == gs.Stages(
        settling=settling, slide=gs.Slide(4.0).until_rest()
    )
    loaded = SLOPE + SOIL + "[stages.gravity]\nramp = 0.5\n[stages.settling]\nratio = 1e-6\n"
    assert setup_of(tmp_path, loaded).stages == gs.Stages(gs.Gravity(0.5), gs.Settling(1e-6))


def test_members_of_the_family_by_their_names(tmp_path: Path) -> None:
    text = SLOPE + SOIL
    text += '[method]\nshape = "quadratic_bspline"\nscheme = "musl"\ntransfer = "xpic"\norder = 3\n'
    member = gs.Method(shape="quadratic_bspline", scheme="musl", transfer="xpic", order=3)
    assert setup_of(tmp_path, text).method == member


def test_stones_are_drawn_as_the_function_draws_them(tmp_path: Path) -> None:
    text = (
        SLOPE
        + SOIL
        + GRANITE
        + """
    [draw]
    kind = "rounds"
    diameter = { law = "Uniform", low = 0.4, high = 0.8 }
    content = 0.1
    seed = 3
    material = "granite"
    """
    )
    drawn = gs.stones.rounds(
        gs.Outline.slope(), gs.stones.Uniform(0.4, 0.8), content=0.1, seed=3, material=ROCK
    )
    assert setup_of(tmp_path, text).scene.stones == drawn


def test_image_beside_the_file(tmp_path: Path) -> None:
    labels = np.zeros((20, 30), dtype=np.uint8)
    labels[5:, :] = 1
    labels[8:12, 4:10] = 2
    labels[14:18, 20:25] = 3
    Image.fromarray(labels).save(tmp_path / "slope.png")
    text = f"""
    {SOIL}
    {GRANITE}
    {STONE}
    [image]
    file = "slope.png"
    pixel = 0.1
    material = {{ 3 = "granite" }}
    """
    scene = setup_of(tmp_path, text).scene
    assert scene.outline.area == pytest.approx(4.5, rel=1e-3)
    assert [stone.material for stone in scene.stones] == [None, ROCK]
    np.testing.assert_allclose(gs.Stones(scene.stones).areas, [0.24, 0.2], rtol=1e-9)
    whole = np.ones((10, 10), dtype=np.uint8)
    Image.fromarray(whole).save(tmp_path / "block.png")
    block = f'{SOIL}\n[image]\nfile = "block.png"\npixel = 0.1\nbackground = "none"\n'
    assert setup_of(tmp_path, block).scene.outline.area == pytest.approx(1.0)


def test_mesh_beside_the_file(tmp_path: Path) -> None:
    corners = np.array([(0, 0), (2, 0), (4, 0), (0, 2), (2, 2), (4, 2)], dtype=float)
    mesh = meshio.Mesh(
        corners,
        [("quad", np.array([(0, 1, 4, 3), (1, 2, 5, 4)]))],
        cell_data={"group": [np.array([1, 2])]},
    )
    mesh.write(tmp_path / "slope.vtu")
    text = f"""
    {SOIL}
    {GRANITE}
    [mesh]
    file = "slope.vtu"
    soil = 1
    stones = [2]
    cell_data = "group"
    material = "granite"
    """
    scene = setup_of(tmp_path, text).scene
    assert scene.outline.area == pytest.approx(8.0)
    assert [(stone.area, stone.material) for stone in scene.stones] == [(4.0, ROCK)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (SLOPE + SOIL + "[wind]\nspeed = 3", "scene file has no 'wind'"),
        (SLOPE + SOIL + "[method]\nviscosty = 1", r"\[method\] method has no 'viscosty'"),
        (SLOPE.replace("height", "hight") + SOIL, r"\[outline\] outline has no 'hight'"),
        (SLOPE + SOIL.replace("friction", "phi"), r"\[materials.soil\] .* has no 'phi'"),
        (SLOPE + SOIL.replace("cohesion = 1e3", ""), r"\[materials.soil\] .* needs 'cohesion'"),
        (SLOPE + SOIL + "law = 'mohr'", "law must be one of 'drucker_prager', 'elastic'"),
        (SLOPE, r"\[materials\] must have a table soil"),
        (SLOPE + SOIL + GRANITE, r"materials must be .* got \['granite'\] besides"),
        (SLOPE + SOIL + STONES, r"\[stones\[0\]\] material must be one of 'soil', got 'granite'"),
        (SLOPE + SOIL + STONE + STONES.replace('"granite"', '"stone"') + "colour = 1", "'colour'"),
        (
            SLOPE + SOIL + "[walls]\nleft = 'glued'",
            r"\[walls\] left must be one of 'fixed', 'roller', 'free' or { coulomb = \.\.\. }, got",
        ),
        (
            SLOPE + SOIL + STONE + STONES.replace('"granite"', '"stone"') + "centre = [1, 1]",
            r"\[stones\[1\]\] a stone must have either vertices or centre, axes, angle, got",
        ),
        (
            SLOPE + "vertices = [[0, 0], [1, 0], [0, 1]]" + SOIL,
            r"\[outline\] outline must have either vertices or height, crest, angle, got height",
        ),
        (SLOPE + SOIL + "[walls]\nbottom = { mu = 1 }", "bottom has no 'mu'; its keys are coulomb"),
        (SLOPE + SOIL + "[walls]\nbottom = {}", "bottom needs 'coulomb'"),
        (SLOPE + SOIL + "[stages.melting]\nramp = 1", "a stage must be one of 'gravity'"),
        (SLOPE + SOIL + "[stages.slide]\nduration = -1", r"duration must be .* got -1"),
        (SLOPE + SOIL + "[draw]\nkind = 'cubes'", r"\[draw\] kind must be one of 'ellipses'"),
        (
            SLOPE + SOIL + "[draw]\nkind = 'rounds'\nsize = 1",
            r"\[draw\] rounds has no 'size'; its keys are diameter",
        ),
        (SLOPE + SOIL + "[draw]\nkind = 'rounds'\ndiameter = 1", "rounds needs 'seed'"),
        (
            SLOPE + SOIL + "[image]\nfile = 'a.png'",
            r"\[image\] must stand alone, got outline, image",
        ),
        (SOIL + "[image]\nfile = 'a.png'\npixel = 1", "a.png"),
        (SOIL + "[image]\npixel = 1", r"\[image\] file must name the image"),
        (SOIL + "[image]\nfile = 5\npixel = 1", r"\[image\] file must name the image, got 5"),
        (SOIL + "[image]\nfile = '.'\npixel = 1", r"\[image\]"),
        (SOIL + "[image]\nfile = 'a'\nimage = 'b'", "from_image has no 'image'"),
        (SOIL, r"\[outline\], \[image\] or \[mesh\] must say what slides"),
        ("materials = 3\n" + SLOPE, r"\[materials\] must be a table, got 3"),
        (SLOPE + SOIL + STONE, r"got \['stone'\] besides"),
        (
            SLOPE + SOIL + STONE + "[draw]\nkind = 'rounds'\ndiameter = 1\ncontent = 0.9\nseed = 1",
            "stones must fit into the outline, got places for",
        ),
        (SLOPE + SOIL + "cell", "must be TOML"),
        ("stones = 3\n" + SLOPE + SOIL, r"stones must be a list of tables"),
        ("method = 3\n" + SLOPE + SOIL, r"\[method\] must be a table, got 3"),
    ],
)
def test_refusals_name_the_file_the_table_and_the_key(
    text: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises((ValueError, TypeError, OSError), match=message) as refusal:
        setup_of(tmp_path, text)
    assert "scene.toml" in str(refusal.value)


@pytest.mark.parametrize(
    ("cell", "message"),
    [("", "the scene file needs 'cell', which is missing"), ("cell = 'wide'", "got 'wide'")],
)
def test_the_cell_must_be_said(cell: str, message: str, tmp_path: Path) -> None:
    with pytest.raises((ValueError, TypeError), match=rf"scene\.toml: .*{message}"):
        setup_of(tmp_path, SLOPE + SOIL, cell)


def test_the_material_of_the_rest_may_be_named_too(tmp_path: Path) -> None:
    named = STONES.replace('"granite"', '"stone"')
    assert setup_of(tmp_path, SLOPE + SOIL + STONE + named).scene.stone == ROCK
    scene = setup_of(tmp_path, SLOPE + SOIL + STONE + named + 'material = "stone"\n').scene
    assert scene.stone is None and scene.materials == (SOIL_OF_FILE, ROCK)


def test_a_run_gives_its_setup_back(tmp_path: Path) -> None:
    text = SLOPE + SOIL + "[stages.slide]\nduration = 0.05"
    setup = setup_of(tmp_path, text, "cell = 0.8")
    run = setup.simulate(tmp_path / "a.h5", progress=False)
    assert run.setup == setup
    assert gs.load(tmp_path / "a.h5") == gs.load(tmp_path / "scene.toml") == setup


def test_friction_of_rigid_stones(tmp_path: Path) -> None:
    rock = (
        GRANITE.splitlines()[1]
        + """
law = "rigid"
density = 2600
friction = 30
mutual_friction = 20
"""
    )
    text = SLOPE + SOIL + rock + STONES + STONE
    (first, _) = setup_of(tmp_path, text).scene.stones
    assert first.material == gs.Rigid(2600, friction=30, mutual_friction=20)
