"""The factor of safety of a slope: the F by which c and tan(phi) may be divided until it falls.

The elastic slope comes to rest under gravity, then its strength is reduced and the damping kept:
only equilibrium counts. It comes to rest again or slides, and F is found by bisection. The soil is
so stiff that it falls before it has moved by a tenth of a cell.

* ACADS 1(a) (Giam & Donald 1989): referee 1.00, 33 answers from 0.94 to 1.03.
* Griffiths & Lane (1999, Geotechnique 49, 387), example 1: finite elements stand at 1.35 and fall
  at 1.40; the charts of Bishop & Morgenstern (1960) give 1.380.
* The reference slope: at most 0.543, by a rigid body that turns on a logarithmic spiral (Chen
  1975, Limit analysis and soil plasticity, chapter 9).

That bound is for soil that dilates at its friction angle. A grid allows only some of all motions
and so comes down to it from above. Soil that keeps its volume as it flows carries no more
(Radenkovic 1961), on finer grids ever less, for its slip bands have no width of their own. Points
with a volume strain each lock then, and hold up a slope that falls.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .log_spiral import stability_number
from .problem import Outcome, Problem

YOUNG, POISSON = 1e9, 0.3  # Pa
DAMPING = 0.8  # share of each nodal force
PAUSE, PATIENCE = 10, 40  # between looks, in times of a wave over the height; looks at most
REST, AWAY = 1e-3, 5.0  # growth in a pause, and displacement, parts of gamma H2 / E


class Slope(NamedTuple):
    """Height (m), angle of the face (degrees), gravity (m/s2), and what is known of F."""

    name: str
    outline: gs.Outline
    height: float
    angle: float
    soil: gs.DruckerPrager
    walls: gs.Walls
    gravity: float
    known: tuple[float, float]

    def weakened(self, factor: float, *, dilates: bool = False) -> gs.DruckerPrager:
        """The soil with c and tan(phi) divided by the factor."""
        friction = np.degrees(np.arctan(np.tan(np.radians(self.soil.friction)) / factor))
        dilation = friction if dilates else 0.0
        cohesion = self.soil.cohesion / factor
        return replace(self.soil, friction=friction, cohesion=cohesion, dilation=dilation)


class Trial(NamedTuple):
    """A slope weakened by a factor; displacements in gamma H2 / E, places in m."""

    factor: float
    rests: bool
    displacement: FloatArray
    position: FloatArray


class Search(NamedTuple):
    """Trials by factor, the factor of safety that they enclose (NaN where they enclose none), and
    whether volumes can lock."""

    slope: Slope
    trials: list[Trial]
    factor: float
    locks: bool


def soil(density: float, friction: float, cohesion: float) -> gs.DruckerPrager:
    """kg/m3, degrees, Pa."""
    return gs.DruckerPrager(density, YOUNG, POISSON, friction, cohesion, cone="plane_strain")


FLAT, STEEP = float(np.degrees(np.arctan(0.5))), 45.0  # degrees
TOE = (30.0, 25.0)  # m, and all corners of the outline below
CORNERS = np.array([(20, 20), (70, 20), (70, 35), (50, 35), TOE, (20, 25)])
SIDES = gs.Walls(left=gs.Roller(), right=gs.Roller(), bottom=gs.Fixed())
SIDE = gs.Walls(left=gs.Roller(), bottom=gs.Fixed())
ACADS = Slope(
    "ACADS 1(a)", gs.Outline(CORNERS), 10, FLAT, soil(2000, 19.6, 3e3), SIDES, 10, (0.94, 1.03)
)
TWELVE = gs.Outline.slope(10, 12, FLAT)
GRIFFITHS = Slope(
    "Griffiths & Lane 1", TWELVE, 10, FLAT, soil(2000, 20, 10e3), SIDE, 10, (1.35, 1.40)
)
NINE = gs.Outline.slope(9, 2, STEEP)
REFERENCE = Slope(
    "reference slope", NINE, 9, STEEP, soil(1800, 22, 1e3), gs.Walls(), 9.81, (0.543, 0.543)
)


def run(full: bool) -> Outcome:
    """ACADS 1(a) on a coarse grid, or all slopes on finer ones."""
    cells, halvings = (20, 6) if full else (10, 4)
    acads, locked = (search(ACADS, cells, halvings, locks=locks) for locks in (False, True))
    checks = [
        Check(
            f"ACADS 1(a): F, h = H/{cells}",
            expected=1.0,
            got=acads.factor,
            low=ACADS.known[0],
            high=ACADS.known[1],
            why="33 published answers lie between 0.94 and 1.03",
        ),
        Check.at_most(
            f"ACADS 1(a): F over its log-spiral bound, h = H/{cells}",
            bound=1 + 1 / cells,
            got=acads.factor / spiral(ACADS)[0],
            why="without dilation no more than that, but for the grid: first order in h / H",
        ),
        Check.at_least(
            f"ACADS 1(a): F with a volume strain at each point, h = H/{cells}",
            bound=ACADS.known[1],
            got=locked.factor,
            why="locks: stands where by all published answers it has fallen",
        ),
    ]
    if not full:
        return Outcome(checks, draw([acads, locked]))
    griffiths, reference = search(GRIFFITHS, 20, halvings), search(REFERENCE, 36, halvings)
    checks.append(
        Check.near(
            "Griffiths & Lane 1: F, h = H/20",
            expected=1.375,
            got=griffiths.factor,
            within=0.025,
            why="published finite elements stand at 1.35 and fall at 1.40",
        )
    )
    checks += about_the_bound(reference.factor, halvings)
    return Outcome(checks, draw([acads, locked, griffiths, reference]))


def about_the_bound(constant_volume: float, halvings: int) -> list[Check]:
    """The reference slope without dilation, and on two grids with that which the bound assumes."""
    bound = spiral(REFERENCE)[0]
    coarse, fine = (search(REFERENCE, cells, halvings, dilates=True).factor for cells in (18, 36))
    return [
        Check.near(
            "reference slope: log-spiral bound of F",
            expected=0.543,
            got=bound,
            within=5e-4,
            why="known to three digits",
        ),
        Check.at_most(
            "reference slope: F, h = H/36",
            bound=bound,
            got=constant_volume,
            why="flow without dilation carries no more than the log-spiral bound",
        ),
        Check.at_least(
            "reference slope, psi = phi: F, h = H/36",
            bound=bound,
            got=fine,
            why="a mechanism on a grid is an upper bound too, and wider than a slip line",
        ),
        Check.at_most(
            "reference slope, psi = phi: excess over the bound, halved cell over cell",
            bound=0.75,
            got=(fine - bound) / (coarse - bound),
            why="first order would halve it; it need be no better than an order of 0.4",
        ),
    ]


def search(
    slope: Slope, cells: int, halvings: int, *, dilates: bool = False, locks: bool = False
) -> Search:
    """Bisect within 20 % of the log-spiral bound, with that many cells over the height."""
    low, high = 0.8 * spiral(slope)[0], 1.2 * spiral(slope)[0]
    method = gs.Method(volumetric_strain="point" if locks else "cell_average")
    trials = []
    for _ in range(halvings):
        middle = (low + high) / 2
        soil = slope.weakened(middle, dilates=dilates)
        trials.append(Trial(middle, *attempt(slope, soil, slope.height / cells, method)))
        low, high = (middle, high) if trials[-1].rests else (low, middle)
    trials.sort(key=lambda trial: trial.factor)
    enclosed = trials[0].rests and not trials[-1].rests
    return Search(slope, trials, (low + high) / 2 if enclosed else np.nan, locks)


def attempt(
    slope: Slope, soil: gs.Material, cell: float, method: gs.Method
) -> tuple[bool, FloatArray, FloatArray]:
    """Let the elastic slope come to rest, give it a soil, and see whether it does so again."""
    scene = gs.Scene(slope.outline, soil, cell=cell, walls=slope.walls, gravity=slope.gravity)
    solver = gs.Solver.of(scene, method, elastic=True)
    solver.set_damping(local=DAMPING)
    wait(solver, slope)
    solver.set_materials(scene.materials)
    return (*wait(solver, slope), solver.position)


def wait(solver: gs.Solver, slope: Slope) -> tuple[bool, FloatArray]:
    """Until the slope moves no more, or has moved far: whether it rests, and displacements."""
    unit = slope.soil.density * slope.gravity * slope.height**2 / YOUNG
    pause = PAUSE * slope.height * float(np.sqrt(slope.soil.density / YOUNG))
    start, displacement = solver.position, np.zeros(len(solver))
    for _ in range(PATIENCE):
        before = displacement.max()
        solver.advance_to(solver.time + pause)
        displacement = np.linalg.norm(solver.position - start, axis=1) / unit
        if abs(displacement.max() - before) < REST:
            return True, displacement
        if displacement.max() > AWAY:
            break
    return False, displacement


@cache
def spiral(slope: Slope) -> tuple[float, float, float]:
    """The upper bound of F, and the angles of the radii to crest and toe, radians."""
    low, high = 0.1, 10.0
    while high - low > 1e-5:
        factor = (low + high) / 2
        weak = slope.weakened(factor)
        number, crest, toe = stability_number(np.radians(weak.friction), np.radians(slope.angle))
        stands = weak.density * slope.gravity * slope.height < number * weak.cohesion
        low, high = (factor, high) if stands else (low, factor)
    return low, crest, toe


def draw(searches: list[Search]) -> Figure:
    """How far slopes move as their strength is reduced, and how ACADS 1(a) slips."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    curves, slip = figure.subplots(1, 2, width_ratios=(1.1, 1))
    for number, (slope, trials, factor, locks) in enumerate(searches):
        low, high = slope.known
        colour, label = f"C{number}", f"{slope.name}{', locks' if locks else ''}: {factor:.3f}"
        if not locks:
            curves.axvspan(low, max(high, low + 0.004), color=colour, alpha=0.2, linewidth=0)
        curves.plot([], [], "o-", color=colour, label=label)
        largest = [min(trial.displacement.max(), AWAY) for trial in trials]
        curves.plot([trial.factor for trial in trials], largest, color=colour, linewidth=0.8)
        for trial, top in zip(trials, largest, strict=True):
            face = colour if trial.rests else "white"
            curves.plot(trial.factor, top, "o", color=colour, mfc=face, markersize=4.5)
    curves.plot([], [], "o", color="k", mfc="white", label="slides")
    curves.fill([], [], color="k", alpha=0.2, linewidth=0, label="published")
    curves.set(xlabel="F", ylabel=r"displacement $\cdot\ E\ /\ \gamma H^2$", ylim=(0, 1.1 * AWAY))
    figure.legend(loc="outside lower center", ncols=3)
    trials = searches[0].trials
    _map(slip, next((trial for trial in trials if not trial.rests), trials[-1]))
    return figure


def _map(ax: Axes, trial: Trial) -> None:
    """Displacements of the points, and the spiral of the upper bound."""
    moved = trial.displacement / trial.displacement.max()
    size = 75 * ACADS.outline.area / len(moved)  # points overlap a little
    x, y = trial.position[:, 0], trial.position[:, 1]
    points = ax.scatter(x, y, size, moved, marker="s", linewidths=0)
    factor, first, last = spiral(ACADS)
    theta = np.linspace(first, last, 100)
    radius = np.exp((theta - first) * np.tan(np.radians(ACADS.weakened(factor).friction)))
    radius *= ACADS.height / (radius[-1] * np.sin(last) - np.sin(first))
    line = radius * np.array([np.cos(theta), -np.sin(theta)])
    line += np.array(TOE)[:, None] - line[:, -1:]
    ax.plot(*line, "r-", linewidth=1.2, label="log-spiral")
    ax.set(xlabel="x (m)", ylabel="y (m)", xlim=(22, 62), ylim=(20, 36), aspect="equal")
    ax.set_title(f"{ACADS.name}, F = {trial.factor:.3f}")
    ax.legend(loc="upper left")
    ax.figure.colorbar(points, ax=ax, label="displacement / largest", location="bottom", shrink=0.8)


PROBLEM = Problem("safety_factor", "Factor of safety of slopes", run)
