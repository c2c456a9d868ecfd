"""A block on an incline slides at g (sin(theta) - mu cos(theta)), or sticks if mu > tan(theta).

The wall stays level and gravity is tilted. The block is elastic, so two things are to be known.
Constant friction makes the vibrations of a sliding elastic body grow (Martins, Guimaraes & Faria
1995, J. Vib. Acoust. 117, 445-451): in FLIP they do, the block rattles and hops, and for mu near
tan(theta) slides too fast. The velocities are PIC here, which damps all vibrations and keeps
momentum. A block that sticks swings at first, too, and comes to rest by the same PIC.

With linear shape functions it then rests for good. With GIMP a sunken edge that reaches over a
grid line by d gives the node beyond a mass of d^2 and a force of d, which kick its points by
dt s d / (2 rho h l) in each step; the stress does not feel it. This creep bounds the rest.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape
from ..check import Check
from .problem import Outcome, Problem

ANGLE, GRAVITY = np.radians(30.0), 9.81  # rad, m/s2
LENGTH, HEIGHT = 2.0, 0.5  # m
ROCK = gs.Elastic(density=2500.0, young=10e9, poisson=0.25)
TIMES = np.linspace(0, 1, 21)  # s
RAMP, SETTLED = 0.1, 6  # s in which gravity grows; row of TIMES at which the block has settled
LIMIT = float(np.tan(ANGLE))


def run(full: bool) -> Outcome:
    """Four blocks that slide well, and two on either side of the limit."""
    cell = 0.125 if full else 0.25
    below, above = 0.95 * LIMIT, 1.05 * LIMIT
    slides = {mu: slide(mu, cell)[0] for mu in (0.0, 0.1, 0.2, 0.3, below)}
    checks = [
        Check.near(
            f"acceleration, mu = {mu:.3g}, m/s2",
            expected=acceleration(mu),
            got=mean_acceleration(velocity),
            within=5e-3 * acceleration(mu),
            why="rigid block; the elastic swing of the wall's force shall leave less than 0.5 %",
        )
        for mu, velocity in slides.items()
    ]
    rest: dict[Shape, tuple[float, str]] = {
        "linear": (1e-12, "static friction: rounding, once the swing has died out"),
        "ugimp": (creep(cell), "static friction, but for the creep of a domain over a grid line"),
    }
    for shape, (bound, why) in rest.items():
        _, moved = slide(above, cell, shape)
        checks.append(
            Check.at_most(
                f"farthest point moved in 0.7 s, mu = {above:.3g}, {shape}, m",
                bound=bound,
                got=moved,
                why=why,
            )
        )
    if full:
        rattling = mean_acceleration(slide(below, cell, alpha=0.0)[0])
        checks.append(
            Check.at_least(
                f"FLIP, mu = {below:.3g}: error of the acceleration, share",
                bound=0.005,
                got=rattling / acceleration(below) - 1,
                why="fails: vibrations of a sliding elastic body grow, more than PIC's 0.5 %",
            )
        )
    return Outcome(checks, draw(slides, cell))


def slide(
    mu: float, cell: float, shape: Shape = "ugimp", alpha: float = 1.0
) -> tuple[FloatArray, float]:
    """Velocity of the block at TIMES (m/s), and how far a point moved at most once settled (m)."""
    corners = np.array([(0, 0), (LENGTH, 0), (LENGTH, HEIGHT), (0, HEIGHT)])
    walls = gs.Walls(left=gs.Free(), bottom=gs.Coulomb(mu))
    scene = gs.Scene(gs.Outline(corners), ROCK, cell=cell, walls=walls)
    solver = gs.Solver(
        scene.points,
        scene.materials,
        cell=cell,
        walls=walls,
        wall_positions=scene.wall_positions,
        method=gs.Method(shape=shape, alpha=alpha),
    )
    solver.set_gravity(GRAVITY * np.sin(ANGLE), -GRAVITY * np.cos(ANGLE), ramp=RAMP)
    velocity = np.empty_like(TIMES)
    for row, time in enumerate(TIMES):
        solver.advance_to(time)
        velocity[row] = solver.velocity[:, 0].mean()
        if row == SETTLED:
            settled = solver.position
    return velocity, float(np.abs(solver.position - settled).max())


def acceleration(mu: float) -> float:
    """Of a rigid block that slides or sticks, m/s2."""
    return float(max(0.0, GRAVITY * (np.sin(ANGLE) - mu * np.cos(ANGLE))))


def mean_acceleration(velocity: FloatArray) -> float:
    """Of a settled block, m/s2."""
    return float((velocity[-1] - velocity[SETTLED]) / (TIMES[-1] - TIMES[SETTLED]))


def creep(cell: float) -> float:
    """Bound of the creep since SETTLED, m: stress and sinking those of the block's weight."""
    time_step = 0.4 * cell / ROCK.wave_speed
    stress = ROCK.density * GRAVITY * HEIGHT
    sunken = stress * HEIGHT / ROCK.young
    speed = time_step * stress * sunken / (2 * ROCK.density * cell * (cell / 4))
    return float(speed * (TIMES[-1] - TIMES[SETTLED]))


def draw(slides: dict[float, FloatArray], cell: float) -> Figure:
    """Velocities, and accelerations over friction."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    ramped = np.where(TIMES < RAMP, TIMES**2 / (2 * RAMP), TIMES - RAMP / 2)
    for colour, (mu, velocity) in enumerate(slides.items()):
        left.plot(TIMES, acceleration(mu) * ramped, "k-", linewidth=0.8)
        left.plot(TIMES, velocity, f"C{colour}o", markersize=3.5, label=f"$\\mu$ = {mu:.3g}")
    left.set(xlabel="time (s)", ylabel="velocity (m/s)")
    left.legend()
    friction = np.linspace(0, 0.9, 181)
    right.plot(friction, [acceleration(mu) for mu in friction], "k-", linewidth=0.8, label="rigid")
    found = np.linspace(0, 0.9, 10)
    got = [mean_acceleration(slide(mu, cell)[0]) for mu in found]
    right.plot(found, got, "C0o", markersize=4, label="computed")
    right.axvline(LIMIT, color="k", linestyle=":", linewidth=0.8, label="$\\tan\\theta$")
    right.set(xlabel="friction coefficient $\\mu$", ylabel="acceleration (m/s$^2$)")
    right.legend()
    return figure


PROBLEM = Problem("sliding_block", "Sliding block", run)
