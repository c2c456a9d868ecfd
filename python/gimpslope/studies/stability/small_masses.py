"""Stress last, from velocities that nodes of little mass have come to.

A row of points reaches over a grid line by d. The node beyond holds the mass of an edge d wide but
feels its stress: with one point there, S = d^2 / (4 h l) and G = d / (2 h l), it is accelerated by
G / S = 2 / d times the stress over rho. USL strains the point by that velocity, and the stress is
multiplied by 1 - C^2 h^2 G^2 / S a step, stable up to C^2 = 2 l / h: 1/2 at two points a cell
(C = 0.707), however small d is. USF and MUSL strain by velocities brought anew from the points,
where the kick counts by S. What coupling to the rest of the row leaves of it are the eigenvalues of
a step (`amplification`).
"""

from __future__ import annotations

from typing import get_args

import numpy as np
from matplotlib.figure import Figure

from ..._check import FloatArray
from ...method import Scheme
from ..check import Check
from . import rows
from .amplification import limit
from .mode import Findings, Mode, Table
from .step_limit import LENGTH, Case, limits

PER_SIDE = 2
ALONE = float(np.sqrt(1.0 / PER_SIDE))  # sqrt(2 l / h)
SCHEMES: tuple[Scheme, ...] = get_args(Scheme)


def run(full: bool) -> Findings:
    """The limit of a row over d, by theory and in the kernel."""
    reach = np.geomspace(1e-4, 0.5, 16 if full else 6)  # d, cells
    theory = {scheme: by_theory(reach, scheme) for scheme in SCHEMES}
    measured = {s: limits(Case("ugimp", s, PER_SIDE, 1), reach, False).elastic for s in SCHEMES}
    fails = [
        Check.at_most(
            "USL: limit where a node holds the least mass, by its eigenvalues",
            bound=ALONE,
            got=float(theory["usl"][0]),
            why="sqrt(2 l / h), a point alone; what holds to it makes it stiffer",
        ),
        Check.near(
            "USL: limit where a node holds the least mass, kernel",
            expected=float(theory["usl"][0]),
            got=float(measured["usl"][0]),
            within=0.03 * float(theory["usl"][0]),
            why="eigenvalues of the step; both are bisected to 1 %",
        ),
    ]
    stands = [
        Check.at_least(
            f"{scheme.upper()}: smallest limit over all d",
            bound=1.0,
            got=float(values.min()),
            why="no step above C = 1 is taken",
        )
        for scheme, values in measured.items()
        if scheme != "usl"
    ]
    listed: list[tuple[str | float, ...]] = [
        (
            float(d),
            *(float(theory[s][k]) for s in SCHEMES),
            *(float(measured[s][k]) for s in SCHEMES),
        )
        for k, d in enumerate(reach)
    ]
    names = [f"{s.upper()}, theory" for s in SCHEMES] + [f"{s.upper()}, kernel" for s in SCHEMES]
    columns = ("reach over the line d, cells", *names)
    return Findings(fails, stands, draw(reach, theory, measured), Table(columns, listed))


def by_theory(reach: FloatArray, scheme: Scheme) -> FloatArray:
    """Limits by the eigenvalues of a step, shape (n,)."""
    place = (np.arange(LENGTH * PER_SIDE) + 0.5) / PER_SIDE
    half = np.full_like(place, 0.5 / PER_SIDE)
    return np.array([limit(*rows.along("ugimp", place + d, half), scheme) for d in reach])


def draw(
    reach: FloatArray, theory: dict[Scheme, FloatArray], measured: dict[Scheme, FloatArray]
) -> Figure:
    """Limit over reach."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for number, (scheme, values) in enumerate(theory.items()):
        ax.semilogx(reach, values, f"C{number}-", label=f"{scheme.upper()}, theory")
    for scheme, values in measured.items():
        number = SCHEMES.index(scheme)
        ax.semilogx(reach, values, f"C{number}o", mfc="none", label=f"{scheme.upper()}, kernel")
    ax.axhline(ALONE, color="k", linestyle=":", linewidth=0.8, label=r"$\sqrt{2 l / h}$")
    ax.set(xlabel="reach of the row over a grid line (cells)", ylabel="largest stable c dt / h")
    ax.set(ylim=(0, None))
    ax.legend(loc="center left", fontsize=8)
    return figure


MODE = Mode(
    name="small_masses",
    title="Nodes of small mass with USL",
    mechanism="A node that the edge of a body has just reached holds next to no mass, but the "
    "force on it falls more slowly, and its velocity after a step is enormous. Stress last (USL) "
    "strains the points by that velocity: energy is made at every free edge that meets a grid "
    "line, at steps at which the bulk is stable. Stress first, or velocities brought from the "
    "points again (MUSL), see the kick by the node's small share alone.",
    source="Sulsky, Zhou & Schreyer 1995, Comput. Phys. Commun. 87, 236; Bardenhagen 2002, J. "
    "Comput. Phys. 180, 383",
    advice='Keep `Method(scheme="usf")`, the default, or use "musl".',
    run=run,
)
