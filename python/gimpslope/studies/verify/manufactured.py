"""A square between rollers is forced to swing as a formula says.

u = A sin(pi X) sin(c pi t), v = -A sin(pi Y) sin(c pi t) with c = sqrt(E / rho), in a unit square
(Wallstedt and Guilkey 2008, J. Comput. Phys. 227: axis-aligned displacement). Nothing turns, so
the stress is Hooke's law in the logarithmic strains, s11 = (lam + 2 mu) ln F11 + lam ln F22, and
the force that it takes, with cp^2 = (lam + 2 mu) / rho, is

    b1 = pi^2 u (cp^2 F22 / F11 - c^2),   b2 = pi^2 v (cp^2 F11 / F22 - c^2).

In a step places belong to its start, velocities to half a step before, stresses and volumes to a
whole one if stress comes first: each is given the value of its time at first. The step falls as
h^2, lest its error of first order hide the order in h.
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

MATERIAL = gs.Elastic(density=1000.0, young=1e7, poisson=0.3)
SHEAR, LAME = MATERIAL.shear_modulus, MATERIAL.bulk_modulus - 2 / 3 * MATERIAL.shear_modulus  # Pa
BAR_SPEED = (MATERIAL.young / MATERIAL.density) ** 0.5  # c, m/s
PERIOD = 2 / BAR_SPEED  # s
AMPLITUDES = (0.01, 0.1)  # A, m: strains up to 3 and 31 %
SIGN = np.array([1.0, -1.0])  # of u and v
KINDS = {
    "linear": gs.Method(shape="linear", alpha=0.0),
    "uGIMP": gs.Method(alpha=0.0),
    "cpGIMP, jacobian": gs.Method(shape="cpgimp", domain_update="jacobian", alpha=0.0),
    "cpGIMP, stretch": gs.Method(shape="cpgimp", domain_update="stretch", alpha=0.0),
    "B-spline": gs.Method(shape="quadratic_bspline", alpha=0.0),
}
CONVERGES = (  # at order 2, and why
    (0.01, "cpGIMP, stretch", "contiguous domains: 2, mean of all h"),
    (0.1, "cpGIMP, stretch", "contiguous domains: 2, mean of all h"),
    (0.01, "B-spline", "no kink to cross, and linear up to the walls: 2, mean of all h"),
)
COURANT = 3.2  # over the cells a side
FAILS = {  # case: largest order in the last halving of h, and why
    (0.01, "linear"): (0.5, "points cross edges once A > h / 4: no convergence"),
    (0.1, "linear"): (0.5, "points cross edges on all grids: no convergence"),
    (0.1, "uGIMP"): (1.0, "domains of the first size overlap and gape by 31 %: it stalls"),
    (0.1, "cpGIMP, jacobian"): (1.5, "sqrt(F11 F22) for F11 and F22: it stalls later"),
    (0.1, "B-spline"): (1.0, "points that are spread unevenly integrate it badly: it stalls"),
}


def run(full: bool) -> Outcome:
    """Each kind of domain at both amplitudes, on finer and finer grids."""
    cells = [8, 16, 32, 64] if full else [8, 16, 32]
    errors = {
        (amplitude, kind): np.array(
            [swing(n, amplitude, replace(method, courant=COURANT / n)).error for n in cells]
        )
        for amplitude in AMPLITUDES
        for kind, method in KINDS.items()
    }
    checks = []
    for amplitude, kind, why in CONVERGES:
        error = errors[amplitude, kind]
        order = float(np.log2(error[0] / error[-1])) / (len(cells) - 1)
        name = f"A = {amplitude}, {kind}: order"
        checks.append(Check.near(name, expected=2, got=order, within=0.2, why=why, order=order))
    for (amplitude, kind), (bound, why) in FAILS.items():
        order = float(np.log2(errors[amplitude, kind][-2] / errors[amplitude, kind][-1]))
        name = f"A = {amplitude}, {kind}: order, last halving"
        checks.append(Check.at_most(name, bound=bound, got=order, why=why, order=order))
    return Outcome(checks, draw(cells, errors))


class Swing(NamedTuple):
    """The largest error of a displacement in a period, m (infinite where the run fails), and the
    cost of the steps alone."""

    error: float
    core_seconds: float


def swing(cells: int, amplitude: float, method: gs.Method) -> Swing:
    """A period, in even steps of about the method's Courant number."""
    steps = int(np.ceil(PERIOD * MATERIAL.wave_speed * cells / method.step[1]))
    step = PERIOD / steps
    before = step if method.scheme == "usf" else 0.0  # where stresses at the start belong
    square = gs.Scene(
        gs.Outline(np.array([(0, 0), (1, 0), (1, 1), (0, 1)])),
        MATERIAL,
        cell=1 / cells,
        walls=gs.Walls(gs.Roller(), gs.Roller(), gs.Roller(), gs.Roller()),
    )
    points = square.points
    place = points.position
    form, slope = SIGN * np.sin(np.pi * place), SIGN * np.pi * np.cos(np.pi * place)
    stretch = 1 + amplitude * slope * swing_at(-before)
    solver = gs.Solver(
        gs.Points(
            position=place,
            half_length=points.half_length * (stretch if method.shape == "cpgimp" else 1),
            volume=points.volume * stretch.prod(axis=1),
            mass=points.mass,
            material=points.material,
        ),
        square.materials,
        cell=square.cell,
        walls=square.walls,
        wall_positions=square.wall_positions,
        velocity=amplitude * form * np.pi * BAR_SPEED * np.cos(np.pi * BAR_SPEED * step / 2),
        stress=stress_of(stretch),
        method=replace(method, courant=None, time_step=step),
    )
    errors, watch = [], Stopwatch()
    try:
        for time in step * np.arange(steps):
            swung = amplitude * swing_at(time)
            solver.body_force = force_at(form * swung, 1 + slope * swung)
            with watch:
                solver.step()
            exact = place + amplitude * swing_at(time + step) * form
            errors.append(np.abs(solver.position - exact).max())
    except gs.Diverged:
        return Swing(np.inf, watch.core_seconds)
    return Swing(float(max(errors)), watch.core_seconds)


def swing_at(time: float) -> float:
    """Share of the amplitude."""
    return float(np.sin(np.pi * BAR_SPEED * time))


def stress_of(stretch: FloatArray) -> FloatArray:
    """Stress (n, 4) of the stretches F11, F22 (n, 2), Pa."""
    strain = np.log(stretch)
    shared = LAME * strain.sum(axis=1, keepdims=True)
    return np.hstack([shared + 2 * SHEAR * strain, shared, 0 * shared])


def force_at(displacement: FloatArray, stretch: FloatArray) -> FloatArray:
    """Force a unit of mass, m/s2, shape (n, 2)."""
    stiffness = MATERIAL.wave_speed**2 * stretch[:, ::-1] / stretch - BAR_SPEED**2
    force: FloatArray = np.pi**2 * displacement * stiffness
    return force


def draw(cells: list[int], errors: dict[tuple[float, str], FloatArray]) -> Figure:
    """The error over the amplitude against the cells."""
    figure = Figure(figsize=(8.0, 3.8), layout="constrained")
    panels = figure.subplots(1, len(AMPLITUDES), sharey=True)
    for ax, amplitude in zip(panels, AMPLITUDES, strict=True):
        for kind, mark in zip(KINDS, "^sDov", strict=True):
            ax.loglog(cells, errors[amplitude, kind] / amplitude, f"{mark}-", ms=4, label=kind)
        ax.loglog(cells, 10 / np.square(cells), "k:", linewidth=0.8, label="second order")
        ax.set(title=f"A = {amplitude} m", xlabel="cells a side", ylim=(1e-3, 1e1))
        ax.set_xticks(cells, [str(n) for n in cells])
        ax.minorticks_off()
    panels[0].set_ylabel("largest error / A")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=6)
    return figure


PROBLEM = Problem("manufactured", "Manufactured solution in a square", run)
