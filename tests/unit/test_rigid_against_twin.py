"""Rigid stones in soil: the compiled kernel takes the same steps as its plain NumPy twin."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from kernel_scene import FREE, SOIL, STONE, arguments, block, solver
from numpy.typing import NDArray

from gimpslope import _core
from reference import Material, Reference
from reference.bodies import Rigid, least_share, shares, stone_contacts
from reference.ledger import Ledger

Array = NDArray[np.float64]
State = dict[str, Array]

TOLERANCE = 1e-11
RIGID_ONES = (1, 3)  # materials
MATTERS = 1e-3  # least relative effect of an option that is alive
FIELDS = ("position", "velocity", "stress", "volume", "plastic_strain")
CELL = 0.5
RIGID = {"density": 2600.0, "law": "rigid"}
HEAVY = {"density": 4000.0, "law": "rigid"}
SLIDING = RIGID | {"interface_friction": 25.0, "mutual_friction": 25.0}
ROUGH = RIGID | {"mutual_friction": 30.0}
SMOOTH, FIXED = ("coulomb", 0.0, 0.0), ("fixed", 0.0, 0.0)


def bed() -> dict[str, Any]:
    """Soil on a rough floor and against a smooth wall with three stones: number 7, an angular one
    of heavy rock that slides on the floor from the wall; 2, a rigid disk that spins and reaches
    out of the soil; and 4, a deformable one. Their points are given in no order."""
    scene = block(12, 9, cell=CELL, jitter=0.3, speed=0.2, prestress=3e3)
    x, y = scene["position"].T
    low = (y < 0.3) & (x < 1.6)
    corner = (x < 0.55) & (y < 0.8)
    disk = np.hypot(x - 1.9, y - 1.7) < 0.45
    soft = np.hypot(x - 2.5, y - 0.8) < 0.35
    stone = np.select([low | corner, disk, soft], [7, 2, 4], -1)
    material = np.select([stone == 7, stone == 2, stone == 4], [3, 1, 2], 0)
    density = np.array([SOIL["density"], 2600.0, STONE["density"], 4000.0])[material]
    scene |= {"stone": stone, "material": material, "mass": density * scene["volume"]}
    scene["position"][stone == 7] += 0.04  # out of the walls, which would throw it off
    scene["velocity"][stone == 7] = [0.5, 0.0]
    scene["velocity"][disk] = 3.0 * np.column_stack([1.7 - y, x - 1.9])[disk]
    order = np.random.default_rng(5).permutation(len(x))
    return {
        name: values[order] if isinstance(values, np.ndarray) else values
        for name, values in scene.items()
    }


BASE: dict[str, Any] = bed() | {
    "materials": [SOIL, RIGID, STONE, HEAVY],
    "shape": "ugimp",
    "walls": [SMOOTH, FREE, ("coulomb", 0.3, 0.0), FREE],
    "blend": ("alpha", 0.05),
    "time_step": ("fixed", 3e-3),
    "gravity": (1.0, -9.81, 0.0),
    "damping": (0.0, False),
    "steps": 100,
    "margin": 4,
}
N = len(BASE["mass"])
RANDOM = np.random.default_rng(1)


def heap() -> dict[str, Any]:
    """Three rigid stones that overlap in a row, and soil above and between: the first rests on the
    floor and against the wall, the others are thrown at it and at each other."""
    scene = block(14, 9, cell=CELL, jitter=0.3, speed=0.1, prestress=3e3)
    scene["position"] += 0.05
    x, y = scene["position"].T
    corner = (x < 0.9) & (y < 0.9)
    near = np.hypot(x - 1.5, y - 0.7) < 0.5
    top = np.hypot(x - 1.7, y - 1.7) < 0.45
    stone = np.select([corner, near, top], [5, 3, 1], -1)
    scene["velocity"][corner] = 0.0
    scene["position"][near] += [-0.22, -0.1]
    scene["velocity"][near] = [-1.0, 0.3]
    scene["position"][top] += [-0.1, -0.24]
    scene["velocity"][top] = [-0.5, -2.0]
    material = np.where(stone > 0, 1, 0)
    density = np.where(stone > 0, 2600.0, SOIL["density"])
    return scene | {
        "stone": stone,
        "material": material,
        "mass": density * scene["volume"],
        "materials": [SOIL, RIGID],
    }


def cpgimp(domain_update: str) -> dict[str, Any]:
    return {"shape": "cpgimp", "domain_update": domain_update}


def disk_alone() -> dict[str, Any]:
    """The angular stone deforms: local damping goes by the sign of a velocity, and that of a stone
    at rest on a wall is of rounding."""
    return {"material": np.where(BASE["stone"] == 7, 2, BASE["material"])}


def sliding(friction: float) -> dict[str, Any]:
    """Soil slides along both rigid stones."""
    angles = {"interface_friction": friction, "mutual_friction": friction}
    return {"materials": [SOIL, RIGID | angles, STONE, HEAVY | angles]}


def light(friction: float) -> dict[str, Any]:
    """Both weigh a twentieth, so that what their soil takes is found node by node now and then."""
    rigid = np.isin(BASE["material"], RIGID_ONES)
    mass = np.where(rigid, BASE["mass"] / 20, BASE["mass"])
    return sliding(friction) | {"mass": mass}


def pebbles() -> dict[str, Any]:
    """Two more stones: of two points, and of a single one, which has no spin."""
    stone, material = BASE["stone"].copy(), BASE["material"].copy()
    x, y = BASE["position"].T
    for number, place in ((9, (1.3, 0.9)), (11, (2.5, 1.6))):
        near = np.argsort(np.hypot(x - place[0], y - place[1]))[: 2 if number == 9 else 1]
        stone[near], material[near] = number, 1
    return {"stone": stone, "material": material}


# What is changed -> the changes, and the scene from which the result must differ.
OPTIONS: dict[str, tuple[dict[str, Any], str]] = {
    "base": ({}, ""),
    "flip": ({"blend": ("alpha", 0.0)}, "base"),
    "pic": ({"blend": ("alpha", 1.0)}, "base"),
    "linear": ({"shape": "linear"}, "base"),
    "quadratic_bspline": ({"shape": "quadratic_bspline"}, "linear"),
    "linear_flip": ({"shape": "linear", "blend": ("alpha", 0.0)}, "linear"),
    "own_half_lengths": (
        {
            "half_length": RANDOM.uniform(0.05, 0.12, (N, 2))
            * np.where(BASE["stone"] == 7, 1.0, 2.0)[:, None]
        },
        "base",
    ),
    "cpgimp_jacobian": (cpgimp("jacobian"), "base"),
    "cpgimp_stretch": (cpgimp("stretch"), "cpgimp_jacobian"),
    "cpgimp_stretch_flip": (cpgimp("stretch") | {"blend": ("alpha", 0.0)}, "cpgimp_stretch"),
    "cpgimp_deformation_diagonal": (cpgimp("deformation_diagonal"), "cpgimp_stretch"),
    "cell_average": ({"volumetric_strain": "cell_average"}, "base"),
    "cell_average_flip": (
        {"volumetric_strain": "cell_average", "blend": ("alpha", 0.0)},
        "cell_average",
    ),
    "body_force": ({"body_force": 5.0 * RANDOM.standard_normal((N, 2))}, "base"),
    "cell_average_body_force": (
        {
            "volumetric_strain": "cell_average",
            "body_force": 5.0 * RANDOM.standard_normal((N, 2)),
        },
        "cell_average",
    ),
    "disk_alone": (disk_alone(), "base"),
    "local_damping": (disk_alone() | {"damping": (0.3, False)}, "disk_alone"),
    "kinetic_damping": ({"damping": (0.0, True)}, "base"),
    "kinetic_damping_and_courant": (
        {"damping": (0.0, True), "time_step": ("courant", 0.1)},
        "base",
    ),
    "courant_and_ramp": (
        {"time_step": ("courant", 0.3), "gravity": (1.0, -9.81, 0.2)},
        "base",
    ),
    "pebbles": (pebbles(), "base"),
    "heap": (heap(), ""),
    "heap_on_fixed": (heap() | {"walls": [SMOOTH, FREE, ("fixed", 0.0, 0.0), FREE]}, "heap"),
    "heap_at_fixed": (heap() | {"walls": [FIXED, FREE, ("coulomb", 0.2, 0.0), FREE]}, "heap"),
    "heap_in_a_box": (
        heap() | {"walls": [("roller", 0.0, 0.0), ("coulomb", 0.5, 3.5), FIXED, FREE]},
        "heap",
    ),
    "heap_linear_flip": (
        heap() | {"shape": "linear", "blend": ("alpha", 0.0)},
        "heap",
    ),
    "heap_cpgimp": (heap() | cpgimp("stretch"), "heap"),
    "sliding": (sliding(25.0), "base"),
    "sliding_smooth": (sliding(0.0), "sliding"),
    "sliding_linear": (sliding(25.0) | {"shape": "linear"}, "sliding"),
    "sliding_body_force": (
        sliding(25.0) | {"body_force": 5.0 * RANDOM.standard_normal((N, 2))},
        "sliding",
    ),
    "sliding_damped": (sliding(25.0) | {"damping": (0.3, False)}, "sliding"),
    "one_slides": (
        sliding(25.0) | {"materials": [SOIL, SLIDING, STONE, HEAVY]},
        "sliding",
    ),
    "sliding_light": (light(60.0), "sliding"),
    "sliding_heap": (heap() | {"materials": [SOIL, SLIDING]}, "heap"),
    "heap_with_friction": (heap() | {"materials": [SOIL, ROUGH]}, "heap"),
}


def twin_of(scene: dict[str, Any]) -> Reference:
    materials = [
        rigid(given) if given.get("law") == "rigid" else Material(**given)
        for given in scene["materials"]
    ]
    options = arguments(scene) | {"stone": scene["stone"]}
    plain = Reference(materials=materials, margin=scene["margin"], **options)
    plain.stress = scene["stress"].copy()
    if "body_force" in scene:
        plain.body_force = scene["body_force"]
    plain.set_gravity(*scene["gravity"])
    plain.set_damping(*scene["damping"])
    return plain


def rigid(given: dict[str, Any]) -> Rigid:
    return Rigid(
        given["density"], given.get("interface_friction"), given.get("mutual_friction", 0.0)
    )


def kernel_of(scene: dict[str, Any], **options: Any) -> _core.Solver:
    return solver(scene, stone=scene["stone"], ledger=True, **options)


def state_of_kernel(compiled: _core.Solver) -> State:
    centre, angle, velocity, spin, impulse, turn = np.split(
        compiled.bodies()[0], [2, 3, 5, 6, 8], axis=1
    )
    # of small entries that are differences of large ones, and judged by the size of these
    energies = np.array([compiled.energies()["kinetic"], *compiled.ledger().values()])
    return {name: compiled.get(name) for name in FIELDS} | {
        "centre": centre,
        "angle": angle[:, 0],
        "body velocity": velocity,
        "spin": spin[:, 0],
        "impulse": impulse,
        "angular impulse": turn[:, 0],
        "energies": energies,
        "time": np.array(compiled.time),
    }


def state_of_twin(plain: Reference) -> State:
    bodies = plain.bodies
    kinetic = plain.kinetic_energy()
    return {name: getattr(plain, name) for name in FIELDS} | {
        "centre": np.array([b.centre for b in bodies]),
        "angle": np.array([b.angle for b in bodies]),
        "body velocity": np.array([b.velocity for b in bodies]),
        "spin": np.array([b.spin for b in bodies]),
        "impulse": np.array([b.impulse for b in bodies]),
        "angular impulse": np.array([b.angular_impulse for b in bodies]),
        "energies": np.array([kinetic, *vars(plain.ledger).values()]),
        "time": np.array(plain.time),
    }


def relative_difference(a: Array, b: Array) -> float:
    scale = float(np.abs(b).max())
    return float(np.abs(a - b).max()) / (scale if scale > 0 else 1.0)


@cache
def scene_of(name: str) -> dict[str, Any]:
    return BASE | OPTIONS[name][0]


@cache
def expected(name: str) -> State:
    """After the steps, with how near any choice came to a tie, and how often stones met."""
    plain = twin_of(scene_of(name))
    nearest, met = np.inf, 0
    for _ in range(BASE["steps"]):
        share, _ = shares(plain.bodies, plain.shape, plain.lines, plain.cell, plain.walls)
        nearest = min(nearest, distance_to_a_tie(share))
        met += len(list(stone_contacts(plain.bodies, plain.cell, 1.0)))
        plain.advance(1)
    return state_of_twin(plain) | {"nearest": np.array(nearest), "met": np.array(met)}


def distance_to_a_tie(share: Array) -> float:
    """Of the shares of cells from those at which a node is held or not, by this stone or by that,
    and at which two stones meet. Nearer than rounding there would be no telling."""
    first, *others = np.sort(share, axis=0)[::-1]
    distance = float(np.abs(share - least_share(share)).min())
    for other in others:
        both = other > 0
        gaps = np.abs([(first - other)[both], (first + other - 1)[both]])
        distance = min(distance, float(gaps.min(initial=np.inf)))
    return distance


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize("name", OPTIONS)
def test_option(name: str, instruction_set: str) -> None:
    """Both do the same sums in another order, and contacts by the same sweeps. The differences have
    measured at most 5e-13 of the largest value of a field (of the change of a position) over 200
    steps, with all choices the same: no share of a cell came nearer than 1e-9 to one at which
    another node would have been held."""
    compiled = kernel_of(scene_of(name), instruction_set=instruction_set)
    compiled.advance(BASE["steps"])
    scene = scene_of(name)
    rigid = np.isin(scene["material"], RIGID_ONES)
    assert compiled.body_numbers().tolist() == np.unique(scene["stone"][rigid]).tolist()
    assert expected(name)["nearest"] > 1e-9
    for field, found in state_of_kernel(compiled).items():
        assert np.isfinite(found).all(), field
        start = scene["position"] if field == "position" else 0.0
        difference = relative_difference(found - start, expected(name)[field] - start)
        assert difference < TOLERANCE, field


@pytest.mark.parametrize("name", [name for name, (_, other) in OPTIONS.items() if other])
def test_option_matters(name: str) -> None:
    here, other = expected(name), expected(OPTIONS[name][1])
    effect = max(relative_difference(here[f], other[f]) for f in ("velocity", "stress", "volume"))
    assert effect > MATTERS


def test_scene_is_plastic_and_its_stones_move() -> None:
    """Stress and volume of rigid points stay; the deformable stone and the soil yield or strain."""
    result, rigid = expected("base"), np.isin(BASE["material"], RIGID_ONES)
    soil = BASE["material"] == 0
    assert (result["plastic_strain"][soil] > 0).mean() > 0.5
    assert np.abs(result["position"] - BASE["position"]).max() > 0.25 * CELL
    assert np.abs(result["angle"]).max() > 0.02
    assert np.abs(result["impulse"]).max(axis=1).min() > 100.0
    entries = dict(zip(["kinetic", *vars(Ledger())], result["energies"], strict=True))
    for name in ("plastic", "friction", "impact", "transfer", "rigidity"):
        assert abs(entries[name]) > 10.0, name
    for name in ("stress", "volume"):
        np.testing.assert_array_equal(result[name][rigid], BASE[name][rigid])
        assert (result[name][~rigid] != BASE[name][~rigid]).any()


def test_stones_of_the_heap_meet() -> None:
    """Two of them are pressed together, and the lowest one on the walls, in most of the steps."""
    result = expected("heap")
    assert result["met"] > 0.5 * BASE["steps"]
    assert np.abs(result["angle"]).max() > 0.03
    spins = [expected(name)["spin"] for name in ("heap", "heap_on_fixed", "heap_at_fixed")]
    assert min(np.abs(a - b).max() for a, b in pairwise(spins)) > 0.01


def test_trigger() -> None:
    """Elastic steps, the law of the soil changed, its stress released, and plastic steps."""
    elastic = BASE | {"materials": [SOIL | {"law": "elastic"}, RIGID, STONE, HEAVY]}
    compiled, plain = kernel_of(elastic), twin_of(elastic)
    for stepper in (compiled, plain):
        stepper.advance(50)
    weak: dict[str, Any] = SOIL | {"cohesion": 200.0}
    compiled.set_materials([_core.Material(**given) for given in (weak, RIGID, STONE, HEAVY)])
    plain.materials[0] = Material(**weak)
    released = compiled.release_stress()
    assert released > 0
    assert released == pytest.approx(plain.release_stress(), rel=TOLERANCE)
    for stepper in (compiled, plain):
        stepper.advance(50)
    after = state_of_twin(plain)
    for field, found in state_of_kernel(compiled).items():
        assert relative_difference(found, after[field]) < TOLERANCE, field
