"""Elasticity and Drucker-Prager plasticity for stress tensors written out as (n_points, 3, 3)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LAWS = ("elastic", "drucker_prager")
CONES = ("outer", "inner", "plane_strain_associated", "plane_strain")


@dataclass
class Material:
    """Parameters of one material: SI units, angles in degrees."""

    density: float
    young: float
    poisson: float
    law: str = "elastic"
    friction: float = 0.0
    cohesion: float = 0.0
    dilation: float = 0.0
    cone: str = "plane_strain_associated"
    tension_cutoff: float = np.inf

    def __post_init__(self) -> None:
        if self.law not in LAWS:
            raise ValueError(f"law is {self.law!r}; allowed: {', '.join(LAWS)}")
        if self.cone not in CONES:
            raise ValueError(f"cone is {self.cone!r}; allowed: {', '.join(CONES)}")


def moduli(material: Material) -> tuple[float, float, float]:
    """Lamé's lambda, shear modulus G and bulk modulus K, Pa."""
    young, poisson = material.young, material.poisson
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    shear = young / (2 * (1 + poisson))
    return lame, shear, lame + 2 * shear / 3


def cone(material: Material) -> tuple[float, float, float]:
    """eta, xi and etabar of q + eta p = xi c with the flow potential q + etabar p.

    Mohr-Coulomb is q (cos lode - sin lode sin phi / sqrt 3) + p sin phi = c cos phi
    (de Souza Neto, Perić, Owen 2008, sec. 6.4); a cone fixes the bracket D of q.
    Outer and inner: lode = +30 and -30 degrees, triaxial compression and extension.
    Plane strain: no plastic strain along z, so s_zz = -2 q etabar / 3, half the in-plane stress
    difference is q sqrt(1 - etabar^2 / 3) and the in-plane mean stress p + q etabar / 3.
    """
    phi, psi = np.radians(material.friction), np.radians(material.dilation)

    def corner(lode: float, angle: float) -> float:
        return float(np.cos(lode) - np.sin(lode) * np.sin(angle) / np.sqrt(3))

    def plane_strain_flow(angle: float) -> float:
        return float(np.sin(angle) / np.sqrt(1 + np.sin(angle) ** 2 / 3))

    def plane(flow: float) -> float:
        return float(np.sqrt(1 - flow**2 / 3) + flow * np.sin(phi) / 3)

    if material.cone in ("outer", "inner"):
        lode = np.radians(30 if material.cone == "outer" else -30)
        bracket, flow = corner(lode, phi), np.sin(psi) / corner(lode, psi)
    elif material.cone == "plane_strain_associated":
        bracket, flow = plane(plane_strain_flow(phi)), plane_strain_flow(psi)
    else:
        bracket, flow = plane(plane_strain_flow(psi)), plane_strain_flow(psi)
    return float(np.sin(phi) / bracket), float(np.cos(phi) / bracket), float(flow)


def tension_limit(material: Material) -> float:
    """Largest mean stress, Pa: the cut-off or the apex of the cone, whichever is reached first."""
    eta, xi, _ = cone(material)
    apex = xi * material.cohesion / eta if eta > 0 else np.inf
    return float(min(apex, material.tension_cutoff))


def invariants(stress: Array) -> tuple[Array, Array, Array]:
    """Mean stress p (n,), deviator s (n, 3, 3) and q = sqrt(J2) (n,)."""
    p = np.trace(stress, axis1=1, axis2=2) / 3
    s = stress - p[:, None, None] * np.eye(3)
    return p, s, np.sqrt(np.sum(s * s, axis=(1, 2)) / 2)


def energy_density(material: Material, stress: Array) -> Array:
    """Elastic energy, J/m3."""
    _, shear, bulk = moduli(material)
    p, _, q = invariants(stress)
    return p**2 / (2 * bulk) + q**2 / (2 * shear)


def rotate(stress: Array, angle: Array) -> Array:
    """R stress R^T with R the turn by angle (n,), radians, about z."""
    r = np.zeros_like(stress)
    r[:, 0, 0] = r[:, 1, 1] = np.cos(angle)
    r[:, 1, 0], r[:, 0, 1] = np.sin(angle), -np.sin(angle)
    r[:, 2, 2] = 1.0
    return r @ stress @ np.swapaxes(r, 1, 2)


def elastic_increment(material: Material, strain: Array) -> Array:
    """Hooke's law for strain (n, 3, 3)."""
    lame, shear, _ = moduli(material)
    trace = np.trace(strain, axis1=1, axis2=2)[:, None, None]
    return np.asarray(lame * trace * np.eye(3) + 2 * shear * strain)


def return_mapping(material: Material, trial: Array) -> tuple[Array, Array]:
    """Stress (n, 3, 3) brought back to the yield surface, and the equivalent plastic strain (n,).

    Two surfaces, f = q + eta p - xi c and t = p - T, with Koiter's multipliers a and b:
    plastic strain = a (s / (2 q) + etabar I / 3) + b I / 3, hence
    q = q_trial - G a and p = p_trial - K (etabar a + b). (de Souza Neto et al. 2008, sec. 8.3.)
    T is never beyond the apex, so a mean stress below T keeps q >= 0.
    """
    if material.law == "elastic":
        return trial.copy(), np.zeros(len(trial))
    _, shear, bulk = moduli(material)
    eta, xi, etabar = cone(material)
    strength, limit = xi * material.cohesion, tension_limit(material)
    stress, plastic_strain = trial.copy(), np.zeros(len(trial))
    for i, (p, s, q) in enumerate(zip(*invariants(trial), strict=True)):
        f, t = q + eta * p - strength, p - limit
        if f <= 0 and t <= 0:
            continue
        a, b = max(0.0, f) / (shear + bulk * eta * etabar), 0.0  # the cone alone
        if p - bulk * etabar * a > limit:
            a, b = 0.0, t / bulk  # the tension cut-off alone
            if q + eta * limit - strength > 0:  # their corner; with T at the apex, the apex
                a = (q - (strength - eta * limit)) / shear
                b = t / bulk - etabar * a
        direction = s / q if q > 0 else np.zeros((3, 3))
        stress[i] = (q - shear * a) * direction + (p - bulk * (etabar * a + b)) * np.eye(3)
        plastic_strain[i] = a / np.sqrt(3)
    return stress, plastic_strain
