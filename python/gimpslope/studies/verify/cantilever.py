"""A cantilever is let go under its own weight, bends by 90 degrees, and swings back.

Known are finite elements and CPDI (Sadeghirad, Brannon & Burghardt 2011, IJNME 86, 1435-1456) and
the uGIMP of a later code, all with a neo-Hookean law, not the Jaumann rate. Their tip is the lower
corner of the free end. It swings to x < 0 below the clamp, where a wall of the grid, which is as
high as the grid, would hold it: the beam is clamped to a stiff block instead, and the wall is
behind that.

At the root the upper side stretches to twice its length. The domains of GIMP, squares that never
turn, leave gaps there: with 3 x 3 points a cell the beam bends as it should but does not swing all
the way back: to -0.22 m in the published uGIMP, to -0.41 m here, which misses the 5 %. With 6 x 6
it does: the gaps are the smaller the more points share a cell.
"""

from __future__ import annotations

from dataclasses import replace
from importlib import resources
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from ..stopwatch import Stopwatch
from .problem import Outcome, Problem

LENGTH, HEIGHT, GRAVITY = 4.0, 1.0, 10.0  # m, m, m/s2
BEAM = gs.Elastic(density=1050.0, young=1e6, poisson=0.3)
CLAMP = gs.Elastic(density=1050.0, young=1e8, poisson=0.3)
DURATION = 3.0  # s
DEPTH, SHARE = 3.28, 0.05  # of the finite elements, m; tolerance
FLIP = gs.Method(alpha=0.0)
LAW = "other law of large strains, coarse root"


class Swing(NamedTuple):
    """Times (s) and displacement (m) of the lower corner of the free end, and cost."""

    time: FloatArray
    fall: FloatArray
    core_seconds: float = np.nan

    @property
    def lowest(self) -> float:
        """m."""
        return float(self.fall[self.time < 1.5].min())

    @property
    def highest(self) -> float:
        """On the way back, m."""
        return float(self.fall[self.time > 2].max())

    def off(self, other: Swing) -> float:
        """Root of the mean square distance from another at its times, m."""
        miss = np.interp(other.time, self.time, self.fall) - other.fall
        return float(np.sqrt(np.square(miss).mean()))

    @property
    def turning(self) -> float:
        """Time of the highest place, s."""
        return float(self.time[np.where(self.time > 2, self.fall, -np.inf).argmax()])


def run(full: bool) -> Outcome:
    """Few and many points a cell, and linear shape functions."""
    others = {name: published(name) for name in ("fem", "ugimp", "cpdi")}
    few, linear = swing(3, 0.25, FLIP), swing(3, 0.25, replace(FLIP, shape="linear"))
    many = {cell: swing(6, cell, FLIP) for cell in ((0.25, 0.125) if full else (0.25,))}
    checks = [
        Check.near(
            f"lowest place of the tip, 3 x 3 points, against {name}, m",
            expected=other.lowest,
            got=few.lowest,
            within=SHARE * DEPTH,
            why=f"published; {LAW}",
        )
        for name, other in others.items()
    ]
    checks.append(
        Check.near(
            "time of the lowest place, 3 x 3 points, s",
            expected=1.045,
            got=few.time[few.fall.argmin()],
            within=SHARE * 1.045,
            why=f"finite elements, 1.03 to 1.06 s; {LAW}",
        )
    )
    for cell, found in many.items():
        checks += [
            Check.near(
                f"highest place on the way back, 6 x 6 points, h = {cell:g} m, m",
                expected=others["fem"].highest,
                got=found.highest,
                within=SHARE * DEPTH,
                why=f"finite elements, 5 % of the depth; {LAW}",
            ),
            Check.near(
                f"time of the highest place, 6 x 6 points, h = {cell:g} m, s",
                expected=others["fem"].turning,
                got=found.turning,
                within=SHARE * others["fem"].turning,
                why=f"finite elements; {LAW}",
            ),
        ]
    checks += [
        Check.at_most(
            "highest place on the way back, 3 x 3 points, m",
            bound=others["cpdi"].highest,
            got=few.highest,
            why="falls short as all published particle methods, gaps at the stretched root",
        ),
        Check.at_least(
            "the same, against linear shape functions, m",
            bound=linear.highest,
            got=few.highest,
            why="GIMP feels the crossing of cells less",
        ),
        Check.at_most(
            "highest place on the way back, 3 x 3 points, linear, m",
            bound=others["ugimp"].highest,
            got=linear.highest,
            why="cells crossed as well: falls shorter than published uGIMP",
        ),
    ]
    return Outcome(checks, draw(others, few, many[0.25], linear))


def swing(points: int, cell: float, method: gs.Method) -> Swing:
    """The beam with points x points in a cell."""
    beam = np.array([(-HEIGHT, 0), (LENGTH, 0), (LENGTH, HEIGHT), (-HEIGHT, HEIGHT)])
    clamp = gs.Outline(beam.clip(None, (0, HEIGHT)))
    walls = gs.Walls(left=gs.Fixed(), bottom=gs.Free())
    scene = gs.Scene(
        gs.Outline(beam),
        BEAM,
        stones=[clamp],
        stone=CLAMP,
        cell=cell,
        points_per_cell=points**2,
        walls=walls,
        gravity=GRAVITY,
    )
    solver, watch = gs.Solver.of(scene, method), Stopwatch()
    x, y = scene.points.position.T
    corner = int(np.argmax(x - y))
    time = np.linspace(0, DURATION, 151)
    fall = np.empty_like(time)
    for row, end in enumerate(time):
        with watch:
            solver.advance_to(end)
        fall[row] = solver.position[corner, 1] - y[corner]
    return Swing(time, fall, watch.core_seconds)


def published(name: str) -> Swing:
    file = resources.files(__package__) / "data" / f"cantilever_{name}.csv"
    with file.open() as lines:
        rows = np.loadtxt(lines, delimiter=",")
    return Swing(*rows[rows[:, 0].argsort()].T)


def draw(others: dict[str, Swing], few: Swing, many: Swing, linear: Swing) -> Figure:
    figure = Figure(figsize=(8.0, 4.4), layout="constrained")
    ax = figure.add_subplot()
    styles = ("ko", "C7^", "C7x")
    names = ("finite elements", "uGIMP, published", "CPDI, published")
    for style, name, other in zip(styles, names, others.values(), strict=True):
        ax.plot(other.time, other.fall, style, markersize=3.5, markerfacecolor="none", label=name)
    ax.plot(many.time, many.fall, "C0", label="uGIMP, 6 x 6 points a cell")
    ax.plot(few.time, few.fall, "C1", label="uGIMP, 3 x 3 points a cell")
    ax.plot(linear.time, linear.fall, "C3", linewidth=1, label="linear MPM, 3 x 3 points a cell")
    ax.set(xlabel="time (s)", ylabel="displacement of the tip (m)", xlim=(0, DURATION))
    figure.legend(loc="outside lower center", ncols=2)
    return figure


PROBLEM = Problem("cantilever", "Cantilever", run)
