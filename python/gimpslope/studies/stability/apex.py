"""Tension beyond the apex of the cone, which the return along the cone cannot meet.

With psi = 0 the return keeps the mean stress p (tension positive) and scales the deviator to
sqrt(J2) = xi c - eta p. Beyond the apex, p > c cot(phi), that is negative: the shear stress comes
out reversed. The textbook's return to the apex puts p to c xi / etabar (de Souza Neto, Peric & Owen
2008, section 8.3): the apex where the flow is associated, far beyond it for small psi, and a
division by zero at psi = 0. The kernel returns to the apex itself.

What no return mapping tells is where a gap was: soil without cohesion that is drawn apart by a
strain e and closed again resists from the first moment, and where it was first it presses by K e.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .mode import Findings, Mode, Table

DENSITY, YOUNG, POISSON, FRICTION, COHESION = 1800.0, 30e6, 0.33, 22.0, 1e3
SOIL = gs.DruckerPrager(DENSITY, YOUNG, POISSON, FRICTION, COHESION)
APEX = COHESION / float(np.tan(np.radians(FRICTION)))  # Pa
SHEAR = 500.0  # trial shear stress, Pa
DILATIONS = (22.0, 5.0, 1.0, 0.1, 0.01)  # degrees
GAP = 0.01  # strain by which soil is drawn apart and closed again


def run(full: bool) -> Findings:
    """Trial stresses with shear and ever more tension, and a gap that opens and closes."""
    tension = np.linspace(0.0, 3 * APEX, 301 if full else 61)
    mean, shear = returned(tension)
    beyond = tension > APEX * (1 + 1e-9)
    fails = [
        Check.near(
            "every method here: mean stress once a gap is closed again, of -K e",
            expected=1.0,
            got=opened_and_closed(),
            within=1e-9,
            why="should be 0; the plastic strain of the opening is not undone, and with psi = 0 "
            "flow leaves the mean stress alone",
        ),
    ]
    stands = [
        Check.at_most(
            "kernel: largest sqrt(J2) beyond the apex, c",
            bound=1e-9,
            got=float(shear[beyond].max()) / COHESION,
            why="zero at the apex, to rounding",
        ),
        Check.at_most(
            "kernel: mean stress beyond the apex against c cot(phi), largest error",
            bound=1e-9,
            got=float(np.abs(mean[beyond] / APEX - 1).max()),
            why="the apex, to rounding",
        ),
    ]
    listed: list[tuple[str | float, ...]] = [
        (psi, textbook_apex(psi) / APEX, kernel_apex(psi) / APEX) for psi in DILATIONS
    ]
    columns = ("dilation angle, degrees", "textbook apex over c cot(phi)", "kernel")
    return Findings(
        fails, stands, draw(tension, along_cone(tension), shear), Table(columns, listed)
    )


def along_cone(tension: FloatArray) -> FloatArray:
    """sqrt(J2) after the return along the cone with psi = 0, Pa."""
    eta, xi, _ = SOIL.cone_coefficients
    return np.asarray(xi * COHESION - eta * tension)


def returned(tension: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean stress and sqrt(J2) after the return in the kernel, Pa."""
    trial = np.column_stack([tension, tension, tension, np.full_like(tension, SHEAR)])
    stress = gs.kernel.return_mapping(SOIL, trial).stress
    mean = stress[:, :3].mean(axis=1)
    deviator = stress[:, :3] - mean[:, None]
    return mean, np.sqrt((deviator**2).sum(axis=1) / 2 + stress[:, 3] ** 2)


def textbook_apex(dilation: float) -> float:
    """c xi / etabar, Pa."""
    soil = gs.DruckerPrager(DENSITY, YOUNG, POISSON, FRICTION, COHESION, dilation)
    _, xi, etabar = soil.cone_coefficients
    return COHESION * xi / etabar


def kernel_apex(dilation: float) -> float:
    """Mean stress to which the kernel returns pure tension far beyond the apex, Pa."""
    soil = gs.DruckerPrager(DENSITY, YOUNG, POISSON, FRICTION, COHESION, dilation)
    trial = np.array([[10 * APEX] * 3 + [0.0]])
    return float(gs.kernel.return_mapping(soil, trial).stress[0, 0])


def opened_and_closed() -> float:
    """Mean stress of loose sand drawn apart by GAP and closed again, parts of -K GAP."""
    sand = gs.DruckerPrager(DENSITY, YOUNG, POISSON, FRICTION, cohesion=0.0)
    stress, steps = np.zeros((1, 4)), 100
    for sign in (1.0, -1.0):
        gradient = np.zeros((1, 2, 2))
        gradient[0, 0, 0] = sign * GAP
        stress = gs.kernel.update_stress(sand, stress, gradient, 1 / steps, steps).stress
    return float(stress[0, :3].mean()) / (-sand.bulk_modulus * GAP)


def draw(tension: FloatArray, naive: FloatArray, shear: FloatArray) -> Figure:
    """sqrt(J2) after the return over the mean stress of the trial."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    ax.plot(tension / APEX, naive / COHESION, "C3-", label="along the cone")
    ax.plot(tension / APEX, shear / COHESION, "C0o", ms=3, label="kernel")
    ax.axhline(0.0, color="k", linewidth=0.6)
    ax.axvline(1.0, color="k", linestyle=":", linewidth=0.8, label="apex")
    ax.set(xlabel="mean stress of the trial / c cot(phi)", ylabel="sqrt(J2) after the return / c")
    ax.legend()
    return figure


MODE = Mode(
    name="apex",
    title="The apex of the cone, and tension",
    mechanism="Without dilation the return along the cone leaves the mean stress as it is; beyond "
    "the apex it asks for a negative length of the deviator and reverses the shear. The "
    "textbook's return to the apex divides by the dilation coefficient and so by zero. Where "
    "tension is cut to the apex the soil opens without resistance, but nothing remembers the "
    "gap: it resists as soon as it closes.",
    source="de Souza Neto, Peric & Owen 2008, Computational Methods for Plasticity, section 8.3",
    advice="The kernel returns to the apex, or to `tension_cutoff`. Read pressures where soil has "
    "opened and closed with care, and count the volume of soil that has been in tension as "
    "uncertain.",
    run=run,
)
