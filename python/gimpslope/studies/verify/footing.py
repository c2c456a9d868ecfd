"""A strip footing on weightless clay carries (2 + pi) c (Prandtl 1920).

Undrained clay hardly changes its volume, neither in the elastic range nor as it flows. Four points
a cell, each with a volume strain of its own, are more constraints than the nodes have freedom: the
load finds no limit (Nagtegaal, Parks & Rice 1974, CMAME 4, 153) and the mean stress forms a
checkerboard. One volume strain a cell, as in B-bar (Hughes 1980, IJNME 15, 1413), cures both.

Half of the footing stands at a plane of symmetry and is pushed down by a force that holds its
speed. The clay is so stiff that it fails before the footing has sunk by a fiftieth of a cell. Soil
and footing share one velocity field, in which the footing acts up to a cell wider on either side:
the load must lie between (2 + pi) c and (2 + pi) c (1 + 2 h / B).
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .problem import Outcome, Problem

COHESION = 10e3  # Pa
CLAY = gs.DruckerPrager(2000.0, 300e6, 0.49, friction=0, cohesion=COHESION, cone="plane_strain")
PLATE = gs.Elastic(density=2e5, young=3e9, poisson=0.3)  # heavy: holds its speed
HALF_WIDTH, DEPTH, LENGTH = 1.0, 3.0, 6.0  # of footing and soil, m
SPEED, RAMP, SETTLEMENT = 0.01, 0.05, 2.5e-3  # m/s, s, m
FACTOR = 2 + np.pi
GAIN = 0.01 * FACTOR

Strain = Literal["point", "cell_average"]


class Test(NamedTuple):
    """Settlement (m) and load (parts of c) by steps; places (m) and mean stress (c) in the end."""

    settlement: FloatArray
    load: FloatArray
    places: FloatArray
    mean_stress: FloatArray
    cell: float

    def load_at(self, share: float) -> float:
        """Load near a share of the settlement: a mean over 5 % of it, for the load still swings."""
        near = np.abs(self.settlement - share * SETTLEMENT) < 0.025 * SETTLEMENT
        return float(self.load[near].mean())

    def checkerboard(self) -> float:
        """RMS difference of a point's mean stress from that of its cell and the four around it,
        parts of c."""
        columns, rows = np.floor(self.places / self.cell).astype(int).T
        field, count = np.zeros((2, columns.max() + 3, rows.max() + 3))
        np.add.at(field, (columns + 1, rows + 1), self.mean_stress)
        np.add.at(count, (columns + 1, rows + 1), 1)
        field, count = _with_neighbours(field), _with_neighbours(count)
        mean = field[columns, rows] / count[columns, rows]
        return float(np.sqrt(np.mean((self.mean_stress - mean) ** 2)))


def _with_neighbours(cells: FloatArray) -> FloatArray:
    """Sum of each inner cell and the four around it."""
    inner, below, above = cells[1:-1, 1:-1], cells[1:-1, :-2], cells[1:-1, 2:]
    return inner + below + above + cells[:-2, 1:-1] + cells[2:, 1:-1]


def run(full: bool) -> Outcome:
    """With and without the cure, on a coarse grid or on two finer ones."""
    cells = (HALF_WIDTH / 8, HALF_WIDTH / 16) if full else (HALF_WIDTH / 4,)
    checks, tests = [], {}
    for cell in cells:
        at = f", h = B/{2 * HALF_WIDTH / cell:.0f}"
        locked, cured = tests[cell] = push(cell, "point"), push(cell, "cell_average")
        widened = FACTOR * (1 + cell / HALF_WIDTH)
        checks += [
            Check.at_most(
                f"cell average: load / c{at}",
                bound=widened,
                got=cured.load_at(0.95),
                why="(2 + pi) (1 + 2 h / B): the footing acts a cell wider on either side",
            ),
            Check.at_least(
                f"cell average: load / c in the end{at}",
                bound=0.98 * FACTOR,
                got=cured.load_at(0.95),
                why="a mechanism on a grid is an upper bound; 2 % for the swing of the load",
            ),
            Check.at_least(
                f"point: load / c{at}",
                bound=widened,
                got=locked.load_at(0.95),
                why="locks: above any limit load, that of the widened footing included",
            ),
            Check.at_most(
                f"cell average: gain of load / c in the last third{at}",
                bound=GAIN,
                got=cured.load_at(0.95) - cured.load_at(0.65),
                why="a limit load: flat but for its swing, 1 %",
            ),
            Check.at_least(
                f"point: gain of load / c in the last third{at}",
                bound=GAIN,
                got=locked.load_at(0.95) - locked.load_at(0.65),
                why="no limit load: it goes on rising, by more than that",
            ),
            Check.at_most(
                f"checkerboard of the mean stress, cell average over point{at}",
                bound=0.1,
                got=cured.checkerboard() / locked.checkerboard(),
                why="stress changes by c over some cells, a checkerboard by 10 c and more: a tenth",
            ),
        ]
    if full:
        coarse, fine = (tests[cell][1].load_at(0.95) for cell in cells)
        checks.append(
            Check.at_most(
                "cell average: excess of the load, halved cell over cell",
                bound=0.75,
                got=(fine - FACTOR) / (coarse - FACTOR),
                why="first order would halve it; the singular edge allows less: an order of 0.4",
            )
        )
    return Outcome(checks, draw(*tests[cells[-1]]))


def push(cell: float, strain: Strain) -> Test:
    """Push the footing down to its settlement."""
    top = DEPTH + 2 * cell
    plate = gs.Outline(np.array([(0, DEPTH), (HALF_WIDTH, DEPTH), (HALF_WIDTH, top), (0, top)]))
    soil = [(0, 0), (LENGTH, 0), (LENGTH, DEPTH), (HALF_WIDTH, DEPTH), (HALF_WIDTH, top), (0, top)]
    walls = gs.Walls(left=gs.Roller(), right=gs.Roller(), bottom=gs.Fixed())
    scene = gs.Scene(
        gs.Outline(np.array(soil)), CLAY, stones=[plate], stone=PLATE, cell=cell, walls=walls
    )
    method = gs.Method(volumetric_strain=strain, alpha=0.0)
    solver = gs.Solver.of(scene, method)
    solver.set_gravity(0.0, 0.0)
    solver.set_damping(local=0.05)
    pushed = scene.points.material == 1
    mass, start = scene.points.mass[pushed].sum(), scene.points.position[pushed, 1].mean()
    force = np.zeros((len(solver), 2))
    patience = 10 * solver.time_step  # of the control of the speed, s
    settlement, load = [0.0], [0.0]
    while settlement[-1] < SETTLEMENT and solver.time < 2 * (RAMP + SETTLEMENT / SPEED):
        wanted = -SPEED * min(1.0, solver.time / RAMP)
        inertia = mass * SPEED / RAMP if solver.time < RAMP else 0.0
        force[pushed, 1] = (wanted - solver.velocity[pushed, 1].mean()) / patience
        solver.body_force = force
        solver.step()
        settlement.append(start - solver.position[pushed, 1].mean())
        load.append((-mass * force[pushed, 1][0] - inertia) / HALF_WIDTH / COHESION)
    clay = ~pushed
    mean = solver.stress[clay, :3].mean(axis=1) / COHESION
    return Test(np.array(settlement), np.array(load), solver.position[clay], mean, cell)


def draw(locked: Test, cured: Test) -> Figure:
    """Load against settlement, and the mean stress under the footing."""
    figure = Figure(figsize=(10.0, 3.4), layout="constrained")
    curve, *maps = figure.subplots(1, 3, width_ratios=(1.2, 1, 1))
    for test, label, colour in ((locked, "point", "C1"), (cured, "cell average", "C0")):
        smooth = np.convolve(test.load, np.full(100, 0.01), "valid")
        curve.plot(test.settlement[50:-49] * 1e3, smooth, color=colour, label=label)
    curve.axhline(FACTOR, color="k", linewidth=0.8, linestyle="--", label="2 + pi")
    curve.set(xlabel="settlement (mm)", ylabel="load / c", ylim=(0, None))
    curve.legend(loc="lower right")
    for ax, test, title in zip(maps, (locked, cured), ("point", "cell average"), strict=True):
        _map(ax, test, title)
    image = maps[1].images[0]
    figure.colorbar(image, ax=maps, label="mean stress / c", shrink=0.6, extend="both")
    return figure


def _map(ax: Axes, test: Test, title: str) -> None:
    """The points as pixels: two a cell and direction."""
    columns, rows = np.floor(2 * test.places / test.cell).astype(int).T
    pixels = np.full((rows.max() + 1, columns.max() + 1), np.nan)
    pixels[rows, columns] = test.mean_stress
    extent = (0.0, (columns.max() + 1) * test.cell / 2, -DEPTH, 0.0)
    ax.imshow(pixels, origin="lower", extent=extent, vmin=-8, vmax=2, cmap="viridis")
    ax.plot([0, HALF_WIDTH], [0.05, 0.05], "k-", linewidth=3)
    ax.set(title=title, xlabel="x (m)", ylabel="y (m)")
    ax.set(xlim=(0, 3 * HALF_WIDTH), ylim=(-2 * HALF_WIDTH, 0.15))


PROBLEM = Problem("footing", "Strip footing on clay", run)
