"""Two bars meet at v0 each, which sends a wave of compression into both, as from a rigid wall.

Exact for small v0: the stress steps to -rho c v0 at a front that runs at c = sqrt(E / rho). A grid
spreads the step, in a way that is known. A share alpha of PIC turns a velocity of angle theta a
cell into q = 1 - alpha (1 - W) of itself each step, with W = (5 + 3 cos theta) / 8 for two points
a cell (mass matrix over lumped masses); after n steps of C = c dt / h the stress of the mode is

    C q^((n - 1) / 2) sin(n phi) / sin(phi),
    2 sqrt(q) cos(phi) = 1 + q - 4 C^2 W sin(theta / 2)^2.

For long waves FLIP is an Airy front, whose stress is a third of the plateau at c t and overshoots
by 27.4 % (the integral of Ai up to its first zero, less 1) on any grid. PIC is a diffusion of
nu = 3 h^2 / 16 dt: an error function of standard deviation sqrt(nu t), and no overshoot.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .problem import Outcome, Problem

YOUNG, DENSITY = 1e6, 1000.0  # Pa, kg/m3
WAVE_SPEED = (YOUNG / DENSITY) ** 0.5  # m/s
SPEED = 1e-8 * WAVE_SPEED  # v0, m/s
TRAVEL = 1.0  # of the front, m
COURANT = 0.4
SHARES = {"FLIP": 0.0, "alpha = 0.01": 0.01, "alpha = 0.1": 0.1, "PIC": 1.0}
AIRY_STRESS, AIRY_OVERSHOOT = 1 / 3, 0.27435


def run(full: bool) -> Outcome:
    """The front after 100 cells, in full after 400 as well, from FLIP to PIC."""
    checks: list[Check] = []
    for cells in [100, 400] if full else [100]:
        waves = {name: collide(cells, alpha) for name, alpha in SHARES.items()}
        for name, (place, stress) in waves.items():
            apart = np.abs(stress - discrete(place, cells, SHARES[name])).max()
            title = f"{name}, {cells} cells: distance from the discrete solution"
            moved = cells * SPEED / WAVE_SPEED  # cells
            why = "exact for v0 / c = 0; the front changes within a cell or so: 10 times the motion"
            checks.append(Check.at_most(title, bound=10 * moved, got=float(apart), why=why))
        checks += check_flip(cells, *waves["FLIP"]) + check_pic(cells, *waves["PIC"])
    return Outcome(checks, draw())


def check_flip(cells: int, place: FloatArray, stress: FloatArray) -> list[Check]:
    """An Airy front."""
    overshoot, at_front = float(stress.max() - 1), float(np.interp(TRAVEL, place, stress))
    return [
        Check.near(
            f"FLIP, {cells} cells: {quantity}, rho c v0",
            expected=expected,
            got=got,
            within=expected * cells ** (-2 / 3),
            why="of an Airy front, whose next term is (h / ct)^(2/3) of it",
        )
        for quantity, expected, got in [
            ("overshoot", AIRY_OVERSHOOT, overshoot),
            ("stress at c t", AIRY_STRESS, at_front),
        ]
    ]


def check_pic(cells: int, place: FloatArray, stress: FloatArray) -> list[Check]:
    """A plateau, and a front that has diffused."""
    spread = (3 / 16 * TRAVEL**2 / COURANT / cells) ** 0.5
    slope = float(np.interp(TRAVEL, place, -np.gradient(stress, place)))
    front = float(np.interp(-0.5, -stress, place))
    plateau = float(stress[place < TRAVEL / 2].mean())
    return [
        Check.near(
            f"PIC, {cells} cells: plateau, rho c v0",
            expected=1.0,
            got=plateau,
            within=1e-3,
            why="the front is five and more standard deviations away",
        ),
        Check.near(
            f"PIC, {cells} cells: front, m",
            expected=TRAVEL,
            got=front,
            within=TRAVEL / cells,
            why="a cell",
        ),
        Check.near(
            f"PIC, {cells} cells: standard deviation of the front, m",
            expected=spread,
            got=1 / (slope * (2 * np.pi) ** 0.5),
            within=0.05 * spread,
            why="long waves: spread over cell squared is 1/50",
        ),
        Check.at_most(
            f"PIC, {cells} cells: overshoot, rho c v0",
            bound=1e-3,
            got=float(stress.max() - 1),
            why="diffusion outruns dispersion: none",
        ),
    ]


def collide(cells: int, alpha: float) -> tuple[FloatArray, FloatArray]:
    """Middles of the cells of the right bar (m), and their compression in rho c v0, when the front
    has travelled."""
    cell, half = TRAVEL / cells, 1.5 * TRAVEL
    bars = gs.Scene(
        gs.Outline(np.array([(-half, 0), (half, 0), (half, cell), (-half, cell)])),
        gs.Elastic(density=DENSITY, young=YOUNG, poisson=0.0),
        cell=cell,
        walls=gs.Walls(left=gs.Free(), bottom=gs.Roller(), top=gs.Roller()),
    )
    x, y = bars.points.position.T
    solver = gs.Solver(
        bars.points,
        bars.materials,
        cell=cell,
        walls=bars.walls,
        wall_positions=bars.wall_positions,
        origin=bars.origin,
        velocity=np.column_stack([-SPEED * np.sign(x), 0 * x]),
        method=gs.Method(alpha=alpha, time_step=COURANT * cell / WAVE_SPEED),
    )
    solver.advance(steps(cells))
    right = (x > 0) & (y < cell / 2)
    compression = -solver.stress[right, 0] / (DENSITY * WAVE_SPEED * SPEED)
    return x[right].reshape(-1, 2).mean(axis=1), compression.reshape(-1, 2).mean(axis=1)


def steps(cells: int) -> int:
    """Steps until the front has travelled."""
    return round(cells / COURANT)


def discrete(place: FloatArray, cells: int, alpha: float) -> FloatArray:
    """The same stress by the modes of the scheme, at the angles that make the sum exact."""
    n, angles = steps(cells), 4 * steps(cells)
    theta = (np.arange(angles) + 0.5) * np.pi / angles
    smoothing = (5 + 3 * np.cos(theta)) / 8
    kept = 1 - alpha * (1 - smoothing)
    cosine = (1 + kept - 4 * COURANT**2 * smoothing * np.sin(theta / 2) ** 2) / (2 * kept**0.5)
    phi = np.arccos(cosine + 0j)
    mode = COURANT * (kept ** ((n - 1) / 2) * np.sin(n * phi) / np.sin(phi)).real
    shape = np.cos(np.outer(place * cells / TRAVEL, theta))
    stress: FloatArray = shape @ (np.cos(theta / 2) * mode) * 2 / angles
    return stress


def draw() -> Figure:
    """The stress behind the front, computed and by the modes."""
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    ax = figure.add_subplot()
    ax.plot([0, TRAVEL, TRAVEL, 1.5 * TRAVEL], [1, 1, 0, 0], "k:", linewidth=1, label="exact")
    for colour, (name, alpha) in enumerate(SHARES.items()):
        place, stress = collide(100, alpha)
        label = f"{name}: {100 * (stress.max() - 1):.1f} % over"
        ax.plot(place, discrete(place, 100, alpha), f"C{colour}-", linewidth=0.8)
        ax.plot(place, stress, f"C{colour}.", markersize=4, label=label)
    ax.plot([], [], "-", color="gray", linewidth=0.8, label="discrete solution")
    ax.set(
        xlabel="place (m)", ylabel=r"compression / $\rho c v_0$", xlim=(0.5, 1.3), ylim=(-0.1, 1.4)
    )
    ax.legend(loc="upper right")
    return figure


PROBLEM = Problem("wave", "Stress wave", run)
