"""A bar that is fixed at one end swings in its first mode.

The exact solution for small motions is v(x, t) = v0 sin(pi x / 2L) cos(omega t) with
omega = pi c / 2L and c = sqrt(E / rho): a period of 10 s here, in which FLIP keeps the energy.
A share alpha of PIC in each step acts as the viscosity
nu = alpha h^2 (1/6 + l^2 / (3 h^2)) / dt, l being the half-length of a point, under which the
energy of a mode of wave number k falls as exp(-nu k^2 t). Start values are given at their own
times, as in the manufactured solution in a square.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from ..stopwatch import Stopwatch
from .problem import Outcome, Problem

LENGTH, YOUNG, DENSITY, SPEED = 25.0, 100.0, 1.0, 0.1  # m, Pa, kg/m3, m/s
CELLS = 50
PERIOD = 4 * LENGTH / (YOUNG / DENSITY) ** 0.5  # s
PERIODS = 10
WAVE_NUMBER, FREQUENCY = np.pi / (2 * LENGTH), 2 * np.pi / PERIOD  # of the mode, 1/m, 1/s
TIMES = np.arange(0, PERIODS * PERIOD + 0.05, 0.1)  # s


def run(full: bool) -> Outcome:
    """Ten periods with FLIP and with a little PIC, at a fine and a coarse time step."""
    fine, damped, coarse, less_damped = (
        swing(CELLS, gs.Method(courant=courant, alpha=alpha, ledger=True))
        for courant in (0.1, 0.5)
        for alpha in (0.0, 0.01)
    )
    law, coarse_law = (float(decay(courant, 0.01)[-1]) for courant in (0.1, 0.5))
    checks = [
        Check.near(
            "energy after 10 periods, FLIP, C = 0.1",
            expected=1.0,
            got=fine.energy[-1],
            within=1e-4,
            why="a symplectic step keeps the energy: published 1.0000 +- 1e-4",
        ),
        Check.near(
            "energy after 10 periods, FLIP, C = 0.5",
            expected=1.0,
            got=coarse.energy[-1],
            within=3e-4,
            why="swings by omega dt sin(2 phase) / 2, 0.012 rad out of phase: published 1.0003",
        ),
        Check.near(
            "energy after 10 periods, alpha = 0.01, C = 0.1",
            expected=law,
            got=damped.energy[-1],
            within=0.05 * (1 - law),
            why="law of an endless bar: 5 % of the loss for its ends; published 0.964",
        ),
        Check.near(
            "the same, C = 0.5: alpha damps less in larger steps",
            expected=coarse_law,
            got=less_damped.energy[-1],
            within=3e-4 + 0.05 * (1 - coarse_law),
            why="as both above; published 0.993",
        ),
        Check.near(
            "transfer loss in the ledger, alpha = 0.01, C = 0.1",
            expected=1 - law,
            got=damped.transfer,
            within=0.05 * (1 - law),
            why="all that viscosity takes is lost between points and grid: 5 % for the ends",
        ),
        Check.near(
            "period, s",
            expected=PERIOD,
            got=period_of(fine),
            within=5e-4 * PERIOD,
            why="dispersion (k h)^2 / 24 = 4e-5, finite strain 0.01^2 times a small number",
        ),
    ]
    return Outcome(checks, draw(fine, damped, less_damped))


class Swing(NamedTuple):
    """Displacement (m) and velocity (m/s) of the centre of mass, energy and transfer loss (NaN
    without a ledger) as parts of the first energy, and cost."""

    shift: FloatArray
    centre: FloatArray
    energy: FloatArray
    transfer: float
    core_seconds: float

    @property
    def error(self) -> float:
        """Of the displacement: root of the mean square, as a part of that of the exact one."""
        exact = SPEED / FREQUENCY * 2 / np.pi * np.sin(FREQUENCY * TIMES)
        return float(np.sqrt(np.square(self.shift - exact).mean() / np.square(exact).mean()))


def swing(cells: int, method: gs.Method) -> Swing:
    """The bar at all `TIMES`; a method whose step is a Courant number gets that of the start."""
    cell = LENGTH / cells
    dt = step(method.step[1], cells)
    before = dt if method.scheme == "usf" else 0.0  # where the stresses at the start belong
    bar = gs.Scene(
        gs.Outline(np.array([(0, 0), (LENGTH, 0), (LENGTH, cell), (0, cell)])),
        gs.Elastic(density=DENSITY, young=YOUNG, poisson=0.0),
        cell=cell,
        walls=gs.Walls(left=gs.Fixed(), bottom=gs.Roller(), top=gs.Roller()),
    )
    along = bar.points.position[:, 0]
    solver = gs.Solver(
        bar.points,
        bar.materials,
        cell=cell,
        walls=bar.walls,
        wall_positions=bar.wall_positions,
        velocity=np.outer(SPEED * np.sin(WAVE_NUMBER * along) * np.cos(FREQUENCY * dt / 2), (1, 0)),
        stress=np.outer(-stretch(along, before) * YOUNG, (1, 0, 0, 0)),
        method=replace(method, courant=None, time_step=dt),
    )
    start, watch = DENSITY * SPEED**2 * bar.points.volume.sum() / 4, Stopwatch()
    shift, centre, energy = (np.full_like(TIMES, np.nan) for _ in range(3))
    for row, time in enumerate(TIMES):
        with watch:
            solver.advance_to(time)
        shift[row] = solver.position[:, 0].mean() - along.mean()
        centre[row] = solver.velocity[:, 0].mean()
        energy[row] = (solver.energies().kinetic + solver.energies().elastic) / start
    lost = solver.ledger.transfer / start if method.ledger else np.nan
    return Swing(shift, centre, energy, lost, watch.core_seconds)


def stretch(along: FloatArray, time: float) -> FloatArray:
    """Exact strain at first places (m) and a time (s)."""
    largest = SPEED / FREQUENCY * WAVE_NUMBER * np.sin(FREQUENCY * time)
    strain: FloatArray = largest * np.cos(WAVE_NUMBER * along)
    return strain


def step(courant: float, cells: int = CELLS) -> float:
    """Time step for a Courant number, s."""
    return courant * LENGTH / cells / float(np.sqrt(YOUNG / DENSITY))


def decay(courant: float, alpha: float) -> FloatArray:
    """Share of the energy that the viscosity of the velocity blend leaves at all `TIMES`."""
    cell = LENGTH / CELLS
    half_length = cell / 4
    viscosity = alpha * (cell**2 / 6 + half_length**2 / 3) / step(courant)
    left: FloatArray = np.exp(-viscosity * WAVE_NUMBER**2 * TIMES)
    return left


def period_of(bar: Swing) -> float:
    """Mean time between falls of the velocity through zero, s."""
    centre = bar.centre
    falls = np.flatnonzero((centre[:-1] > 0) & (centre[1:] <= 0))
    share = centre[falls] / (centre[falls] - centre[falls + 1])
    crossings = TIMES[falls] + share * np.diff(TIMES)[falls]
    return float(np.diff(crossings).mean())


def draw(flip: Swing, damped: Swing, less_damped: Swing) -> Figure:
    """Velocity over two periods, energy over all."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    exact = SPEED * 2 / np.pi * np.cos(2 * np.pi * TIMES / PERIOD)
    left.plot(TIMES, exact, "k-", linewidth=0.8, label="exact")
    left.plot(TIMES[::5], flip.centre[::5], "C0o", markersize=3.5, label="FLIP")
    left.set(xlabel="time (s)", ylabel="velocity of the centre (m/s)")
    left.set(xlim=(0, 2 * PERIOD), ylim=(-0.07, 0.1))
    left.legend(loc="upper center", ncols=2)
    every = slice(None, None, 50)
    for bar, label, colour in (
        (flip, "FLIP", "C0"),
        (less_damped, "alpha = 0.01, C = 0.5", "C2"),
        (damped, "alpha = 0.01, C = 0.1", "C1"),
    ):
        right.plot(TIMES[every], bar.energy[every], "o", color=colour, markersize=3.5, label=label)
    for courant in (0.1, 0.5):
        right.plot(TIMES, decay(courant, 0.01), "k-", linewidth=0.8)
    right.plot([], [], "k-", linewidth=0.8, label="viscosity law")
    right.set(xlabel="time (s)", ylabel="energy, parts of the first")
    right.legend(loc="lower left")
    return figure


PROBLEM = Problem("bar", "Vibrating bar", run)
