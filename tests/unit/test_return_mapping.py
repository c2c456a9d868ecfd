"""Drucker-Prager return mapping: surface, flow rule, dissipation, closest point, collapse."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from gimpslope import _core

Array = NDArray[np.float64]

CONES = ("outer", "inner", "plane_strain_associated", "plane_strain")
SCALE = 5e3  # of the trial stresses, Pa
SURFACE = 1e-12  # distance from the yield surface, in parts of SCALE


def soil(**changes: Any) -> _core.Material:
    given = {
        "density": 2000.0,
        "young": 1e6,
        "poisson": 0.3,
        "law": "drucker_prager",
        "friction": 22.0,
        "cohesion": 1e3,
    }
    return _core.Material(**(given | changes))


VARIANTS: dict[str, dict[str, Any]] = {cone: {"cone": cone} for cone in CONES}
VARIANTS |= {f"{cone}, dilation": {"cone": cone, "dilation": 9.0} for cone in CONES}
VARIANTS |= {f"{cone}, associated": {"cone": cone, "dilation": 22.0} for cone in CONES}
VARIANTS |= {
    "cut-off": {"tension_cutoff": 300.0},
    "cut-off, dilation": {"tension_cutoff": 300.0, "dilation": 9.0},
    "no tension": {"tension_cutoff": 0.0},
    "cohesionless": {"cohesion": 0.0},
    "cohesionless, dilation": {"cohesion": 0.0, "dilation": 9.0},
    "frictionless": {"friction": 0.0},
    "frictionless, cut-off": {"friction": 0.0, "tension_cutoff": 2e3},
    "steep": {"friction": 60.0, "dilation": 40.0},
}
variants = pytest.mark.parametrize("changes", VARIANTS.values(), ids=VARIANTS.keys())


def trial_stresses(n: int = 3000) -> Array:
    """Random stresses in all regimes, with some that have no deviator or no mean stress."""
    random = np.random.default_rng(7)
    stress = SCALE * random.standard_normal((n, 4)) * random.uniform(0, 1, (n, 1))
    stress[:, :3] += SCALE * random.uniform(-3, 2, (n, 1))
    stress[:20] = 0.0
    stress[:20, :3] = SCALE * np.linspace(-1, 3, 20)[:, None]
    stress[20:40, :3] -= stress[20:40, :3].mean(axis=1, keepdims=True)
    return stress


def invariants(stress: Array) -> tuple[Array, Array, Array]:
    """Mean stress (n,), deviator (n, 4) and sqrt(J2) (n,)."""
    mean = stress[:, :3].mean(axis=1)
    deviator = stress - mean[:, None] * (1, 1, 1, 0)
    j2 = (deviator[:, :3] ** 2).sum(axis=1) / 2 + deviator[:, 3] ** 2
    return mean, deviator, np.sqrt(j2)


def overshoot(material: _core.Material, cohesion: float, stress: Array) -> tuple[Array, Array]:
    """How far stresses lie outside the cone and beyond the tension limit, Pa."""
    eta, xi, _ = material.cone_coefficients
    mean, _, root = invariants(stress)
    return root + eta * mean - xi * cohesion, mean - material.tension_limit


def returned(changes: dict[str, Any]) -> tuple[_core.Material, float, Array, Array, Array]:
    """Material, cohesion, trial stress, returned stress and plastic strain of a variant."""
    material, trial = soil(**changes), trial_stresses()
    stress, plastic_strain = _core.return_mapping(material, trial)
    return material, changes.get("cohesion", 1e3), trial, stress, plastic_strain


@variants
def test_result_lies_in_or_on_the_surface(changes: dict[str, Any]) -> None:
    material, cohesion, trial, stress, _ = returned(changes)
    outside = np.maximum(*overshoot(material, cohesion, trial)) > 0
    after = np.maximum(*overshoot(material, cohesion, stress))
    assert 0.1 < outside.mean() < 0.99
    assert after.max() < SURFACE * SCALE
    assert np.abs(after[outside]).max() < SURFACE * SCALE


def test_nothing_goes_beyond_the_apex() -> None:
    """Where rounding might: any material, mean stresses about its limit. The deviator shrinks but
    does not turn over, and plastic strain is never negative."""
    random = np.random.default_rng(11)
    for cone in np.repeat(CONES, 150):
        friction = random.uniform(0.01, 60.0)
        cohesion = 10.0 ** random.uniform(-2, 8)
        dilation = random.choice([0.0, friction / 3, friction])
        material = soil(cone=str(cone), friction=friction, cohesion=cohesion, dilation=dilation)
        limit = material.tension_limit
        trial = limit * random.uniform(-1, 1, (200, 4)) * random.choice([1e-9, 1e-3, 1], (200, 1))
        trial[:, :3] += limit * random.choice([0.5, 1 - 1e-15, 1, 1 + 1e-15, 3], (200, 1))
        stress, plastic_strain = _core.return_mapping(material, trial)
        assert plastic_strain.min() >= 0.0
        assert (stress[:, 3] * trial[:, 3]).min() >= 0.0
        assert (np.abs(stress[:, 3]) <= np.abs(trial[:, 3])).all()


@variants
def test_elastic_stress_is_untouched(changes: dict[str, Any]) -> None:
    material, cohesion, trial, stress, plastic_strain = returned(changes)
    inside = np.maximum(*overshoot(material, cohesion, trial)) < -1e-9 * SCALE
    np.testing.assert_allclose(stress[inside], trial[inside], rtol=0, atol=1e-14 * SCALE)
    np.testing.assert_allclose(plastic_strain[inside], 0.0, atol=1e-17)


@variants
def test_returning_twice_changes_nothing(changes: dict[str, Any]) -> None:
    material, _, _, stress, _ = returned(changes)
    again, plastic_strain = _core.return_mapping(material, stress)
    np.testing.assert_allclose(again, stress, rtol=0, atol=SURFACE * SCALE)
    assert plastic_strain.max() < SURFACE * SCALE / material.shear_modulus


@variants
def test_flow_rule(changes: dict[str, Any]) -> None:
    """Plastic strain = a (s / (2 q) + etabar I / 3) + b I / 3; a, b >= 0 of active surfaces."""
    material, cohesion, trial, stress, plastic_strain = returned(changes)
    shear, bulk = material.shear_modulus, material.bulk_modulus
    _, _, etabar = material.cone_coefficients
    mean, deviator, root = invariants(trial)
    mean_after, deviator_after, root_after = invariants(stress)
    tiny = SURFACE * SCALE

    a = (root - root_after) / shear
    b = (mean - mean_after) / bulk - etabar * a
    assert a.min() > -tiny / shear
    assert b.min() > -tiny / bulk
    turned = deviator * root_after[:, None] - deviator_after * root[:, None]
    assert np.abs(turned).max() < tiny * SCALE * 10
    np.testing.assert_allclose(plastic_strain, a / np.sqrt(3), atol=tiny / shear)

    cone, tension = overshoot(material, cohesion, stress)
    slack = 1e-9 * SCALE
    assert np.abs(a[cone < -slack]).max(initial=0.0) < tiny / shear
    assert np.abs(b[tension < -slack]).max(initial=0.0) < 10 * tiny / bulk


@variants
def test_equivalent_plastic_strain(changes: dict[str, Any]) -> None:
    """sqrt(2/3 e:e) of the deviatoric plastic strain, from the stress that is lost."""
    material, _, trial, stress, plastic_strain = returned(changes)
    _, lost, _ = invariants(trial - stress)
    strain = lost / (2 * material.shear_modulus)
    contracted = (strain[:, :3] ** 2).sum(axis=1) + 2 * strain[:, 3] ** 2
    np.testing.assert_allclose(plastic_strain, np.sqrt(2 / 3 * contracted), rtol=1e-9, atol=1e-16)


@variants
def test_dissipation_is_never_negative(changes: dict[str, Any]) -> None:
    material, _, trial, stress, _ = returned(changes)
    lost_mean, lost, _ = invariants(trial - stress)
    mean, deviator, _ = invariants(stress)
    weight = np.array([1, 1, 1, 2])
    work = (deviator * lost * weight).sum(axis=1) / (2 * material.shear_modulus)
    work += mean * lost_mean / material.bulk_modulus
    assert work.min() >= -1e-14 * SCALE**2 / material.shear_modulus
    assert work.max() > 0


def closest_point(material: _core.Material, cohesion: float, mean: Array, root: Array) -> Array:
    """Admissible (p, q) nearest to the trial ones in the norm of elastic energy, found by halving.

    For a given p the best q is min(q, cone(p)); the slope of the distance (p - p0)^2 / 2K +
    (q - q0)^2 / 2G grows with p, and its zero, or the tension limit, is the answer.
    """
    eta, xi, _ = material.cone_coefficients
    shear, bulk = material.shear_modulus, material.bulk_modulus

    def best_root(p: Array) -> Array:
        return np.minimum(root, np.maximum(0.0, xi * cohesion - eta * p))

    low = np.full_like(mean, -1e3 * SCALE)
    high = np.full_like(mean, min(material.tension_limit, 1e3 * SCALE))
    for _ in range(120):
        p = (low + high) / 2
        over = root - best_root(p)
        uphill = (p - mean) / bulk + eta * over / shear > 0
        high, low = np.where(uphill, p, high), np.where(uphill, low, p)
    return np.stack([high, best_root(high)], axis=1)


@pytest.mark.parametrize("cutoff", [np.inf, 300.0])
@pytest.mark.parametrize("cone", CONES)
def test_associated_flow_gives_the_closest_point(cone: str, cutoff: float) -> None:
    changes = {"cone": cone, "dilation": 22.0, "tension_cutoff": cutoff}
    material, cohesion, trial, stress, _ = returned(changes)
    eta, _, etabar = material.cone_coefficients
    assert etabar == pytest.approx(eta, rel=1e-14)
    mean, _, root = invariants(trial)
    mean_after, _, root_after = invariants(stress)
    expected = closest_point(material, cohesion, mean, root)
    found = np.stack([mean_after, root_after], axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-11 * SCALE)


@pytest.mark.parametrize("cone", CONES)
def test_no_dilation_keeps_the_mean_stress(cone: str) -> None:
    material, cohesion, trial, stress, _ = returned({"cone": cone})
    eta, xi, etabar = material.cone_coefficients
    assert etabar == 0.0
    mean, deviator, root = invariants(trial)
    below = mean < material.tension_limit
    mean_after, deviator_after, _ = invariants(stress)
    np.testing.assert_allclose(mean_after[below], mean[below], atol=SURFACE * SCALE)
    scale = np.minimum(1.0, (xi * cohesion - eta * mean) / np.maximum(root, 1e-300))[:, None]
    scaled = (deviator * scale)[below]
    np.testing.assert_allclose(deviator_after[below], scaled, atol=SURFACE * SCALE)


@pytest.mark.parametrize("dilation", [0.0, 9.0, 22.0])
@pytest.mark.parametrize("cone", CONES)
def test_apex(cone: str, dilation: float) -> None:
    """Far in tension nothing is left but the mean stress c cot(phi), whatever the cone."""
    material = soil(cone=cone, dilation=dilation)
    apex = 1e3 / np.tan(np.radians(22.0))
    assert material.tension_limit == pytest.approx(apex, rel=1e-15)
    eta, xi, _ = material.cone_coefficients
    assert xi * 1e3 / eta == pytest.approx(apex, rel=1e-14)
    trial = np.array([[9e4, 8e4, 8.5e4, 1e3], [apex * 1.5] * 3 + [0.0], [5e5, 5e5, 5e5, 2e3]])
    stress, _ = _core.return_mapping(material, trial)
    expected = np.tile([apex, apex, apex, 0.0], (3, 1))
    np.testing.assert_allclose(stress, expected, rtol=1e-14, atol=1e-12 * apex)


def drive(material: _core.Material, start: Array, strain_step: Array, steps: int) -> Array:
    """Stress (4,) after equal strain steps (xx, yy, xy) of one material element."""
    shear = material.shear_modulus
    lame = material.bulk_modulus - 2 / 3 * shear
    xx, yy, xy = strain_step
    elastic = lame * (xx + yy) * np.array([1, 1, 1, 0]) + 2 * shear * np.array([xx, yy, 0, xy])
    stress = np.array(start, dtype=np.float64)[None]
    for _ in range(steps):
        stress, _ = _core.return_mapping(material, stress + elastic)
    return np.asarray(stress[0])


def collapse(material: _core.Material, dilation: float, confinement: float) -> tuple[float, float]:
    """Centre and radius, Pa, of Mohr's circle once a biaxial cell flows at constant stress.

    Strained in the ratio in which it dilates at collapse, any start leads there.
    """
    flow = np.sin(np.radians(dilation))
    step = 2e-3 * np.array([1 + flow, flow - 1, 0.0])
    stress = drive(material, np.array([-confinement] * 3 + [0.0]), step, 4000)
    again = drive(material, stress, step, 1)
    np.testing.assert_allclose(again, stress, rtol=1e-10)
    return (stress[0] + stress[1]) / 2, abs(stress[0] - stress[1]) / 2


def equivalent_angle(collapse_at: Callable[[float], tuple[float, float]]) -> float:
    """Friction angle, degrees, between the circles at collapse of two confinements."""
    (centre, radius), (other_centre, other_radius) = collapse_at(2e4), collapse_at(8e4)
    return float(np.degrees(np.arcsin((radius - other_radius) / (other_centre - centre))))


@pytest.mark.parametrize(
    ("cone", "angle"),
    [
        ("outer", 29.62),
        ("inner", 22.62),
        ("plane_strain_associated", 21.48),
        ("plane_strain", 22.00),
    ],
)
def test_equivalent_friction_angle_in_plane_strain(cone: str, angle: float) -> None:
    """Without dilation; known answers for 22 degrees."""
    material = soil(cone=cone)
    found = equivalent_angle(lambda confinement: collapse(material, 0.0, confinement))
    assert found == pytest.approx(angle, abs=0.005)


@pytest.mark.parametrize("dilation", [0.0, 5.0, 12.0, 22.0])
def test_plane_strain_cone_meets_mohr_coulomb(dilation: float) -> None:
    """s1 = Kp s3 + 2 c sqrt(Kp), compression positive, Kp = (1 + sin phi) / (1 - sin phi)."""
    material = soil(cone="plane_strain", dilation=dilation)
    centre, radius = collapse(material, dilation, 3e4)
    sine = np.sin(np.radians(22.0))
    kp = (1 + sine) / (1 - sine)
    assert kp == pytest.approx(2.198, abs=5e-4)
    major, minor = radius - centre, -radius - centre
    assert major == pytest.approx(kp * minor + 2e3 * np.sqrt(kp), rel=1e-9)


def test_associated_cone_meets_mohr_coulomb_with_associated_flow() -> None:
    material = soil(cone="plane_strain_associated", dilation=22.0)
    centre, radius = collapse(material, 22.0, 3e4)
    sine, cosine = np.sin(np.radians(22.0)), np.cos(np.radians(22.0))
    assert radius == pytest.approx(1e3 * cosine - centre * sine, rel=1e-9)


@pytest.mark.parametrize("cone", CONES)
def test_collapse_does_not_depend_on_the_start(cone: str) -> None:
    """Sheared from an uneven state, a cell without dilation ends on the same circle."""
    material = soil(cone=cone)
    step = 2e-3 * np.array([0.6, -0.6, 0.8])
    stress = drive(material, np.array([-2e4, -4e4, -3e4, 5e3]), step, 4000)
    centre, radius = (stress[0] + stress[1]) / 2, np.hypot((stress[0] - stress[1]) / 2, stress[3])
    expected_centre, expected_radius = collapse(material, 0.0, 3e4)
    assert centre == pytest.approx(expected_centre, rel=1e-9)
    assert radius == pytest.approx(expected_radius, rel=1e-9)
