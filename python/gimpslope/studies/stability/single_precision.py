"""What 24 binary digits do to a place far from the origin, and to a slide.

A block flies freely ten kilometres from the origin, where neighbouring numbers in single precision
are a millimetre apart and a step moves it by three. Adding steps to a place in single precision
rounds each of them; `precision="single"` counts places from a node near each point.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Precision
from .. import reference
from ..check import Check
from .mode import Findings, Mode, Table

FAR, CELL, SPEED, STEP, FLIGHT = 1e4, 0.5, 3.0, 1e-3, 1000  # m, m, m/s, s, steps
SPACING = float(np.spacing(np.float32(FAR)))  # m
DIGITS = 2.0**-24
CELLS = {False: 0.4, True: 0.2}  # m, of the slope
SLIDE = {False: 1000, True: 2000}  # steps


class Slid(NamedTuple):
    """Kinetic energy by steps (J/m), and places in the end (m)."""

    energy: FloatArray
    place: FloatArray


def run(full: bool) -> Findings:
    """The flight three ways, and a slide in both precisions."""
    way = SPEED * STEP * FLIGHT
    naive = np.float32(FAR)
    for _ in range(FLIGHT):
        naive = np.float32(naive + np.float32(SPEED * STEP))
    lost = abs(float(naive) - FAR - way) / CELL
    flown = {precision: abs(flight(precision) - way) / CELL for precision in ("single", "double")}
    double, single = (slide(CELLS[full], SLIDE[full], kind) for kind in ("double", "single"))
    off = np.abs(single.energy - double.energy) / double.energy.max()
    apart = float(np.median(np.hypot(*(single.place - double.place).T)))
    fails = [
        Check.near(
            f"added up in single precision {FAR:.0f} m away: error of a place, cells",
            expected=FLIGHT * _rounding() / CELL,
            got=lost,
            within=1e-2 * FLIGHT * _rounding() / CELL,
            why="each step is rounded to the same multiple of the spacing of the numbers",
        )
    ]
    stands = [
        Check.at_most(
            'precision "single": the same, cells',
            bound=1e-4,
            got=flown["single"],
            why="counted from a node nearby: 1,000 roundings of 2^-24 of a cell are 6e-5",
        ),
        Check.at_most(
            'precision "double", the default: the same, cells',
            bound=2e-9,
            got=flown["double"],
            why="1,000 roundings of 0.9e-12 m in cells of half a metre",
        ),
        Check.at_most(
            f"slide of {SLIDE[full]:,} steps in single precision: kinetic energy, of the largest",
            bound=1e4 * DIGITS,
            got=float(off.max()),
            why="2^-24 a step, which a slide amplifies: a hundredth of what any grid changes",
        ),
        Check.at_most(
            "the same: median difference of places, cells",
            bound=1e4 * DIGITS,
            got=apart / CELLS[full],
            why="as above",
        ),
    ]
    listed: list[tuple[str | float, ...]] = [
        ("added up in single precision", lost),
        *((f'precision "{name}"', value) for name, value in flown.items()),
    ]
    columns = ("flight far away", "error of the place, cells")
    return Findings(fails, stands, draw(double, off), Table(columns, listed))


def _rounding() -> float:
    """Of one step far away, m."""
    step = SPEED * STEP
    return abs(round(step / SPACING) * SPACING - step)


def flight(precision: Precision) -> float:
    """How far a block flew, m."""
    spacing = CELL / 2
    line = FAR + spacing * (np.arange(8) + 0.5)
    place = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    n = len(place)
    area = np.full(n, spacing**2)
    points = gs.Points(place, np.full((n, 2), spacing / 2), area, 2e3 * area, np.zeros(n, np.int32))
    solver = gs.Solver(
        points,
        [gs.Elastic(2000.0, 1e6, 0.3)],
        cell=CELL,
        velocity=np.full((n, 2), SPEED),
        method=gs.Method(precision=precision, time_step=STEP),
    )
    solver.advance(FLIGHT)
    return float((solver.position - place).mean())


def slide(cell: float, steps: int, precision: Precision) -> Slid:
    """Slope A let go at once under its full weight."""
    method = gs.Method(
        viscosity=reference.READINGS["identified"].viscosity,
        precision=precision,
        time_step=0.4 * cell / reference.soil().wave_speed,
    )
    solver = gs.Solver.of(reference.slope(cell=cell), method)
    energy = []
    for _ in range(steps // 20):
        solver.advance(20)
        energy.append(solver.energies().kinetic)
    return Slid(np.array(energy), solver.position)


def draw(double: Slid, off: FloatArray) -> Figure:
    """Kinetic energy, and its difference."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    steps = 20 * (1 + np.arange(len(off)))
    left.plot(steps, double.energy / 1e3)
    left.set(xlabel="steps", ylabel="kinetic energy (kJ/m)")
    right.semilogy(steps, off, label="single - double")
    right.axhline(DIGITS, color="k", linestyle=":", linewidth=0.8, label="$2^{-24}$")
    right.set(xlabel="steps", ylabel="of the largest energy")
    right.legend()
    return figure


MODE = Mode(
    name="single_precision",
    title="Single precision",
    mechanism="A number in single precision has 24 binary digits: ten kilometres from the origin "
    "places lie a millimetre apart, a good part of what a point moves in a step. Every step "
    "rounds the same way and the error grows with their number. Counted from a node nearby, 24 "
    "digits are a ten-millionth of a cell and a slide hardly notices.",
    source="Goldberg 1991, ACM Comput. Surv. 23, 5",
    advice='Double precision, the default, is as fast here. `precision="single"` is safe and '
    "tells what the digits are worth; put the origin of a scene of your own near the slope all "
    "the same.",
    run=run,
)
