"""A block under uniform stress is carried across the cells: nothing may push it.

The block is pressed together a little, so that its points do not fit the cells. The internal force
at a node inside it, -sum V_p sigma grad S(x_p), should be zero. GIMP sums the gradient of the hat
function over contiguous domains, which makes an integral over the block: zero to rounding. Linear
MPM counts points: each one that crosses a node carries its V_p sigma / h from one side of it to
the other, a jump of 2 sigma s for points s apart - sigma A where two fit the side A of a cell.
Domains that have kept their first half-length l overlap (uGIMP): each end of the row that comes to
a node too early or too late pushes it, by up to sigma s (1 - s / 2l).
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape
from ..check import Check
from .problem import Outcome, Problem

CELL = 0.1  # m
LENGTH, HEIGHT, TRAVEL = 16, 6, 10  # of the block, and its way, cells
COLUMNS, ROWS = 36, 12  # of points; 32 columns would fit the cells
SPACING = np.array([LENGTH * CELL / COLUMNS, HEIGHT * CELL / ROWS])  # m
NODE = (13, 3)  # column and row of a node that stays inside
MATERIAL = gs.Elastic(density=1000.0, young=1e6, poisson=0.0)
STRESS = -1e4  # Pa, on all sides
KINDS: dict[str, tuple[Shape, FloatArray]] = {  # shape functions and half-lengths, m
    "linear": ("linear", SPACING / 2),
    "GIMP, overlapping": ("ugimp", np.full(2, CELL / 4)),
    "GIMP, contiguous": ("ugimp", SPACING / 2),
}


def run(full: bool) -> Outcome:
    """The force at a node inside the block, and one step of the solver, at each offset."""
    offsets = np.linspace(0, TRAVEL * CELL, 2003 if full else 403)
    forces = {name: force(offsets, *kind) / (STRESS * CELL) for name, kind in KINDS.items()}
    kicks = {name: kick(offsets[::5], *kind) for name, kind in KINDS.items()}
    jump, overlap = float(2 * SPACING[0] / CELL), float(1 - SPACING[0] / (CELL / 2))
    checks = [
        Check.at_most(
            "GIMP, contiguous: force at the node, sigma A",
            bound=1e-12,
            got=float(np.abs(forces["GIMP, contiguous"]).max()),
            why="zero but for the rounding of some hundred terms",
        ),
        Check.at_most(
            "GIMP, contiguous: acceleration of inner points in a step, sigma / rho h",
            bound=1e-12,
            got=kicks["GIMP, contiguous"],
            why="no force, no acceleration",
        ),
        Check.near(
            "linear: largest jump of the force at the node, sigma A",
            expected=jump,
            got=float(np.abs(np.diff(forces["linear"])).max()),
            within=1e-12,
            why="one column of points crosses the node: 2 sigma s, to rounding",
        ),
        Check.at_least(
            "linear: acceleration of inner points in a step, sigma / rho h",
            bound=0.8 * jump / 2,
            got=kicks["linear"],
            why="sigma s at a node, felt by a point within a fifth of a cell of it",
        ),
        Check.near(
            "GIMP, overlapping: largest force at the node, sigma A",
            expected=overlap * jump / 2,
            got=float(np.abs(forces["GIMP, overlapping"]).max()),
            within=1e-12,
            why="sigma s times the share of a domain that overlaps, to rounding",
        ),
    ]
    return Outcome(checks, draw(offsets / CELL, forces))


def block() -> FloatArray:
    """Points of the block at offset zero, m."""
    columns, rows = np.meshgrid(np.arange(COLUMNS) + 0.5, np.arange(ROWS) + 0.5)
    points: FloatArray = np.column_stack([columns.ravel(), rows.ravel()]) * SPACING
    return points


def force(offsets: FloatArray, shape: Shape, half_length: FloatArray) -> FloatArray:
    """Horizontal internal force at the node, N/m, shape (n,)."""
    points = block() + np.column_stack([offsets, 0 * offsets])[:, None]
    flat = points.reshape(-1, 2)
    reached = gs.kernel.shape_functions(
        shape, flat, np.tile(half_length, (len(flat), 1)), cell=CELL
    )
    here = (reached.nodes == NODE).all(axis=-1)
    gradient: FloatArray = (reached.gradients[..., 0] * here).sum(axis=-1)
    total: FloatArray = gradient.reshape(len(offsets), -1).sum(axis=1)
    return -STRESS * float(SPACING.prod()) * total


def kick(offsets: FloatArray, shape: Shape, half_length: FloatArray) -> float:
    """Largest acceleration of the inner points in one step at c / 100, in sigma / rho h."""
    place, speed = block(), np.array([MATERIAL.wave_speed / 100, 0.0])
    volume = np.full(len(place), SPACING.prod())
    solver = gs.Solver(
        gs.Points(
            position=place,
            half_length=np.tile(half_length, (len(place), 1)),
            volume=volume,
            mass=volume * MATERIAL.density,
            material=np.zeros(len(place), dtype=np.int32),
        ),
        [MATERIAL],
        cell=CELL,
        method=gs.Method(shape=shape, alpha=0.0, time_step=0.4 * CELL / MATERIAL.wave_speed),
    )
    low, high = 2.5 * CELL, np.array([LENGTH, HEIGHT]) * CELL - 2.5 * CELL
    inner = ((place > low) & (place < high)).all(axis=1)
    largest = 0.0
    for offset in offsets:
        solver.position = place + np.array([offset, 0.0])
        solver.velocity = np.tile(speed, (len(place), 1))
        solver.stress = np.tile([STRESS, STRESS, STRESS, 0.0], (len(place), 1))
        step = solver.time_step
        solver.step()
        change = (solver.velocity - speed)[inner] / step
        largest = max(largest, float(np.abs(change).max()))
    return largest * MATERIAL.density * CELL / abs(STRESS)


def draw(offsets: FloatArray, forces: dict[str, FloatArray]) -> Figure:
    """The force at the node as the block passes."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for name, values in forces.items():
        ax.plot(offsets, values, linewidth=1.0, label=name)
    ax.set(xlabel="way of the block (cells)", ylabel=r"force at a node / $\sigma A$")
    ax.set(xlim=(0, 4), ylim=(-0.6, 0.8))
    ax.legend(loc="upper right", ncols=3)
    return figure


PROBLEM = Problem("translation", "Uniform stress carried across cells", run)
