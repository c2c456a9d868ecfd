"""A share alpha of PIC a step is a viscosity, which grows as the step shrinks.

nu = alpha h^2 (1/6 + l^2 / (3 h^2)) / dt, the second moment of the shape function over the step. A
free bar swings with alpha = 0.01, the default, and its energy falls as exp(-nu k^2 t). A small
slope slides with that alpha, and with the viscosity that this is at the longest step; half the
step, and the first slides under twice the viscosity.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from .. import reference
from ..check import Check
from . import rows
from .mode import Findings, Mode, Table

ALPHA = 0.01
COURANTS = {False: (0.4, 0.1), True: (0.4, 0.2, 0.1, 0.05, 0.025, 0.0125)}
CELLS = {False: 0.6, True: 0.3}  # m
DURATION = 3.0  # s
BAR, SPEED = 20, 1e-4  # cells; of the wave
SETTLING, PERIODS = 10, 5  # of the bar: until what no node sees of its first motion is gone; then
STEADY = 0.03  # change of the run-out that a shorter step may make at a fixed viscosity


class Slide(NamedTuple):
    """Run-out of the furthest point (m), peak kinetic energy (J/m), viscosity (m2/s)."""

    run_out: float
    peak: float
    viscosity: float


def run(full: bool) -> Findings:
    """Both over ever shorter steps."""
    cell, courants = CELLS[full], COURANTS[full]
    nu = viscosity_of(ALPHA, cell, time_step(cell, courants[0]))
    by_share = {c: slide(cell, c, gs.Method(alpha=ALPHA, courant=c)) for c in courants}
    by_viscosity = {c: slide(cell, c, gs.Method(viscosity=nu, courant=c)) for c in courants}
    first, last = courants[0], courants[-1]
    kept = by_viscosity[last].run_out / by_viscosity[first].run_out
    lost = by_share[last].run_out / by_share[first].run_out
    fails = [
        Check.near(
            f"alpha = {ALPHA:g}, the default: damping at C = {last:g} over that at C = {first:g}",
            expected=first / last,
            got=damping(last) / damping(first),
            within=first / last * (np.pi / BAR * first) ** 2,
            why="alpha over dt, but for the square of omega dt",
        ),
        Check.at_most(
            f"alpha = {ALPHA:g}, the default: run-out at C = {last:g} over that at C = {first:g}",
            bound=1 - 5 * STEADY,
            got=lost,
            why="falls by more than five times what the step may change at a fixed viscosity",
        ),
    ]
    stands = [
        Check.near(
            f"viscosity = {nu:.3g} m2/s: run-out at C = {last:g} over that at C = {first:g}",
            expected=1.0,
            got=kept,
            within=STEADY,
            why="nothing depends on the step but its own error of first order",
        )
    ]
    listed: list[tuple[str | float, ...]] = [
        (
            c,
            by_share[c].viscosity,
            by_share[c].run_out,
            by_share[c].peak / 1e3,
            by_viscosity[c].run_out,
            by_viscosity[c].peak / 1e3,
        )
        for c in courants
    ]
    columns = (
        "Courant number",
        f"alpha = {ALPHA:g} acts as, m2/s",
        "run-out, m",
        "peak, kJ/m",
        f"viscosity {nu:.3g} m2/s: run-out, m",
        "peak, kJ/m",
    )
    return Findings(fails, stands, draw(by_share, by_viscosity), Table(columns, listed))


def time_step(cell: float, courant: float) -> float:
    """Of slope A at rest, s."""
    return courant * cell / reference.soil().wave_speed


def viscosity_of(alpha: float, cell: float, step: float) -> float:
    """As which a share acts, two points a cell and direction, m2/s."""
    return alpha * gs.kernel.second_moment("ugimp", cell / 4, cell=cell) / step


def damping(courant: float) -> float:
    """Rate at which the blend takes the energy of a free bar in its first mode: by what FLIP keeps
    of it at the same times, for energies swing within a period and the step is not exact."""
    with_share, without = (kept(gs.Method(alpha=a, time_step=courant)) for a in (ALPHA, 0.0))
    return float(np.log(without / with_share)) / (PERIODS * 2 * BAR)


def kept(method: gs.Method) -> float:
    """Share of its energy that the bar keeps over PERIODS."""
    points, period = rows.points((BAR, 1), 2), round(2 * BAR / method.step[1])
    velocity = np.zeros_like(points.position)
    velocity[:, 0] = SPEED * np.cos(np.pi * points.position[:, 0] / BAR)
    solver = rows.solver(points, rows.material(), method, row=True, velocity=velocity)
    energy = []
    for periods in (SETTLING, PERIODS):
        solver.advance(periods * period)
        of = solver.energies()
        energy.append(of.kinetic + of.elastic)
    return energy[1] / energy[0]


def slide(cell: float, courant: float, method: gs.Method) -> Slide:
    """Slope A on a coarse grid for a few seconds."""
    with tempfile.TemporaryDirectory() as folder:
        run = gs.simulate(
            reference.slope(cell=cell),
            DURATION,
            method=method,
            output=Path(folder) / "slope.h5",
            progress=False,
        )
        peak = run.summary["peak_kinetic_energy"]
        assert peak is not None
        share, step = method.blend[1], time_step(cell, courant)
        nu = viscosity_of(share, cell, step) if method.blend[0] == "alpha" else share
        return Slide(run.run_out(), peak, nu)


def draw(by_share: dict[float, Slide], by_viscosity: dict[float, Slide]) -> Figure:
    """Run-out over the step."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for label, found in ((f"alpha = {ALPHA:g} a step", by_share), ("viscosity", by_viscosity)):
        ax.semilogx(list(found), [of.run_out for of in found.values()], "o-", label=label)
    ax.set(xlabel="Courant number", ylabel=f"run-out after {DURATION:g} s (m)", ylim=(0, None))
    ax.set_xticks(list(by_share), [f"{courant:g}" for courant in by_share])
    ax.minorticks_off()
    ax.legend()
    return figure


MODE = Mode(
    name="blend",
    title="A share of PIC that acts as viscosity",
    mechanism="PIC averages velocities over the shape functions once a step. A share alpha of it "
    "is a diffusion by alpha times their second moment a step, the viscosity nu = alpha h^2 (1/6 "
    "+ l^2 / (3 h^2)) / dt. With a fixed alpha a shorter step, a stiffer stone among them, makes "
    "the whole slope more viscous and its run-out shorter.",
    source="derivation: problem `bar` of `gimpslope verify`; Hammerquist & Nairn 2017, CMAME 318, "
    "724",
    advice="Give `Method(viscosity=...)`, which keeps its meaning at every step, where runs at "
    "several steps, grids or stone stiffnesses are compared. The default alpha = 0.01 is the "
    "study's; shrinking its step changes the result.",
    run=run,
)
