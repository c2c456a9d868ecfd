"""The compiled kernel takes the same steps as its plain NumPy twin, whatever the options."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from kernel_scene import CLAY, FREE, SOIL, STONE, arguments, block, solver
from numpy.typing import NDArray

from gimpslope import _core
from reference import Material, Reference

Array = NDArray[np.float64]
State = dict[str, Array]

TOLERANCE = 1e-10
MATTERS = 1e-6  # least relative effect of an option that is alive
FIELDS = ("position", "velocity", "stress", "volume", "plastic_strain")

WIDTH, HEIGHT = 3.0, 2.0  # of the base scene, m
BASE: dict[str, Any] = block(12, 8, jitter=0.3, speed=0.4, prestress=3e3) | {
    "materials": [SOIL],
    "shape": "ugimp",
    "domain_update": "none",
    "volume_update": "linear",
    "walls": [("roller", 0.0, 0.0), FREE, ("coulomb", 0.3, 0.0), FREE],
    "blend": ("alpha", 0.05),
    "time_step": ("fixed", 4e-3),
    "gravity": (0.0, -9.81, 0.0),
    "damping": (0.0, False),
    "steps": 50,
}
N = len(BASE["mass"])
RANDOM = np.random.default_rng(1)
POSITIONS = {"left": 0.0, "right": WIDTH, "bottom": 0.0, "top": HEIGHT}


def walls(**sides: tuple[str, float]) -> list[tuple[str, float, float]]:
    """Free sides but those given as (kind, friction), at the edges of the base scene."""
    return [(*sides[side], place) if side in sides else FREE for side, place in POSITIONS.items()]


def soil(**changes: Any) -> dict[str, Any]:
    return {"materials": [SOIL | changes]}


def cpgimp(domain_update: str) -> dict[str, Any]:
    return {"shape": "cpgimp", "domain_update": domain_update}


# What is changed -> the changes, and the scene from which the result must differ.
OPTIONS: dict[str, tuple[dict[str, Any], str]] = {
    "base": ({}, ""),
    "linear": ({"shape": "linear"}, "base"),
    "own_half_lengths": (
        {"half_length": RANDOM.uniform(0.05, 0.25, (N, 2))},
        "base",
    ),
    "wide_half_lengths": (
        {"half_length": RANDOM.uniform(0.05, 0.75, (N, 2))},
        "base",
    ),
    "cpgimp_jacobian": (cpgimp("jacobian"), "base"),
    "cpgimp_stretch": (cpgimp("stretch"), "cpgimp_jacobian"),
    "cpgimp_deformation_diagonal": (cpgimp("deformation_diagonal"), "cpgimp_stretch"),
    "exponential_volume": ({"volume_update": "exponential"}, "base"),
    "cell_average": ({"volumetric_strain": "cell_average"}, "base"),
    "cell_average_exponential_volume": (
        {"volumetric_strain": "cell_average", "volume_update": "exponential"},
        "cell_average",
    ),
    "cell_average_cpgimp": (
        {"volumetric_strain": "cell_average"} | cpgimp("stretch"),
        "cpgimp_stretch",
    ),
    "cell_average_linear": (
        {"volumetric_strain": "cell_average", "shape": "linear"},
        "linear",
    ),
    "quadratic_bspline": ({"shape": "quadratic_bspline"}, "linear"),
    "cell_average_quadratic_bspline": (
        {"volumetric_strain": "cell_average", "shape": "quadratic_bspline"},
        "quadratic_bspline",
    ),
    "viscosity_quadratic_bspline": (
        {"blend": ("viscosity", 0.3), "shape": "quadratic_bspline"},
        "quadratic_bspline",
    ),
    "elastic": (soil(law="elastic"), "base"),
    "outer": (soil(cone="outer"), "base"),
    "inner": (soil(cone="inner"), "base"),
    "plane_strain": (soil(cone="plane_strain"), "base"),
    "dilation": (soil(dilation=10.0), "base"),
    "outer_dilation": (soil(cone="outer", dilation=10.0), "outer"),
    "inner_dilation": (soil(cone="inner", dilation=10.0), "inner"),
    "plane_strain_dilation": (soil(cone="plane_strain", dilation=10.0), "plane_strain"),
    "associated": (soil(cone="plane_strain", dilation=22.0), "plane_strain_dilation"),
    "tension_cutoff": (soil(tension_cutoff=200.0), "base"),
    "no_tension_dilation": (soil(tension_cutoff=0.0, dilation=5.0), "tension_cutoff"),
    "cohesionless": (soil(cohesion=0.0), "base"),
    "frictionless": (soil(friction=0.0), "base"),
    "two_materials": (
        {"materials": [SOIL, STONE], "material": RANDOM.integers(0, 2, N)},
        "base",
    ),
    "three_materials": (
        {"materials": [SOIL, STONE, CLAY], "material": RANDOM.integers(0, 3, N)},
        "two_materials",
    ),
    "flip": ({"blend": ("alpha", 0.0)}, "base"),
    "pic": ({"blend": ("alpha", 1.0)}, "base"),
    "viscosity": ({"blend": ("viscosity", 0.3)}, "flip"),
    "viscosity_linear": ({"blend": ("viscosity", 0.3), "shape": "linear"}, "linear"),
    "viscosity_own_half_lengths": (
        {"blend": ("viscosity", 0.3), "half_length": RANDOM.uniform(0.05, 0.25, (N, 2))},
        "viscosity",
    ),
    "relaxation_time": ({"blend": ("relaxation_time", 0.3)}, "flip"),
    "courant": ({"time_step": ("courant", 0.4)}, "base"),
    "courant_viscosity": (
        {"time_step": ("courant", 0.4), "blend": ("viscosity", 0.3)},
        "courant",
    ),
    "no_gravity": ({"gravity": (0.0, 0.0, 0.0)}, "base"),
    "gravity_ramp": ({"gravity": (0.0, -9.81, 0.1)}, "base"),
    "horizontal_gravity": ({"gravity": (3.0, -9.81, 0.0)}, "base"),
    "horizontal_gravity_ramp": ({"gravity": (3.0, -9.81, 1.0)}, "horizontal_gravity"),
    "body_force": ({"body_force": 5.0 * RANDOM.standard_normal((N, 2))}, "base"),
    "local_damping": ({"damping": (0.3, False)}, "base"),
    "kinetic_damping": ({"damping": (0.0, True)}, "base"),
    "both_dampings": ({"damping": (0.3, True)}, "kinetic_damping"),
    "free_walls": ({"walls": [FREE] * 4}, "base"),
}

# Gravity towards the wall and along it, so that the wall both holds and rubs.
PULL = {"left": (-9.0, 4.0), "right": (9.0, 4.0), "bottom": (4.0, -9.0), "top": (4.0, 9.0)}
for _side, _pull in PULL.items():
    _loaded = {"gravity": (*_pull, 0.0)}
    OPTIONS[f"{_side}_free"] = ({"walls": walls()} | _loaded, "")
    for _kind, _friction in (("roller", 0.0), ("fixed", 0.0), ("coulomb", 0.0), ("coulomb", 0.4)):
        OPTIONS[f"{_side}_{_kind}_{_friction}"] = (
            {"walls": walls(**{_side: (_kind, _friction)})} | _loaded,
            f"{_side}_free" if _friction == 0.0 else f"{_side}_coulomb_0.0",
        )

ROLLER, FIXED, ROUGH, SMOOTH = ("roller", 0.0), ("fixed", 0.0), ("coulomb", 0.5), ("coulomb", 0.1)
OPTIONS |= {
    "box_of_rollers": ({"walls": walls(**dict.fromkeys(POSITIONS, ROLLER))}, "base"),
    "fixed_box": ({"walls": walls(**dict.fromkeys(POSITIONS, FIXED))}, "box_of_rollers"),
    "coulomb_box": ({"walls": walls(**dict.fromkeys(POSITIONS, SMOOTH))}, "box_of_rollers"),
    "mixed_box": (
        {
            "walls": walls(left=ROUGH, right=FIXED, bottom=SMOOTH, top=ROLLER),
            "gravity": (-6.0, -9.81, 0.0),
        },
        "coulomb_box",
    ),
    "other_mixed_box": (
        {
            "walls": walls(left=SMOOTH, right=ROLLER, bottom=ROUGH, top=FIXED),
            "gravity": (-6.0, -9.81, 0.0),
        },
        "mixed_box",
    ),
    "walls_inside_the_block": (
        {"walls": [("fixed", 0.0, 0.5), ("coulomb", 0.2, 2.5), ("coulomb", 0.3, 0.5), FREE]},
        "base",
    ),
}

# Splines change at walls.
OPTIONS |= {
    f"quadratic_bspline_{name}": (OPTIONS[name][0] | {"shape": "quadratic_bspline"}, name)
    for name in (
        "box_of_rollers",
        "fixed_box",
        "coulomb_box",
        "mixed_box",
        "other_mixed_box",
        "walls_inside_the_block",
    )
}


def kernel(scene: dict[str, Any], instruction_set: str = "") -> State:
    compiled = solver(scene, instruction_set=instruction_set, ledger=True)
    compiled.advance(scene["steps"])
    fields = {name: compiled.get(name) for name in FIELDS}
    entries = compiled.ledger().values()  # to be judged by the size of the kinetic energy
    fields["energies"] = np.array([compiled.energies()["kinetic"], *entries])
    if "gimp" in scene["shape"]:
        fields["half_length"] = compiled.get("half_length")
    if scene.get("domain_update") in ("stretch", "deformation_diagonal"):
        fields["deformation_gradient"] = compiled.get("deformation_gradient").reshape(-1, 2, 2)
    return fields | {"time": np.array(compiled.time)}


def twin(scene: dict[str, Any]) -> State:
    materials = [Material(**given) for given in scene["materials"]]
    plain = Reference(materials=materials, margin=scene.get("margin", 8), **arguments(scene))
    plain.stress = np.array(scene["stress"])
    if "body_force" in scene:
        plain.body_force = scene["body_force"]
    plain.set_gravity(*scene["gravity"])
    plain.set_damping(*scene["damping"])
    plain.advance(scene["steps"])
    names = (*FIELDS, "half_length", "deformation_gradient", "time")
    state = {name: np.asarray(getattr(plain, name)) for name in names}
    kinetic = plain.mass @ np.sum(plain.velocity**2, axis=1) / 2
    return state | {"energies": np.array([kinetic, *vars(plain.ledger).values()])}


def relative_difference(a: Array, b: Array) -> float:
    scale = float(np.abs(b).max())
    return float(np.abs(a - b).max()) / (scale if scale > 0 else 1.0)


def assert_same(found: State, expected: State, start: Array) -> None:
    """Every field agrees; of the position, its change does."""
    for name, field in found.items():
        assert np.isfinite(field).all(), name
        since = start if name == "position" else 0.0
        assert relative_difference(field - since, expected[name] - since) < TOLERANCE, name


@cache
def option_scene(name: str) -> dict[str, Any]:
    return BASE | OPTIONS[name][0]


@cache
def option_result(name: str) -> State:
    return kernel(option_scene(name))


@cache
def option_twin(name: str) -> State:
    return twin(option_scene(name))


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize("name", OPTIONS)
def test_option(name: str, instruction_set: str) -> None:
    found = kernel(option_scene(name), instruction_set)
    assert_same(found, option_twin(name), BASE["position"])


@pytest.mark.parametrize("name", [name for name, (_, other) in OPTIONS.items() if other])
def test_option_matters(name: str) -> None:
    here, other = option_result(name), option_result(OPTIONS[name][1])
    effect = max(relative_difference(here[f], other[f]) for f in ("velocity", "stress", "volume"))
    assert effect > MATTERS


def test_base_scene_is_plastic_and_moves() -> None:
    result = option_result("base")
    yielded = (result["plastic_strain"] > 0).mean()
    assert yielded > 0.3
    assert np.abs(result["position"] - BASE["position"]).max() > 0.1 * BASE["cell"]
    assert (option_result("elastic")["plastic_strain"] == 0).all()


def spinning_disk() -> dict[str, Any]:
    """A turn of more than half a radian in one step: beyond the series of the rotation."""
    scene = block(12, 12, cell=0.5, corner=(-1.5, -1.5), jitter=0.3, prestress=1e3)
    position = 0.25 * scene["position"]
    turn_rate, dt = 300.0, 4e-3
    return scene | {
        "position": position + np.array([0.07, 0.04]),
        "velocity": turn_rate * np.column_stack([-position[:, 1], position[:, 0]]),
        "materials": [SOIL | {"young": 1e2, "law": "elastic"}],
        "walls": [FREE] * 4,
        "shape": "ugimp",
        "blend": ("alpha", 0.0),
        "time_step": ("fixed", dt),
        "allow_unstable": True,
        "gravity": (0.0, 0.0, 0.0),
        "damping": (0.0, False),
        "steps": 1,
    }


def long_flight() -> dict[str, Any]:
    """Thrown through negative coordinates, across many cells and sorts, with no wall near."""
    return (
        BASE
        | block(8, 6, corner=(0.3, -0.7), jitter=0.3, speed=0.1, prestress=1e3)
        | {
            "velocity": BASE["velocity"][:48] + np.array([-7.0, 11.0]),
            "walls": [FREE] * 4,
            "time_step": ("courant", 0.3),
            "steps": 150,
            "margin": 14,
        }
    )


def collapsing_column() -> dict[str, Any]:
    """Eleven rows of cells, i.e. two slabs and more, that slide through each other's nodes."""
    return (
        BASE
        | block(8, 22, jitter=0.2, speed=0.2, prestress=1e3)
        | {
            "walls": [("roller", 0.0, 0.0), FREE, ("coulomb", 0.1, 0.0), FREE],
            "materials": [SOIL | {"cohesion": 200.0}],
            "gravity": (4.0, -9.81, 0.0),
            "time_step": ("courant", 0.4),
            "steps": 150,
            "margin": 12,
        }
    )


def points_on_cell_lines() -> dict[str, Any]:
    """Every other column and row, where rounding tells in which cell strains are averaged. With
    this margin the twin has the first node of the kernel, from which both count."""
    cell = 0.7
    scene = block(12, 8, cell=cell, speed=0.4, prestress=3e3)
    return (
        BASE
        | scene
        | {
            "position": scene["position"] + cell / 4,
            "volumetric_strain": "cell_average",
            "steps": 5,
            "margin": 1,
        }
    )


def expanding_dust(domain_update: str) -> Callable[[], dict[str, Any]]:
    """Domains that grow from half a cell to more than one, so that the wide basis takes over."""

    def scene() -> dict[str, Any]:
        dust = block(8, 8, corner=(-1.0, -1.0), jitter=0.2, prestress=0.1)
        stretching = np.array([[1.2, 0.3], [-0.2, 0.9]])
        return (
            BASE
            | dust
            | {
                "velocity": dust["position"] @ stretching.T,
                "half_length": np.full((64, 2), 0.18),
                "materials": [SOIL | {"young": 10.0, "law": "elastic"}],
                "walls": [FREE] * 4,
                "blend": ("alpha", 0.0),
                "time_step": ("fixed", 0.03),
                "gravity": (0.0, 0.0, 0.0),
                "steps": 50,
                "margin": 14,
            }
            | cpgimp(domain_update)
        )

    return scene


def bursting_dust() -> dict[str, Any]:
    """Three steps in which points move and domains grow by a third of a cell and more each."""
    dust = block(4, 4, corner=(-0.5, -0.5), jitter=0.2)
    return (
        BASE
        | dust
        | {
            "velocity": 1.0 * dust["position"] + (0.15, 0.1),
            "half_length": np.full((16, 2), 0.3),
            "stress": np.zeros((16, 4)),
            "materials": [SOIL | {"young": 1.0, "law": "elastic"}],
            "walls": [FREE] * 4,
            "time_step": ("fixed", 0.35),
            "gravity": (0.0, 0.0, 0.0),
            "steps": 3,
            "margin": 12,
        }
        | cpgimp("jacobian")
    )


def few_points(count: int) -> Callable[[], dict[str, Any]]:
    """So few that they do not fill the fours and eights in which the kernel takes them."""

    def scene() -> dict[str, Any]:
        return BASE | block(count, 1, jitter=0.3, speed=0.3, prestress=3e3)

    return scene


SCENES = {
    "spinning_disk": spinning_disk,
    "long_flight": long_flight,
    "collapsing_column": collapsing_column,
    "points_on_cell_lines": points_on_cell_lines,
    "expanding_dust_jacobian": expanding_dust("jacobian"),
    "expanding_dust_stretch": expanding_dust("stretch"),
    "expanding_dust_deformation_diagonal": expanding_dust("deformation_diagonal"),
    "bursting_dust": bursting_dust,
    **{f"points_{count}": few_points(count) for count in (1, 2, 3, 5, 9)},
}


@cache
def scene_twin(name: str) -> State:
    return twin(SCENES[name]())


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize("name", SCENES)
def test_scene(name: str, instruction_set: str) -> None:
    scene = SCENES[name]()
    assert_same(kernel(scene, instruction_set), scene_twin(name), scene["position"])


def principal_direction(stress: Array) -> Array:
    return np.arctan2(2 * stress[:, 3], stress[:, 0] - stress[:, 1]) / 2


def test_scenes_do_what_they_are_for() -> None:
    scene = spinning_disk()
    turned = principal_direction(scene_twin("spinning_disk")["stress"])
    turn = np.abs((turned - principal_direction(scene["stress"]) + np.pi / 2) % np.pi - np.pi / 2)
    assert turn.max() > 0.5

    travel = scene_twin("long_flight")["position"] - long_flight()["position"]
    assert (np.abs(travel).max(axis=0) > 5 * BASE["cell"]).all()
    assert scene_twin("long_flight")["position"].min() < -2

    column = scene_twin("collapsing_column")
    assert np.ptp(collapsing_column()["position"][:, 1]) > 6 * BASE["cell"]
    assert np.abs(column["position"] - collapsing_column()["position"]).max() > BASE["cell"]
    assert (column["plastic_strain"] > 0.05).any()

    lines = points_on_cell_lines()
    places = lines["position"] / lines["cell"]
    assert (np.abs(places - np.round(places)) < 1e-12).mean() == 0.5
    counted = np.trunc((lines["position"] + lines["cell"]) * (1 / lines["cell"])) - 1
    assert (counted != np.floor(places)).any()

    for name in SCENES:
        if name.startswith("expanding_dust"):
            widest = scene_twin(name)["half_length"].max()
            assert SCENES[name]()["half_length"].max() < 0.5 * BASE["cell"] < widest


def test_trigger() -> None:
    """Elastic steps, the law changed, the stress released, and plastic steps."""
    soft = SOIL | {"cohesion": 200.0}
    scene = BASE | {"materials": [SOIL | {"law": "elastic"}]}
    compiled = solver(scene)
    plain = Reference(materials=[Material(**scene["materials"][0])], **arguments(scene))
    plain.stress = scene["stress"].copy()
    plain.set_gravity(*scene["gravity"])
    for stepper in (compiled, plain):
        stepper.advance(25)
    compiled.set_materials([_core.Material(**soft)])
    plain.materials = [Material(**soft)]
    released = compiled.release_stress()
    assert released > 0
    assert released == pytest.approx(plain.release_stress(), rel=TOLERANCE)
    for stepper in (compiled, plain):
        stepper.advance(25)
    found = {name: compiled.get(name) for name in FIELDS}
    assert_same(found, vars(plain), BASE["position"])
