"""A soil element is squeezed in plane strain while the stress on its sides is held.

A Mohr-Coulomb soil collapses at s1 = Kp s3 + 2 c sqrt(Kp), Kp = (1 + sin phi) / (1 - sin phi),
compression positive. On a Drucker-Prager cone sqrt(J2) + eta p = xi c with flow along etabar the
plastic strain out of the plane ends at collapse, which leaves the deviator
s_zz = -2/3 etabar sqrt(J2) there: Mohr's circle has the radius sqrt(J2) sqrt(1 - etabar^2 / 3)
about the stress p + etabar sqrt(J2) / 3, and touches the Mohr-Coulomb line of the angle

    sin phi_e = eta sqrt(1 - etabar^2 / 3) / (1 - eta etabar / 3)

through the apex of the cone, p = xi c / eta. The soil dilates at the angle
sin psi_e = etabar / sqrt(1 - etabar^2 / 3). (After de Souza Neto, Peric & Owen 2008, section 6.4.4,
who have it for associated flow.)
"""

from __future__ import annotations

from typing import get_args

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...materials import Cone
from ..check import Check
from .problem import Outcome, Problem

FRICTION, COHESION = 22.0, 1e3  # degrees, Pa
SIDES = (50e3, 100e3)  # stress on the sides s3, compression positive, Pa
STRAIN, STEPS = 0.1, 400  # axial, so far that the last elastic strain has died out
PUBLISHED: dict[Cone, float] = {"outer": 29.62, "inner": 22.62, "plane_strain_associated": 21.48}


def run(full: bool) -> Outcome:
    """All cones without dilation, and those of plane strain with it."""
    paths = {cone: [squeezed(soil(cone), s3) for s3 in SIDES] for cone in get_args(Cone)}
    exact: list[tuple[Cone, float]] = [("plane_strain", 0.0), ("plane_strain_associated", FRICTION)]
    if full:
        exact += [("plane_strain", psi) for psi in (5.0, 12.0, FRICTION)]
    checks = [
        *(check for cone, psi in exact for check in at_collapse(cone, psi)),
        *(
            Check.near(
                f"friction angle of the cone {cone}, degrees",
                expected=angle,
                got=friction_angle(paths[cone]),
                within=5e-3,
                why="published figure to half of its last digit",
            )
            for cone, angle in PUBLISHED.items()
        ),
        Check.at_most(
            "friction angles against the formula, largest error, degrees",
            bound=1e-9,
            got=max(abs(friction_angle(path) - formula(c)) for c, path in paths.items()),
            why="exact: the sides are held to 1e-12",
        ),
    ]
    return Outcome(checks, draw(paths))


def at_collapse(cone: Cone, dilation: float) -> list[Check]:
    """A cone that meets Mohr-Coulomb, for one dilation angle."""
    path = squeezed(soil(cone, dilation), SIDES[0])
    return [
        Check.near(
            f"s1 / s3, cone {cone}, psi = {dilation:g}",
            expected=mohr_coulomb(SIDES[0]) / SIDES[0],
            got=-path[-1, 3] / SIDES[0],
            within=1e-11,
            why="exact: the sides are held to 1e-12, which Kp = 2.2 enlarges",
        ),
        Check.near(
            f"dilation, cone {cone}, psi = {dilation:g}, degrees",
            expected=dilation,
            got=dilation_angle(path),
            within=1e-8,
            why="exact: the sides are held to 1e-12, 2e-12 of a strain step",
        ),
    ]


def soil(cone: Cone, dilation: float = 0.0) -> gs.DruckerPrager:
    return gs.DruckerPrager(1800.0, 60e6, 0.33, FRICTION, COHESION, dilation, cone)


def squeezed(material: gs.DruckerPrager, side: float) -> FloatArray:
    """Axial and lateral strain, and stresses xx, yy, zz (Pa), tension positive: a row a step."""
    stress = np.array([-side, -side, -side, 0.0])
    axial, lateral = -STRAIN / STEPS, 0.0
    rows = np.empty((STEPS, 5))
    for row in rows:
        stress, lateral = step(material, stress, axial, lateral, side)
        row[:] = axial, lateral, *stress[:3]
    rows[:, :2] = rows[:, :2].cumsum(axis=0)
    return rows


def step(
    material: gs.DruckerPrager, stress: FloatArray, axial: float, lateral: float, side: float
) -> tuple[FloatArray, float]:
    """Stress after an axial strain increment, and the lateral one that holds the sides, by
    Newton's method with the slope to a second point that is strained a little less."""
    apart = 1e-3 * abs(axial)
    gradient = np.zeros((2, 2, 2))
    gradient[:, 1, 1] = axial
    for _ in range(100):
        gradient[:, 0, 0] = lateral, lateral - apart
        after = gs.kernel.update_stress(material, np.tile(stress, (2, 1)), gradient, 1.0).stress
        miss, other = after[:, 0] + side
        if abs(miss) <= 1e-12 * side:
            return after[0], lateral
        lateral += apart * miss / (other - miss)
    raise ArithmeticError(f"the sides must be held at {side} Pa, got {after[0, 0]}")


def mohr_coulomb(side: float) -> float:
    """s1 at collapse, compression positive, Pa."""
    sine = np.sin(np.radians(FRICTION))
    kp = (1 + sine) / (1 - sine)
    return float(kp * side + 2 * COHESION * np.sqrt(kp))


def dilation_angle(path: FloatArray) -> float:
    """sin psi = dilation over the difference of the strains, in the last step; degrees."""
    axial, lateral = path[-1, :2] - path[-2, :2]
    return float(np.degrees(np.arcsin((lateral + axial) / (lateral - axial))))


def friction_angle(paths: list[FloatArray]) -> float:
    """Of the line that touches the circles at collapse for both stresses on the sides, degrees."""
    ends = np.array([path[-1, 2:4] for path in paths])
    centre, radius = ends.mean(axis=1), np.ptp(ends, axis=1) / 2
    return float(np.degrees(np.arcsin(-np.diff(radius) / np.diff(centre)))[0])


def formula(cone: Cone) -> float:
    """phi_e of the formula, degrees."""
    angle = soil(cone).plane_strain_friction
    assert angle is not None
    return angle


def draw(paths: dict[Cone, list[FloatArray]]) -> Figure:
    """Axial stress over axial strain, and Mohr's circles at collapse, for the lower s3."""
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(2, 3))
    turn = np.linspace(0, np.pi, 100)
    for colour, (cone, (path, _)) in enumerate(paths.items()):
        axial = -np.insert(path[:, 3], 0, -SIDES[0]) / 1e3
        strain = -100 * np.insert(path[:, 0], 0, 0.0)
        left.plot(strain, axial, f"C{colour}", label=cone.replace("_", " "))
        centre, radius = (axial[-1] + SIDES[0] / 1e3) / 2, (axial[-1] - SIDES[0] / 1e3) / 2
        right.plot(centre + radius * np.cos(turn), radius * np.sin(turn), f"C{colour}")
    left.axhline(mohr_coulomb(SIDES[0]) / 1e3, color="k", linestyle="--", linewidth=0.8)
    left.set(xlabel="axial strain (%)", ylabel="axial stress (kPa)", xlim=(0, 1))
    normal = np.array([0.0, 170.0])
    shear = COHESION / 1e3 + normal * np.tan(np.radians(FRICTION))
    right.plot(normal, shear, "k--", linewidth=0.8, label="Mohr-Coulomb")
    right.set(xlabel="normal stress (kPa)", ylabel="shear stress (kPa)", ylim=(0, None))
    right.set_aspect("equal")
    figure.legend(loc="outside upper center", ncols=5)
    return figure


PROBLEM = Problem("biaxial", "Biaxial cell", run)
