"""The kernel refuses wrong arguments by name and value, and stops a run that diverges."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel_scene import ARRAYS, FREE, SOIL, block, solver

from gimpslope import _core

SCENE: dict[str, Any] = block(8, 6, speed=0.1) | {
    "walls": [FREE, FREE, ("fixed", 0.0, 0.0), FREE],
    "time_step": ("courant", 0.4),
    "gravity": (0.0, -9.81, 0.0),
}
N = len(SCENE["mass"])
PIC = ("alpha", 1.0)
STABLE = solver(SCENE).stable_time_step


def with_value(name: str, value: float) -> dict[str, Any]:
    """The scene with one entry of an array changed."""
    array = SCENE[name].astype(np.float64) if name != "material" else SCENE[name].copy()
    array.flat[5] = value
    return {name: array}


def with_wall(side: int, *wall: Any) -> dict[str, Any]:
    walls = list(SCENE["walls"])
    walls[side] = wall
    return {"walls": walls}


def assert_refused(make: Any, *parts: str) -> None:
    """Raises ValueError or TypeError; the message holds the parts: name, value, what is allowed."""
    with pytest.raises((ValueError, TypeError)) as caught:
        make()
    message = str(caught.value).lower()
    for part in parts:
        assert part.lower() in message, message


def names(cases: list[tuple[dict[str, Any], tuple[str, ...]]]) -> list[str]:
    return [" ".join((next(iter(changes)), *parts[1:2])) for changes, parts in cases]


MATERIALS = [
    ({"density": 0.0}, ("density", "0", "positive")),
    ({"density": np.nan}, ("density", "nan", "positive")),
    ({"density": np.inf}, ("density", "inf", "finite")),
    ({"young": -1.5}, ("young", "-1.5", "positive")),
    ({"young": np.nan}, ("young", "nan")),
    ({"poisson": 0.5}, ("poisson", "0.5", "(-1, 0.5)")),
    ({"poisson": -1.0}, ("poisson", "-1", "(-1, 0.5)")),
    ({"poisson": np.nan}, ("poisson", "nan")),
    ({"law": "mohr_coulomb"}, ("law", "mohr_coulomb", "elastic", "drucker_prager")),
    ({"friction": -1.0}, ("friction", "-1", "90")),
    ({"friction": 90.0}, ("friction", "90")),
    ({"friction": np.nan}, ("friction", "nan")),
    ({"cohesion": -2.5}, ("cohesion", "-2.5", "zero")),
    ({"cohesion": np.nan}, ("cohesion", "nan")),
    ({"cohesion": np.inf}, ("cohesion", "inf", "finite")),
    ({"cohesion": 0.0, "friction": 0.0}, ("cohesion", "0", "positive")),
    ({"dilation": 23.0}, ("dilation", "23", "friction")),
    ({"dilation": -1.0}, ("dilation", "-1")),
    ({"dilation": np.nan}, ("dilation", "nan")),
    ({"cone": "middle"}, ("cone", "middle", "outer", "inner", "plane_strain_associated")),
    ({"tension_cutoff": -3.0}, ("tension_cutoff", "-3", "[0, ")),
    ({"tension_cutoff": np.nan}, ("tension_cutoff", "nan")),
    ({"tension_cutoff": 1e5}, ("tension_cutoff", "100000", "cot")),
    ({"young": "stiff"}, ("young",)),
    ({"yuong": 1.0}, ("young",)),
]


@pytest.mark.parametrize(("changes", "parts"), MATERIALS, ids=names(MATERIALS))
def test_material(changes: dict[str, Any], parts: tuple[str, ...]) -> None:
    assert_refused(lambda: _core.Material(**(SOIL | changes)), *parts)


@pytest.mark.parametrize("name", ["density", "young", "poisson"])
def test_material_needs_its_elasticity(name: str) -> None:
    assert_refused(lambda: _core.Material(**{k: v for k, v in SOIL.items() if k != name}), name)


ARGUMENTS: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    # values
    *((with_value(name, np.nan), (name, "nan", "finite")) for name in ("position", "velocity")),
    *((with_value(name, np.inf), (name, "inf", "finite")) for name in ("position", "velocity")),
    *((with_value(name, -0.5), (name, "-0.5", "positive")) for name in ("mass", "volume")),
    *((with_value(name, 0.0), (name, "0", "positive")) for name in ("mass", "volume")),
    *((with_value(name, np.nan), (name, "nan")) for name in ("mass", "volume", "half_length")),
    (with_value("half_length", 0.0), ("half_length", "0", "positive")),
    (with_value("half_length", 0.8), ("half_length", "0.8", "1.5 cells")),
    (with_value("material", 1), ("material", "1", "index")),
    (with_value("material", -1), ("material", "-1", "index")),
    # shapes
    ({"position": np.zeros((N, 3))}, ("position",)),
    ({"position": np.zeros((2, N))}, ("position",)),
    ({"velocity": np.zeros((N - 1, 2))}, ("velocity",)),
    ({"velocity": np.zeros(2 * N)}, ("velocity",)),
    ({"half_length": np.full(N, 0.1)}, ("half_length",)),
    ({"half_length": np.full((2, N), 0.1)}, ("half_length",)),
    ({"half_length": np.zeros((0, 2))}, ("half_length", "0")),
    ({"mass": np.ones(N + 1)}, ("mass", str(N + 1))),
    ({"volume": np.ones((N, 2))}, ("volume", str(N))),
    ({"volume": np.ones((N, 1))}, ("volume", str(N))),
    ({"material": np.zeros(N - 2, int)}, ("material", str(N - 2), str(N))),
    ({"material": np.full(N, 0.7)}, ("material",)),
    ({name: SCENE[name][:0] for name in ARRAYS}, ("0",)),
    # names
    ({"shape": "cubic"}, ("shape", "cubic", "linear", "ugimp", "cpgimp")),
    ({"scheme": "usp"}, ("scheme", "usp", "usf", "usl", "musl")),
    ({"transfer": "tpic"}, ("transfer", "tpic", "flip", "apic", "xpic")),
    ({"transfer": "apic"}, ("blend", "0", "alpha 1")),
    ({"transfer": "xpic", "blend": ("viscosity", 1.0)}, ("blend", "1", "alpha 1")),
    ({"transfer": "xpic", "blend": PIC, "order": 0}, ("order", "0", "[1, 100]")),
    ({"transfer": "xpic", "blend": PIC, "order": 101}, ("order", "101", "[1, 100]")),
    ({"transfer": "apic", "blend": PIC, "order": 2}, ("order", "2", "xpic")),
    ({"transfer": "apic", "blend": PIC, "shape": "linear"}, ("transfer", "apic", "linear")),
    (
        {"volumetric_strain": "nodal"},
        ("volumetric_strain", "nodal", "point", "cell_average"),
    ),
    ({"volume_update": "log"}, ("volume_update", "log", "linear", "exponential")),
    (
        {"shape": "cpgimp", "domain_update": "corners"},
        ("domain_update", "corners", "none", "jacobian", "stretch", "deformation_diagonal"),
    ),
    ({"domain_update": "jacobian"}, ("domain_update", "cpgimp")),
    ({"shape": "cpgimp"}, ("domain_update", "none", "jacobian")),
    ({"blend": ("beta", 0.1)}, ("blend", "beta", "alpha", "viscosity", "relaxation_time")),
    ({"time_step": ("adaptive", 0.1)}, ("time_step", "adaptive", "fixed", "courant")),
    ({"instruction_set": "mmx"}, ("instruction_set", "mmx", "generic")),
    (with_wall(0, "sticky", 0.0, 0.0), ("wall", "sticky", "free", "roller", "fixed", "coulomb")),
    # numbers
    ({"cell": 0.0}, ("cell", "0", "positive")),
    ({"cell": -0.5}, ("cell", "-0.5", "positive")),
    ({"cell": np.nan}, ("cell", "nan")),
    ({"origin": (np.nan, 0.0)}, ("origin", "nan", "finite")),
    ({"origin": (0.0, np.inf)}, ("origin", "inf", "finite")),
    (with_wall(0, "fixed", 0.0, 0.2), ("left", "0.2", "grid line")),
    (with_wall(1, "fixed", 0.0, 2.26), ("right", "2.26", "grid line")),
    (with_wall(2, "roller", 0.0, -0.3), ("bottom", "-0.3", "grid line")),
    (with_wall(3, "coulomb", 0.1, np.nan), ("top", "nan", "grid line")),
    (with_wall(3, "coulomb", -0.1, 1.5), ("friction", "-0.1", "zero")),
    (with_wall(3, "coulomb", np.nan, 1.5), ("friction", "nan")),
    ({"blend": ("alpha", 1.2)}, ("alpha", "1.2", "1")),
    ({"blend": ("alpha", -0.1)}, ("alpha", "-0.1", "0")),
    ({"blend": ("alpha", np.nan)}, ("alpha", "nan")),
    ({"blend": ("viscosity", -1.5)}, ("viscosity", "-1.5", "zero")),
    ({"blend": ("viscosity", np.nan)}, ("viscosity", "nan")),
    ({"blend": ("relaxation_time", 0.0)}, ("relaxation_time", "0", "positive")),
    ({"blend": ("relaxation_time", np.inf)}, ("relaxation_time", "inf", "finite")),
    ({"time_step": ("fixed", 0.0)}, ("time_step", "0", "positive")),
    ({"time_step": ("fixed", np.nan)}, ("time_step", "nan")),
    ({"time_step": ("fixed", 0.5)}, ("time_step", "0.5", f"{STABLE:.6g}", "allow_unstable")),
    ({"time_step": ("courant", -0.4)}, ("courant", "-0.4", "positive")),
    ({"time_step": ("courant", 2.5)}, ("courant", "2.5", "allow_unstable")),
    ({"threads": 0}, ("threads", "0", "1")),
    ({"threads": -2}, ("threads", "-2", "1")),
    ({"threads": 5000}, ("threads", "5000", "1024")),
    ({"walls": [FREE] * 3}, ("walls",)),
    ({"treads": 2}, ("threads",)),
]


@pytest.mark.parametrize(("changes", "parts"), ARGUMENTS, ids=names(ARGUMENTS))
def test_argument(changes: dict[str, Any], parts: tuple[str, ...]) -> None:
    options = {k: v for k, v in changes.items() if k not in SCENE}
    assert_refused(lambda: solver(SCENE | changes, **options), *parts)


def test_points_must_be_within_reach_of_the_origin() -> None:
    far = SCENE | with_value("position", 1e12)
    assert_refused(lambda: solver(far).advance(1), "position", "1e+12", "origin")


def test_materials_may_not_be_missing() -> None:
    assert_refused(lambda: solver(SCENE | {"materials": []}), "material")


CALLS: list[tuple[str, tuple[Any, ...], tuple[str, ...]]] = [
    ("advance", (-1,), ("steps", "-1", "zero")),
    ("advance", (1.5,), ("steps",)),
    ("advance_to", (np.nan,), ("time", "nan", "finite")),
    ("advance_to", (np.inf,), ("time", "inf", "finite")),
    ("set_gravity", (np.nan, 0.0), ("gravity", "nan", "finite")),
    ("set_gravity", (0.0, np.inf), ("gravity", "inf", "finite")),
    ("set_gravity", (0.0, -9.81, -1.0), ("ramp", "-1", "zero")),
    ("set_gravity", (0.0, -9.81, np.nan), ("ramp", "nan")),
    ("set_damping", (-0.1,), ("local", "-0.1", "0")),
    ("set_damping", (1.0,), ("local", "1")),
    ("set_damping", (np.nan,), ("local", "nan")),
    ("set_time_step", ("fixed", 0.5), ("time_step", "0.5", f"{STABLE:.6g}")),
    ("set_time_step", ("courant", 3.0), ("courant", "3")),
    ("set_time_step", ("fixed", np.nan), ("time_step", "nan")),
    ("set_time_step", ("guess", 0.1), ("time_step", "guess", "fixed", "courant")),
    ("set_materials", ([],), ("materials", "0", "1")),
    ("get", ("colour",), ("field", "colour", "position", "velocity", "stress")),
    ("get", ("deformation_gradient",), ("deformation_gradient", "stretch")),
    ("view", ("colour",), ("field", "colour", "position")),
    ("set", ("colour", np.zeros(N)), ("field", "colour", "position")),
    ("set", ("mass", np.ones(N)), ("field", "mass", "position")),
    ("set", ("position", np.full((N, 2), np.nan)), ("position", "nan", "finite")),
    ("set", ("velocity", np.full((N, 2), np.inf)), ("velocity", "inf", "finite")),
    ("set", ("stress", np.zeros((N, 3))), ("stress",)),
    ("set", ("stress", np.zeros((4, N))), ("stress",)),
    ("set", ("stress", np.full((N, 4), np.nan)), ("stress", "nan", "finite")),
    ("set", ("body_force", np.zeros(N)), ("body_force",)),
    ("set", ("body_force", np.full((N, 2), np.nan)), ("body_force", "nan", "finite")),
    ("set", ("plastic_strain", -np.ones(N)), ("plastic_strain", "-1", "zero")),
    ("ledger", (), ("method", "ledger=True")),
    ("set", ("volume", np.zeros(N)), ("volume", "0", "positive")),
    ("set", ("volume", -np.ones(N)), ("volume", "-1", "positive")),
    ("set", ("plastic_strain", np.zeros(N - 1)), ("plastic_strain", str(N - 1), str(N))),
]


@pytest.mark.parametrize(("method", "given", "parts"), CALLS)
def test_call(method: str, given: tuple[Any, ...], parts: tuple[str, ...]) -> None:
    stepped = solver(SCENE)
    assert_refused(lambda: getattr(stepped, method)(*given), *parts)
    stepped.advance(2)
    assert stepped.steps == 2


def test_refused_settings_leave_the_old_ones() -> None:
    stepped, untouched = solver(SCENE), solver(SCENE)
    for method, given, _ in CALLS:
        with pytest.raises((ValueError, TypeError)):
            getattr(stepped, method)(*given)
    for each in (stepped, untouched):
        each.advance(20)
    np.testing.assert_array_equal(stepped.get("position"), untouched.get("position"))


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
def test_body_forces_of_zero_change_nothing(instruction_set: str) -> None:
    """Nodes with and without body forces are stepped by different instances of one loop."""
    free, given = (solver(SCENE, instruction_set=instruction_set) for _ in range(2))
    given.set("body_force", np.zeros((N, 2)))
    for each in (free, given):
        each.advance(20)
    np.testing.assert_array_equal(free.get("position"), given.get("position"))


def test_stiffer_materials_need_a_smaller_step() -> None:
    stepped, untouched = (solver(SCENE, time_step=("fixed", 0.9 * STABLE)) for _ in range(2))
    stiff = [_core.Material(**(SOIL | {"young": 1e8}))]
    assert_refused(lambda: stepped.set_materials(stiff), "time_step", "allow_unstable")
    for each in (stepped, untouched):
        each.advance(5)
    np.testing.assert_array_equal(stepped.get("stress"), untouched.get("stress"))


def test_linear_shape_needs_no_half_length() -> None:
    linear = solver(SCENE | with_value("half_length", 0.0), shape="linear")
    linear.advance(2)
    assert_refused(lambda: linear.get("half_length"), "half_length", "linear")


def test_viscosity_must_suit_the_step() -> None:
    largest = (0.5**2 / 6 + 0.125**2 / 3) / (0.5 * STABLE)
    fixed = {"time_step": ("fixed", 0.5 * STABLE)}

    def step(value: float) -> None:
        solver(SCENE | fixed, blend=("viscosity", value)).advance(1)

    step(0.99 * largest)
    assert_refused(lambda: step(1.01 * largest), "viscosity", f"{1.01 * largest:.2}")
    assert_refused(
        lambda: solver(SCENE | fixed, blend=("relaxation_time", 0.4 * STABLE)),
        "relaxation_time",
        f"{0.4 * STABLE:.2}",
    )


def test_unstable_step_can_be_allowed() -> None:
    for step in (("fixed", 1.5 * STABLE), ("courant", 2.5)):
        allowed = solver(SCENE | {"allow_unstable": True, "time_step": step})
        allowed.advance(1)
        assert allowed.steps == 1


PROBES: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    ({"shape": "cubic"}, ("shape", "cubic", "linear")),
    ({"position": np.zeros((3, 3))}, ("position", "3", "2")),
    ({"position": np.full((3, 2), np.nan)}, ("position", "nan")),
    ({"half_length": np.full((2, 2), 0.1)}, ("half_length", "2")),
    ({"half_length": np.full((3, 2), -0.1)}, ("half_length", "-0.1", "positive")),
    ({"half_length": np.full((3, 2), np.nan)}, ("half_length", "nan")),
    ({"half_length": np.full((3, 2), 1.6)}, ("half_length", "1.6", "1.5 cells")),
    ({"cell": 0.0}, ("cell", "0", "positive")),
    ({"cell": np.nan}, ("cell", "nan")),
    ({"origin": (np.nan, 0.0)}, ("origin", "nan")),
]


@pytest.mark.parametrize(("changes", "parts"), PROBES, ids=names(PROBES))
def test_shape_functions(changes: dict[str, Any], parts: tuple[str, ...]) -> None:
    given = {
        "shape": "ugimp",
        "position": np.zeros((3, 2)),
        "half_length": np.full((3, 2), 0.1),
        "cell": 1.0,
        "origin": (0.0, 0.0),
    }
    _core.shape_functions(**given)
    assert_refused(lambda: _core.shape_functions(**(given | changes)), *parts)


def test_return_mapping_refuses() -> None:
    soil, elastic = _core.Material(**SOIL), _core.Material(**(SOIL | {"law": "elastic"}))
    assert_refused(lambda: _core.return_mapping(soil, np.zeros((3, 3))), "stress", "3", "4")
    assert_refused(lambda: _core.return_mapping(soil, np.zeros(4)), "stress", "4")
    assert_refused(lambda: _core.return_mapping(elastic, np.zeros((3, 4))), "elastic")


def assert_diverges(stepped: _core.Solver, *parts: str, within: int = 400) -> None:
    with pytest.raises(_core.Diverged) as caught:
        stepped.advance(within)
    failure = caught.value
    assert isinstance(failure, RuntimeError)
    assert 1 <= failure.step <= within
    assert failure.time >= 0
    assert 0 <= failure.point < stepped.size
    for part in (str(failure.step), f"point {failure.point}", "likely cause", *parts):
        assert part in str(failure)
    assert stepped.steps < within


ALLOWED = {"allow_unstable": True, "time_step": ("fixed", 20 * STABLE)}


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize(
    "shape", ["linear", "ugimp", "jacobian", "stretch", "deformation_diagonal"]
)
def test_step_far_above_the_limit_diverges(shape: str, instruction_set: str) -> None:
    options = {"shape": shape}
    if shape not in ("linear", "ugimp"):
        options = {"shape": "cpgimp", "domain_update": shape}
    stepped = solver(SCENE | ALLOWED, instruction_set=instruction_set, **options)
    assert_diverges(stepped, "time step", "stable limit")


@pytest.mark.parametrize("threads", [1, 2])
def test_mad_speed_diverges(threads: int) -> None:
    stepped = solver(SCENE, threads=threads, time_step=("fixed", 0.5 * STABLE))
    stepped.set("velocity", np.full((N, 2), 1e6))
    assert_diverges(stepped, within=5)


def test_mad_speed_with_courant_steps_does_no_harm() -> None:
    stepped = solver(SCENE)
    stepped.set("velocity", np.full((N, 2), 1e6))
    with pytest.raises(_core.Diverged, match=r"point moves at .* wave speed"):
        stepped.advance(100)
    assert np.isfinite(stepped.get("position")).all()


def test_domains_that_jump_do_no_harm() -> None:
    """Domains that shrink by nearly half a cell while they move by as much, just after a step that
    moved them by half a cell without a sort."""
    for height in np.linspace(0.0, 1.0, 11):
        position = np.array([[x, height + y] for x in (-0.75, 0.75) for y in (0.0, 0.5)])
        scene = {
            "position": position,
            "velocity": np.tile([0.0, 0.499], (4, 1)),
            "half_length": np.full((4, 2), 1.3),
            "mass": np.ones(4),
            "volume": np.ones(4),
            "material": np.zeros(4, np.int32),
            "materials": [{"density": 1.0, "young": 1e-6, "poisson": 0.0}],
            "cell": 1.0,
            "origin": (0.0, 0.0),
            "time_step": ("fixed", 1.0),
        }
        dust = solver(scene, shape="cpgimp", domain_update="jacobian")
        dust.advance(1)
        dust.set("velocity", np.column_stack([-1.35 * position[:, 0], np.full(4, 0.49)]))
        try:
            dust.advance(1)
        except _core.Diverged as failure:
            assert "half a cell" in str(failure)
        assert np.isfinite(dust.get("position")).all()


def mad_stress(law: str, shape: str) -> _core.Solver:
    stepped = solver(SCENE | {"materials": [SOIL | {"law": law}]}, shape=shape)
    stress = np.zeros((N, 4))
    stress[7] = 1e300
    stepped.set("stress", stress)
    return stepped


@pytest.mark.parametrize("shape", ["linear", "ugimp"])
def test_mad_stress_diverges(shape: str) -> None:
    stepped = mad_stress("elastic", shape)
    assert_diverges(stepped, within=5)
    with pytest.raises((_core.Diverged, ValueError)):
        stepped.advance(50)
    stepped.energies()
    assert stepped.get("stress").shape == (N, 4)


@pytest.mark.parametrize("shape", ["linear", "ugimp"])
def test_mad_stress_is_cut_back_by_the_yield_surface(shape: str) -> None:
    stepped = mad_stress("drucker_prager", shape)
    stepped.advance(50)
    assert np.abs(stepped.get("stress")).max() < 1e6
    assert np.isfinite(stepped.get("position")).all()
