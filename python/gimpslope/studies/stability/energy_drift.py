"""What 10^5 steps leave of the energy of a bar that swings.

A free bar swings in its first mode under FLIP, so softly that it stays linear. Each step multiplies
the mode by an eigenvalue (`amplification`): USF and MUSL turn it, as a symplectic step does, and
its size stays 1; USL damps it. Energies are means over a period, for within one they swing by
omega dt, velocity and stress being half a step apart.
"""

from __future__ import annotations

from typing import NamedTuple, get_args

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Scheme
from ..check import Check
from . import rows
from .amplification import matrix
from .mode import Findings, Mode, Table

CELLS, PER_SIDE, PLACE = 20, 2, 0.3  # of the bar; points a cell; where it begins, cells
COURANT = 0.4
SPEED = 1e-4  # of the wave
STEPS = {False: 20_000, True: 100_000}
PERIOD = round(2 * CELLS / COURANT)  # of the first mode, steps
LOOKS = 20
SCHEMES: tuple[Scheme, ...] = get_args(Scheme)
CONSERVED = 1e-3  # drift of what keeps its energy


class Drift(NamedTuple):
    """Steps, and mean energy over a period from there on, of the first."""

    steps: FloatArray
    energy: FloatArray


def run(full: bool) -> Findings:
    """All schemes."""
    steps = STEPS[full]
    drifts = {scheme: swing(scheme, steps) for scheme in SCHEMES}
    theory = {scheme: factor(scheme) ** (2 * (steps - PERIOD)) for scheme in SCHEMES}
    fails = [
        Check.near(
            f"USL: energy after {steps:,} steps, of the first",
            expected=theory["usl"],
            got=float(drifts["usl"].energy[-1]),
            within=0.05 * (1 - theory["usl"]) + CONSERVED,
            why="its eigenvalue; 5 % of the loss for the other modes of the bar",
        ),
        Check.at_most(
            "the same: it loses ten times what the others may, and more",
            bound=1 - 10 * CONSERVED,
            got=float(drifts["usl"].energy[-1]),
            why="it strains by velocities that are not averaged anew",
        ),
    ]
    stands = [
        Check.near(
            f"{scheme.upper()}: energy after {steps:,} steps, of the first",
            expected=1.0,
            got=float(drift.energy[-1]),
            within=CONSERVED,
            why="symplectic: eigenvalues of size 1; amplitude squared and overtones of the bar",
        )
        for scheme, drift in drifts.items()
        if scheme != "usl"
    ]
    listed: list[tuple[str | float, ...]] = [
        (s.upper(), theory[s], float(drifts[s].energy[-1])) for s in SCHEMES
    ]
    columns = ("scheme", f"energy after {steps:,} steps, theory", "kernel")
    return Findings(fails, stands, draw(drifts, steps), Table(columns, listed))


def factor(scheme: str) -> float:
    """Size of the eigenvalue of the first mode."""
    x = PLACE + (np.arange(CELLS * PER_SIDE) + 0.5) / PER_SIDE
    values, slopes = rows.along("ugimp", x, np.full_like(x, 0.5 / PER_SIDE))
    by, modes = np.linalg.eig(matrix(values, slopes, scheme, COURANT))
    likeness = np.abs(np.linalg.solve(modes, np.concatenate([mode_at(x), np.zeros_like(x)])))
    weight = likeness * np.linalg.norm(modes, axis=0)
    return float(np.abs(by[np.argmax(weight)]))


def mode_at(x: FloatArray) -> FloatArray:
    """The first mode of the bar."""
    return np.asarray(np.cos(np.pi * (x - PLACE) / CELLS))


def swing(scheme: Scheme, steps: int) -> Drift:
    """The bar over so many steps."""
    points = rows.points((CELLS, 1), PER_SIDE, (PLACE, 0.0))
    velocity = np.zeros_like(points.position)
    velocity[:, 0] = SPEED * mode_at(points.position[:, 0])
    method = gs.Method(scheme=scheme, alpha=0.0, time_step=COURANT)
    solver = rows.solver(points, rows.material(), method, row=True, velocity=velocity)
    looks = np.linspace(0, steps - PERIOD, LOOKS).astype(int)
    energy = []
    for look in looks:
        solver.advance(int(look) - solver.steps)
        energy.append(_mean_energy(solver))
    return Drift(looks.astype(float), np.array(energy) / energy[0])


def _mean_energy(solver: gs.Solver) -> float:
    total = 0.0
    for _ in range(PERIOD):
        solver.step()
        of = solver.energies()
        total += of.kinetic + of.elastic
    return total / PERIOD


def draw(drifts: dict[Scheme, Drift], steps: int) -> Figure:
    """Energy over steps."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for scheme, drift in drifts.items():
        ax.plot(drift.steps, drift.energy, "o", ms=4, label=f"{scheme.upper()}, kernel")
    way = np.linspace(0, steps, 100)
    for scheme in SCHEMES:
        ax.plot(way, factor(scheme) ** (2 * way), "k-", linewidth=0.8)
    ax.plot([], [], "k-", linewidth=0.8, label="eigenvalues of USF, USL, MUSL")
    ax.set(xlabel="steps", ylabel="energy / first", ylim=(0, 1.1))
    ax.legend(loc="lower left")
    return figure


MODE = Mode(
    name="energy_drift",
    title="Energy over many steps",
    mechanism="USF and MUSL take strain and motion in turn, which is a symplectic step: energy "
    "swings by omega dt within a period but stays over any number of them. USL strains by "
    "velocities that the nodes have come to, without the average that the points would make of "
    "them, and so damps every motion a little in each step. The smaller the step, the smaller "
    "its loss.",
    source="Bardenhagen 2002, J. Comput. Phys. 180, 383; Wallstedt & Guilkey 2008, J. Comput. "
    "Phys. 227, 9628",
    advice='Keep `Method(scheme="usf")`, the default. A `Ledger` says where the energy of a run '
    "went.",
    run=run,
)
