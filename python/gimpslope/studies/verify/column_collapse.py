"""A column of dry sand collapses; how far it spreads goes with powers of its aspect ratio.

Of a column of width L and height H = a L against a wall, experiments in channels found

* a run-out beyond L that grows as a for a < 1.8 and as a^(2/3) for a > 2.8 (Lube et al. 2005, Phys.
  Rev. E 72:041301; Lajeunesse et al. 2005, Phys. Fluids 17:103302: below and above 3);
* a final height that grows as a for a < 1.15 and as a^(2/5) above (Lube et al.), or as a for
  a < 0.7 and as a^(1/3) above (Lajeunesse et al.).

Heaps of rods give the powers 0.96 and 0.73 of the run-out and 1/3 of the height (Failure mechanism
of true 2D granular flows, arXiv:1512.05180).

The constants depend on the sand, the powers do not. All columns here have as many points, and a
viscosity of H sqrt(g H) / 2000, so that they are alike but for their shape.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .problem import Outcome, Problem

WIDTH, GRAVITY = 1.0, 9.81  # m, m/s2
DENSITY, FRICTION = 1600.0, 31.0  # kg/m3, degrees
STIFFNESS = 1000.0  # Young's modulus over the weight of the column, gamma H
REYNOLDS = 2000.0  # H sqrt(g H) over the viscosity
DURATION = 8.0  # in sqrt(H / g)


class Law(NamedTuple):
    """A power of the aspect ratio within a range of it, and how far published ones lie from it."""

    quantity: str
    low: float
    high: float
    power: float
    scatter: float
    cells: float  # by which the grid blurs the quantity
    why: str


SPREADS = Law("run-out", 0.0, 1.8, 1.0, 0.05, 1.0, "rods: 0.96; a cell at either end of the fit")
RUNS = Law("run-out", 2.8, np.inf, 2 / 3, 0.065, 1.0, "rods: 0.73; a cell at either end of the fit")
STANDS = Law(
    "final height", 0.0, 0.7, 1.0, 0.0, 0.25, "no slip meets the wall; half a point at either end"
)
SINKS = Law(
    "final height", 1.15, np.inf, 11 / 30, 1 / 30, 1.0, "between 1/3 and 2/5; a cell at either end"
)


class Heaps(NamedTuple):
    """By aspect ratio: run-out and final height, parts of the width, and cells to the width."""

    aspect: FloatArray
    run_out: FloatArray
    height: FloatArray
    cells: FloatArray

    def within(self, law: Law) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Aspect ratios, values and cells in the range of a law."""
        values = self.run_out if law.quantity == "run-out" else self.height
        inside = (self.aspect >= law.low) & (self.aspect <= law.high)
        return self.aspect[inside], values[inside], self.cells[inside]


def run(full: bool) -> Outcome:
    """Powers from four columns of 200 cells, or from ten of 800."""
    aspects = (0.3, 0.45, 0.7, 1.2, 1.7, 2.8, 3.6, 4.6, 5.8, 7.2) if full else (0.35, 0.7, 2.8, 7.0)
    found = [collapse(aspect, 800 if full else 200) for aspect in aspects]
    heaps = Heaps(np.array(aspects), *np.array(found).T)
    laws = (SPREADS, RUNS, STANDS, SINKS) if full else (RUNS, STANDS)  # where coarse grids tell
    return Outcome([check(heaps, law) for law in laws], draw(heaps))


def check(heaps: Heaps, law: Law) -> Check:
    """The power that fits the heaps against that of a law."""
    aspect, values, cells = np.log(heaps.within(law))
    blur = law.cells * np.exp(-cells - values)  # of the logarithm of each value
    side = "below" if law.low == 0 else "above"
    return Check.near(
        f"{law.quantity}, power of a {side} {law.high if law.low == 0 else law.low}",
        expected=law.power,
        got=float(np.polyfit(aspect, values, 1)[0]),
        within=law.scatter + float((blur[0] + blur[-1]) / (aspect[-1] - aspect[0])),
        why=law.why,
    )


def collapse(aspect: float, cells: int) -> tuple[float, float, int]:
    """Run-out and final height of a column, parts of its width, and cells to its width.

    The run-out is thrice the mean distance of what lies beyond the first edge. That is the length
    of a triangular heap, and single points that ran ahead do not count.
    """
    height = aspect * WIDTH
    soil = gs.DruckerPrager(
        DENSITY,
        young=STIFFNESS * DENSITY * GRAVITY * height,
        poisson=0.3,
        friction=FRICTION,
        cohesion=0,
        cone="plane_strain",
    )
    across = round((cells / aspect) ** 0.5)
    column = gs.Scene(
        gs.Outline(np.array([(0, 0), (WIDTH, 0), (WIDTH, height), (0, height)])),
        soil,
        cell=WIDTH / across,
        walls=gs.Walls(left=gs.Roller()),
    )
    points = column.points
    vertical = -DENSITY * GRAVITY * (height - points.position[:, 1])
    at_rest = 1 - np.sin(np.radians(FRICTION))  # Jaky 1944
    solver = gs.Solver.of(
        column,
        gs.Method(
            viscosity=height * (GRAVITY * height) ** 0.5 / REYNOLDS,
            volumetric_strain="cell_average",  # sand that flows without dilatancy locks otherwise
        ),
    )
    solver.stress = vertical[:, None] * np.array([at_rest, 1, at_rest, 0])
    while solver.time < DURATION * (height / GRAVITY) ** 0.5:
        solver.advance(20)
        # Without dilatancy all growth is gaps between grains, which are no sand.
        solver.volume = np.minimum(solver.volume, points.volume)
    x, y = solver.position.T
    beyond = x[x > WIDTH] - WIDTH
    summit = y[x < 0.3 * WIDTH].max() + points.half_length[0, 1]
    return 3 * float(beyond.mean()) / WIDTH, float(summit) / WIDTH, across


def draw(heaps: Heaps) -> Figure:
    """Run-out and height by aspect ratio, with lines of the published powers."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.loglog(heaps.aspect, heaps.run_out, "ko", markersize=4, label="computed")
    _guide(left, heaps, SPREADS, 1.0, "C0-", "a, both")
    _guide(left, heaps, RUNS, 2 / 3, "C1-", "a^(2/3), both")
    left.set_ylabel("run-out / L")
    right.loglog(heaps.aspect, heaps.height, "ko", markersize=4, label="computed")
    _guide(right, heaps, STANDS, 1.0, "C0-", "a, both")
    _guide(right, heaps, SINKS, 2 / 5, "C1-", "a^(2/5), Lube et al.")
    _guide(right, heaps, SINKS, 1 / 3, "C2--", "a^(1/3), Lajeunesse et al.")
    right.set_ylabel("final height / L")
    for ax in (left, right):
        ax.set_xlabel("aspect ratio a = H / L")
        ax.set_xlim(0.25, 9)
        ax.legend(loc="lower right")
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_locator(NullLocator())
    return figure


def _guide(ax: Axes, heaps: Heaps, law: Law, power: float, style: str, label: str) -> None:
    """A line of a power through the middle of the values in the range of a law."""
    aspect, values, _ = heaps.within(law)
    constant = np.exp(np.mean(np.log(values) - power * np.log(aspect)))
    ends = np.array([aspect[0] / 1.1, aspect[-1] * 1.1])
    ax.plot(ends, constant * ends**power, style, linewidth=1, label=label)


PROBLEM = Problem("column_collapse", "Collapse of columns of sand", run)
