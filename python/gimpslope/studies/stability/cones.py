"""Four cones go by the name Drucker-Prager, and in plane strain each has another friction angle.

The biaxial cell of `gimpslope verify` is squeezed to collapse at friction angles from 5 to 45
degrees, at two stresses on its sides; the line that touches both of Mohr's circles has the angle
that the soil really has. `DruckerPrager.plane_strain_friction` is the formula for it.
"""

from __future__ import annotations

from typing import get_args

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...materials import Cone
from ..check import Check
from ..verify import biaxial
from .mode import Findings, Mode, Table

TYPICAL = 22.0  # degrees


def run(full: bool) -> Findings:
    """All cones without dilation at all angles."""
    angles = np.arange(5.0, 46.0, 5.0 if full else 10.0)
    cones = get_args(Cone)
    formula = {cone: np.array([by_formula(cone, phi) for phi in angles]) for cone in cones}
    measured = {cone: np.array([squeezed(cone, phi) for phi in angles]) for cone in cones}
    typical = {cone: squeezed(cone, TYPICAL) for cone in cones}
    known = np.array([measured[cone] - formula[cone] for cone in cones])
    fails = [
        Check.near(
            f'cone "outer": friction angle it has at {TYPICAL:g} degrees',
            expected=biaxial.PUBLISHED["outer"],
            got=typical["outer"],
            within=5e-3,
            why="published figure to half of its last digit",
        ),
        Check.at_least(
            'cone "outer": angles from 5 to 45 degrees at which it has no collapse at all',
            bound=1,
            got=float(np.isnan(formula["outer"]).sum()),
            why="eta > 1 beyond asin(3 sqrt3 / (6 + sqrt3)) = 42.2 degrees: Mohr's circles outgrow "
            "any line",
        ),
    ]
    stands = [
        Check.at_most(
            "measured against the formula, largest difference, degrees",
            bound=1e-6,
            got=float(np.nanmax(np.abs(known))),
            why="exact at collapse: the sides are held to 1e-12",
        ),
        Check.at_most(
            f'cone "plane_strain_associated", the default: error at {TYPICAL:g} degrees',
            bound=0.6,
            got=abs(typical["plane_strain_associated"] - TYPICAL),
            why="published 21.48 without dilation; exact with associated flow",
        ),
        Check.at_most(
            'cone "plane_strain": largest error from 5 to 45 degrees, degrees',
            bound=1e-6,
            got=float(np.abs(measured["plane_strain"] - angles).max()),
            why="made to meet Mohr-Coulomb at collapse for its dilation",
        ),
    ]
    listed: list[tuple[str | float, ...]] = [
        (float(phi), *(_angle(measured[cone][k]) for cone in cones)) for k, phi in enumerate(angles)
    ]
    columns = ("given, degrees", *(f"{cone}, has" for cone in cones))
    return Findings(fails, stands, draw(angles, formula, measured), Table(columns, listed))


def soil(cone: Cone, friction: float) -> gs.DruckerPrager:
    """That of the biaxial cell with another friction angle, so stiff that it collapses at once."""
    return gs.DruckerPrager(1800.0, 6e9, 0.33, friction, biaxial.COHESION, cone=cone)


def by_formula(cone: Cone, friction: float) -> float:
    """The angle by formula, degrees; NaN where there is no collapse."""
    found = soil(cone, friction).plane_strain_friction
    return float("nan") if found is None else found


def squeezed(cone: Cone, friction: float) -> float:
    """The angle measured, degrees; NaN where there is no collapse."""
    of = soil(cone, friction)
    if of.plane_strain_friction is None:
        return float("nan")
    return biaxial.friction_angle([biaxial.squeezed(of, side) for side in biaxial.SIDES])


def _angle(value: float) -> str:
    return "no collapse" if np.isnan(value) else f"{value:.2f}"


def draw(
    angles: FloatArray, formula: dict[Cone, FloatArray], measured: dict[Cone, FloatArray]
) -> Figure:
    """The angle that a cone has over that which is given."""
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    ax = figure.add_subplot()
    for number, cone in enumerate(formula):
        ax.plot(angles, formula[cone], f"C{number}-", linewidth=0.8)
        ax.plot(angles, measured[cone], f"C{number}o", ms=4, label=cone.replace("_", " "))
    ax.plot(angles, angles, "k--", linewidth=0.8, label="Mohr-Coulomb")
    ax.set(
        xlabel="friction angle given (degrees)", ylabel="friction angle in plane strain (degrees)"
    )
    ax.legend(loc="upper left")
    return figure


MODE = Mode(
    name="cones",
    title="Four cones of one name",
    mechanism="Drucker-Prager replaces the six sides of Mohr-Coulomb by a cone, which can meet "
    "them in one way of loading only. The outer cone meets the corners of compression; in plane "
    "strain without dilation it is far stronger, 29.6 degrees where 22 are given, and beyond "
    "42.2 degrees it never fails. The inner one is weaker for large angles, and only the cone "
    "made for the dilation angle is exact.",
    source="de Souza Neto, Peric & Owen 2008, Computational Methods for Plasticity, section 6.4.4",
    advice='Name the cone. Use `cone="plane_strain"` where the friction angle is that of a test; '
    "`DruckerPrager.plane_strain_friction` says which one a material really has.",
    run=run,
)
