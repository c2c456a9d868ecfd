"""Materials: elastic constants, what is refused, and what reaches the kernel."""

import json
import math
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

from gimpslope.materials import DruckerPrager, Elastic, Material, Rigid

SOIL = DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
STONE = DruckerPrager(density=2400, young=20e9, poisson=0.2, friction=42, cohesion=900e3)


def test_elastic_constants_by_hand():
    # E = 2.6, nu = 0.3: G = 2.6 / 2.6, K = 2.6 / 1.2
    material = Elastic(density=4.0, young=2.6, poisson=0.3)
    assert material.shear_modulus == pytest.approx(1.0)
    assert material.bulk_modulus == pytest.approx(2.6 / 1.2)
    assert material.wave_speed == pytest.approx(math.sqrt((2.6 / 1.2 + 4 / 3) / 4))


@pytest.mark.parametrize("poisson", [-0.9, 0.0, 0.33, 0.499])
def test_wave_speed_is_that_of_the_constrained_modulus(poisson):
    material = Elastic(1000, 1e6, poisson)
    constrained = 1e6 * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    assert material.wave_speed == pytest.approx(math.sqrt(constrained / 1000))


def test_wave_speeds_of_the_study():
    assert SOIL.wave_speed == pytest.approx(157, abs=0.5)
    assert STONE.wave_speed == pytest.approx(3043, abs=0.5)


def test_elastic_drops_only_the_yield_surface():
    assert SOIL.elastic() == Elastic(density=1800, young=30e6, poisson=0.33)


def test_numpy_scalars_become_plain_numbers():
    material = Elastic(np.int64(1800), np.float32(2.0), np.float64(0.25))
    assert {type(getattr(material, name)) for name in ("density", "young", "poisson")} == {float}


def test_materials_are_frozen():
    with pytest.raises(FrozenInstanceError):
        SOIL.friction = 30  # type: ignore[misc]


def test_material_alone_is_not_made():
    with pytest.raises(TypeError, match="abstract"):
        Material(1800, 30e6, 0.33)  # type: ignore[abstract]


@pytest.mark.parametrize(
    "change",
    [
        {"poisson": 0},
        {"poisson": -0.99},
        {"friction": 0},
        {"friction": 89.9, "cone": "outer"},
        {"cohesion": 0},
        {"dilation": 22},
        {"tension_cutoff": 0},
        {"tension_cutoff": 1e3 / math.tan(math.radians(22))},
        {"friction": 0, "tension_cutoff": 1e9},
        {"cone": "inner"},
        {"cone": "plane_strain"},
    ],
    ids=str,
)
def test_ends_of_the_ranges_are_accepted(change):
    material = replace(SOIL, **change)
    assert {name: getattr(material, name) for name in change} == change


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("density", 0, ValueError),
        ("density", -1800.0, ValueError),
        ("density", math.nan, ValueError),
        ("density", np.float64("inf"), ValueError),
        ("density", 10**400, ValueError),
        ("density", True, TypeError),
        ("density", np.True_, TypeError),
        ("density", "heavy", TypeError),
        ("density", None, TypeError),
        ("young", 0, ValueError),
        ("young", [30e6], TypeError),
        ("poisson", 0.5, ValueError),
        ("poisson", -1, ValueError),
        ("poisson", math.nan, ValueError),
        ("friction", 90, ValueError),
        ("friction", -1, ValueError),
        ("cohesion", -1, ValueError),
        ("cohesion", math.inf, ValueError),
        ("dilation", 22.5, ValueError),
        ("dilation", -0.1, ValueError),
        ("cone", "Outer", ValueError),
        ("cone", 3, TypeError),
        ("tension_cutoff", -1, ValueError),
        ("tension_cutoff", 2476, ValueError),
        ("tension_cutoff", math.inf, ValueError),
    ],
)
def test_refusal_names_parameter_and_value(name, value, error):
    with pytest.raises(error, match=f"^{name} must be ") as refusal:
        replace(SOIL, **{name: value})
    shown = f"{value:g}" if isinstance(value, float) else str(value)
    assert shown in str(refusal.value)


def test_refusal_says_what_is_allowed():
    with pytest.raises(ValueError, match=r"^poisson must be in \(-1, 0\.5\), got 0\.5$"):
        Elastic(1800, 30e6, 0.5)
    with pytest.raises(ValueError, match=r"^cone must be one of 'outer', 'inner'.*, got 'round'$"):
        replace(SOIL, cone="round")
    with pytest.raises(ValueError, match=r"^dilation must be in \[0, 22\] degrees, .*, got 30$"):
        replace(SOIL, dilation=30)


def test_material_without_strength_is_refused():
    with pytest.raises(ValueError, match=r"cohesion must be positive where friction .* got 0"):
        replace(SOIL, friction=0, cohesion=0)


def test_cohesionless_material_bears_no_tension():
    with pytest.raises(ValueError, match=r"tension_cutoff must be in \[0, 0\] Pa, .* got 1"):
        replace(SOIL, cohesion=0, tension_cutoff=1)


@pytest.mark.parametrize(
    "material",
    [
        Elastic(1800, 30e6, 0.33),
        SOIL,
        replace(SOIL, dilation=5, cone="inner", tension_cutoff=10),
        Rigid(2400),
        Rigid(2400, friction=30, mutual_friction=10),
    ],
)
def test_round_trip_through_json(material):
    data = json.loads(json.dumps(material.to_dict()))
    assert Material.from_dict(data) == material
    assert type(material).from_dict(data) == material


def test_stored_material_is_checked_anew():
    data = SOIL.to_dict()
    with pytest.raises(ValueError, match="DruckerPrager has no 'cohesoin'; its keys are density"):
        Material.from_dict({**data, "cohesoin": 1.0})
    with pytest.raises(ValueError, match="DruckerPrager needs 'friction'"):
        Material.from_dict({key: value for key, value in data.items() if key != "friction"})
    with pytest.raises(ValueError, match=r"density must be .* got -1"):
        Material.from_dict({**data, "density": -1})
    with pytest.raises(ValueError, match="type must name a kind of Elastic, got 'DruckerPrager'"):
        Elastic.from_dict(data)
    with pytest.raises(ValueError, match="type must name a kind of Material, got 'Jelly'"):
        Material.from_dict({**data, "type": "Jelly"})
    with pytest.raises(TypeError, match="Material must be given as a mapping, got 3"):
        Material.from_dict(3)  # type: ignore[arg-type]


@pytest.mark.parametrize("material", [STONE, STONE.elastic()])
def test_kernel_sees_the_same_elasticity(material):
    core = material.to_core()
    assert core.bulk_modulus == pytest.approx(material.bulk_modulus)
    assert core.shear_modulus == pytest.approx(material.shear_modulus)
    assert core.wave_speed == pytest.approx(material.wave_speed)


def test_kernel_sees_the_same_strength():
    # phi = psi = 30: eta = etabar = 6 sin / (sqrt3 (3 - sin)) = 1.2 / sqrt3, xi = eta / tan
    core = replace(SOIL, friction=30, dilation=30, cone="outer").to_core()
    coefficients = (1.2 / math.sqrt(3), 1.2, 1.2 / math.sqrt(3))
    assert core.cone_coefficients == pytest.approx(coefficients)
    assert core.tension_limit == pytest.approx(1e3 * math.sqrt(3))
    assert replace(SOIL, tension_cutoff=7).to_core().tension_limit == 7
    assert replace(SOIL, friction=0).to_core().tension_limit == math.inf


def test_friction_angle_in_plane_strain():
    """Published for 22 degrees without dilation; the outer cone has no collapse from 42.2 on."""
    known = {"outer": 29.62, "inner": 22.62, "plane_strain_associated": 21.48, "plane_strain": 22}
    for cone, angle in known.items():
        of = replace(SOIL, cone=cone)
        assert of.plane_strain_friction == pytest.approx(angle, abs=5e-3)
    steepest = math.degrees(math.asin(3 * math.sqrt(3) / (6 + math.sqrt(3))))
    assert replace(SOIL, cone="outer", friction=steepest - 0.01).plane_strain_friction is not None
    assert replace(SOIL, cone="outer", friction=steepest + 0.01).plane_strain_friction is None
