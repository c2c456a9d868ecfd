"""Two elastic disks run into each other and bounce (Sulsky, Chen & Schreyer 1994, CMAME 118).

Their gap of sqrt(2) 0.6 - 0.4 m closes at sqrt(2) 0.2 m/s in 1.5858 s. Bodies on one grid meet as
soon as they share a node: here the one in the middle, when the domain of the foremost point of
each comes within a cell of it along both axes. That is (h + l) / 0.1 s early, and a little less as
the foremost point of the lattice lies within the circle.

The disks bounce, but for the share of the energy that stays in them as vibrations. Energy is kept
but for what the ledger of the method lists: the rate form of Hooke's law, of second
order in the strain of about v / c, and the finite step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .problem import Outcome, Problem

RADIUS, SPEED = 0.2, 0.1  # m, m/s along each axis
CENTRES = np.array([(0.2, 0.2), (0.8, 0.8)])  # m
RUBBER = gs.Elastic(density=1000.0, young=1000.0, poisson=0.3)
DURATION, COURANT = 4.0, 0.1  # s
MEETING = (np.hypot(0.6, 0.6) / 2 - RADIUS) / (np.sqrt(2) * SPEED)  # of the circles, s
ENERGY = 2 * RUBBER.density * np.pi * RADIUS**2 * SPEED**2  # kinetic, at the start, J/m


class Bounce(NamedTuple):
    """A run, by rows: time (s), kinetic and elastic energy (J/m), momentum (N s/m), places (m)."""

    contact: float  # time of the first stress, s
    time_step: float
    ledger: gs.Ledger
    time: FloatArray
    kinetic: FloatArray
    elastic: FloatArray
    momentum: FloatArray
    places: FloatArray


def run(full: bool) -> Outcome:
    """The bounce on one grid or, in full, on three."""
    runs = {cell: bounce(cell) for cell in ((0.05, 0.025, 0.0125) if full else (0.025,))}
    checks = [check for cell, found in runs.items() for check in check_bounce(cell, found)]
    return Outcome(checks, draw(list(runs.values())[-1]))


def check_bounce(cell: float, found: Bounce) -> list[Check]:
    at = f", h = {cell:g} m"
    start, end = found.kinetic[0], found.kinetic[-1] + found.elastic[-1]
    n = len(found.places[0])
    radius = 2 * RADIUS / cell
    strain = np.sqrt(2) * SPEED / RUBBER.wave_speed
    passage = 4 * RADIUS / RUBBER.wave_speed
    return [
        Check.near(
            f"kinetic energy at the start, by the circles{at}, J/m",
            expected=ENERGY,
            got=float(start),
            within=ENERGY * 2 * np.sqrt(16 * radius / 3) / (np.pi * radius**2),
            why="points in a circle: twice the scatter of its lattice cells, in eight equal parts",
        ),
        Check.near(
            f"kinetic energy at the start, by the lattice{at}, J/m",
            expected=n * (cell / 2) ** 2 * RUBBER.density * SPEED**2,
            got=float(start),
            within=1e-12,
            why="exact: rounding",
        ),
        Check.near(
            f"first contact{at}, s",
            expected=MEETING - lead(cell, found.places[0]),
            got=found.contact,
            within=3 * found.time_step,
            why="free flight to the first shared node; the steps in which the stress shows",
        ),
        Check.at_most(
            f"momentum, share of that of one disk{at}",
            bound=1e-12,
            got=float(np.abs(found.momentum).max() / (start / SPEED / 2)),
            why="forces of the grid add up to nothing: rounding",
        ),
        Check.near(
            f"energy after the bounce{at}, share",
            expected=1.0,
            got=float(end / start),
            within=strain**2,
            why="rate form of the elastic law: second order in the strain v / c",
        ),
        Check.near(
            f"energy after the bounce, less that of the rate form{at}, share",
            expected=1.0,
            got=float((end + found.ledger.hypoelastic) / start),
            within=found.time_step / passage,
            why="first order in the step: a step's share of a wave's way to and fro",
        ),
        Check.near(
            f"energy and ledger after the bounce{at}, share",
            expected=1.0,
            got=float((end + found.ledger.taken) / start),
            within=1e-11,
            why="exact: rounding of some thousand steps",
        ),
    ]


def bounce(cell: float) -> Bounce:
    places = disks(cell / 2)
    n = len(places)
    volume = np.full(n, (cell / 2) ** 2)
    solver = gs.Solver(
        gs.Points(
            position=places,
            half_length=np.full((n, 2), cell / 4),
            volume=volume,
            mass=RUBBER.density * volume,
            material=np.zeros(n, dtype=np.int32),
        ),
        [RUBBER],
        cell=cell,
        velocity=np.where(places < 0.5, SPEED, -SPEED),
        method=gs.Method(alpha=0.0, courant=COURANT, ledger=True),
    )
    rows = [row(solver)]
    while solver.energies().elastic < 1e-20 * ENERGY and solver.time < DURATION:  # rounding: 1e-30
        solver.step()
    contact = solver.time
    for time in np.linspace(contact, DURATION, 80):
        solver.advance_to(time)
        rows.append(row(solver))
    return Bounce(contact, solver.time_step, solver.ledger, *map(np.array, zip(*rows, strict=True)))


def disks(side: float) -> FloatArray:
    """Points of a lattice in the two circles, m, (n, 2)."""
    along = (np.arange(round(1 / side)) + 0.5) * side
    lattice = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    return np.concatenate([lattice[np.hypot(*(lattice - c).T) < RADIUS] for c in CENTRES])


def row(solver: gs.Solver) -> tuple[float, float, float, FloatArray, FloatArray]:
    energies = solver.energies()
    momentum = solver.mass @ solver.velocity
    return solver.time, energies.kinetic, energies.elastic, momentum, solver.position


def lead(cell: float, places: FloatArray) -> float:
    """How much earlier than the circles the disks meet on the grid, s."""
    foremost = places[: len(places) // 2].min(axis=1).max()
    return float(MEETING - (0.5 - cell - cell / 4 - foremost) / SPEED)


def draw(found: Bounce) -> Figure:
    """Energies over time, and the disks at the start and when they are closest."""
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(5, 3))
    left.plot(found.time, found.kinetic, label="kinetic")
    left.plot(found.time, found.elastic, label="elastic")
    left.plot(found.time, found.kinetic + found.elastic, "k", linewidth=0.8, label="sum")
    left.axvline(MEETING, color="C7", linestyle="--", label="circles meet")
    left.axvline(found.contact, color="C7", linestyle=":", label="disks meet on the grid")
    left.set(xlabel="time (s)", ylabel="energy (J/m)", xlim=(0, DURATION), ylim=(0, 2.8))
    figure.legend(loc="outside lower center", ncols=5)
    for colour, number in (("C7", 0), ("C3", int(found.kinetic.argmin()))):
        label = f"{found.time[number]:.1f} s"
        right.plot(*found.places[number].T, ".", color=colour, markersize=1.6, label=label)
    right.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
    right.legend(loc="upper left", markerscale=5)
    return figure


PROBLEM = Problem("disks", "Bouncing disks", run)
