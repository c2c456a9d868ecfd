"""The cones of the NumPy twin and its return to them, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from reference import Material
from reference.drucker_prager import (
    cone,
    elastic_increment,
    invariants,
    moduli,
    return_mapping,
    tension_limit,
)

Array = NDArray[np.float64]
PLASTIC = Material(1800.0, 30e6, 0.33, "drucker_prager", 22.0, 1e3)
CONES = ("outer", "inner", "plane_strain_associated", "plane_strain")


def random_stress(seed: int, size: float, n: int = 400) -> Array:
    half = size * np.random.default_rng(seed).standard_normal((n, 3, 3))
    half[:, 2, :2] = half[:, :2, 2] = 0.0
    return half + np.swapaxes(half, 1, 2)


def test_cones_match_their_closed_forms() -> None:
    phi, psi = np.radians(22), np.radians(7)
    soil = replace(PLASTIC, dilation=7.0)

    def triaxial(a: float, sign: int) -> tuple[float, float]:
        below = np.sqrt(3) * (3 + sign * np.sin(a))
        return 6 * np.sin(a) / below, 6 * np.cos(a) / below

    def plane(a: float) -> tuple[float, float]:
        below = np.sqrt(9 + 12 * np.tan(a) ** 2)
        return 3 * np.tan(a) / below, 3 / below

    etabar = 3 * np.sin(psi) / np.sqrt(9 + 3 * np.sin(psi) ** 2)
    d = np.sqrt(1 - etabar**2 / 3) + etabar * np.sin(phi) / 3
    expected = {
        "outer": (*triaxial(phi, -1), triaxial(psi, -1)[0]),
        "inner": (*triaxial(phi, 1), triaxial(psi, 1)[0]),
        "plane_strain_associated": (*plane(phi), plane(psi)[0]),
        "plane_strain": (np.sin(phi) / d, np.cos(phi) / d, etabar),
    }
    for name, coefficients in expected.items():
        assert cone(replace(soil, cone=name)) == pytest.approx(coefficients, rel=1e-13)


@pytest.mark.parametrize("name", CONES)
@pytest.mark.parametrize("cutoff", [np.inf, 500.0])
def test_return_ends_on_or_inside_the_surface(name: str, cutoff: float) -> None:
    soil = replace(PLASTIC, cone=name, dilation=5.0, tension_cutoff=cutoff)
    eta, xi, _ = cone(soil)
    limit = tension_limit(soil)
    trial = np.concatenate([random_stress(4, 3e2), random_stress(5, 3e3)])
    stress, plastic_strain = return_mapping(soil, trial)
    p, _, q = invariants(stress)
    before_p, _, before_q = invariants(trial)
    f = q + eta * p - xi * 1e3
    yielded = before_q + eta * before_p > xi * 1e3
    assert yielded.sum() > 50 and (p > 0.999 * limit).sum() > 20 and (~yielded).sum() > 20
    assert f.max() < 1e-8 and p.max() < limit + 1e-8
    np.testing.assert_allclose(np.maximum(f, p - limit)[yielded], 0, atol=1e-8)
    inside = ~yielded & (before_p <= limit)
    np.testing.assert_array_equal(stress[inside], trial[inside])
    assert np.all(plastic_strain[inside] == 0) and np.all(plastic_strain >= 0)
    again, more = return_mapping(soil, stress)
    np.testing.assert_allclose(again, stress, atol=1e-8)
    np.testing.assert_allclose(more, 0, atol=1e-14)


@pytest.mark.parametrize("name", CONES)
@pytest.mark.parametrize("cutoff", [np.inf, 500.0])
def test_associated_return_is_the_closest_point_in_energy(name: str, cutoff: float) -> None:
    soil = replace(PLASTIC, cone=name, dilation=22.0, tension_cutoff=cutoff)
    _, shear, bulk = moduli(soil)
    trial = random_stress(5, 3e3, 150)
    stress, _ = return_mapping(soil, trial)
    p, s, _ = invariants(trial - stress)
    plastic = s / (2 * shear) + p[:, None, None] * np.eye(3) / (3 * bulk)
    admissible, _ = return_mapping(soil, random_stress(6, 2e3, 200))
    work = np.einsum("pij,apij->ap", plastic, admissible[:, None] - stress[None])
    assert work.max() < 1e-9


def test_equivalent_plastic_strain_is_that_of_the_deviatoric_plastic_strain() -> None:
    trial = random_stress(7, 3e3)
    stress, plastic_strain = return_mapping(PLASTIC, trial)
    _, shear, _ = moduli(PLASTIC)
    deviatoric = (invariants(trial)[1] - invariants(stress)[1]) / (2 * shear)
    expected = np.sqrt(2 / 3 * np.sum(deviatoric**2, axis=(1, 2)))
    np.testing.assert_allclose(plastic_strain, expected, atol=1e-15)


def test_plane_strain_failure_is_mohr_coulomb() -> None:
    """Shearing at the angle of dilation ends where the in-plane stresses meet Mohr-Coulomb."""
    for name, dilation in (("plane_strain_associated", 22.0), ("plane_strain", 0.0)):
        soil = replace(PLASTIC, cone=name, dilation=dilation)
        opening = np.sin(np.radians(dilation))
        rate = np.diag([opening + 1, opening - 1, 0])[None]
        stress = -1e5 * np.eye(3)[None]
        for _ in range(3000):
            stress, _ = return_mapping(soil, stress + elastic_increment(soil, 1e-5 * rate))
        high, low = stress[0, 0, 0], stress[0, 1, 1]
        phi = np.radians(22)
        strength = 2e3 * np.cos(phi) - (high + low) * np.sin(phi)
        assert high - low == pytest.approx(strength, rel=1e-6)
