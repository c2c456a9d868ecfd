"""Stones that share nodes move as one.

A stone moves away from one at rest across an empty gap. Deformable ones share one velocity field: a
node that both reach has the mean of their velocities, and the first drags the second along. With
uGIMP the domain of an outer point ends where the stone does, and reaches a cell further: both reach
a node for certain if the gap is below one cell, and where the grid lies so if it is below two.
Rigid stones have velocity fields of their own and touch by their shapes.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .mode import Findings, Mode, Table

CELL, PER_SIDE, SIDE = 1.0, 2, 3  # m; points a cell and direction; of a stone, cells
DENSITY = 2400.0
SPEED = 1e-3  # of the stone that leaves, m/s
KINDS: dict[str, gs.Material] = {
    "deformable": gs.Elastic(DENSITY, 0.5e9, 0.2),
    "rigid": gs.Rigid(DENSITY),
}
STEP, STEPS = 4e-4, 50  # s: below 0.4 h / c; a wave crosses a stone some times
PLACES = {False: 8, True: 32}  # of the grid
STUCK = 1e-6  # share of the momentum that counts as taken


def run(full: bool) -> Findings:
    """What the stone at rest takes, over gaps and places of the grid."""
    gaps = np.arange(0.1, 2.6, 0.1 if full else 0.3)
    offsets = (np.arange(PLACES[full]) + 0.5) / PLACES[full]
    taken = {
        name: np.array([[dragged(law, gap, offset) for offset in offsets] for gap in gaps])
        for name, law in KINDS.items()
    }
    soft, hard = np.abs(taken["deformable"]), np.abs(taken["rigid"])
    inside, outside, sure = gaps < 2 - 1 / PLACES[full], gaps > 2, gaps < 1
    fails = [
        Check.at_least(
            "deformable, gaps below two cells: least, over gaps, of the most taken over places",
            bound=STUCK,
            got=float(soft[inside].max(axis=1).min()),
            why="where a node lies in the reach of both it takes some of the momentum",
        ),
        Check.at_least(
            "deformable, gaps below one cell: least taken over gaps and places",
            bound=STUCK,
            got=float(soft[sure].min()),
            why="a node lies in the reach of both wherever the grid is",
        ),
    ]
    stands = [
        Check.at_most(
            "deformable, gaps above two cells: most taken",
            bound=1e-15,
            got=float(soft[outside].max()),
            why="no node lies in the reach of both",
        ),
        Check.at_most(
            "rigid, all gaps: most taken",
            bound=1e-15,
            got=float(hard.max()),
            why="fields of their own: they do not touch as they part",
        ),
    ]
    listed: list[tuple[str | float, ...]] = [
        (float(gap), float(soft[k].min()), float(soft[k].max()), float(hard[k].max()))
        for k, gap in enumerate(gaps)
    ]
    columns = (
        "gap, cells",
        "deformable: momentum taken, least over places",
        "most",
        "rigid: most",
    )
    return Findings(fails, stands, draw(gaps, soft, hard), Table(columns, listed))


def dragged(law: gs.Material, gap: float, offset: float) -> float:
    """Share of the momentum of the stone that leaves which the other has in the end."""
    spacing = CELL / PER_SIDE
    line = spacing * (np.arange(SIDE * PER_SIDE) + 0.5)
    still = np.stack(np.meshgrid(line + offset * CELL, line), axis=-1).reshape(-1, 2)
    leaves = still + np.array([(SIDE + gap) * CELL, 0.0])
    place, n = np.vstack([still, leaves]), len(still)
    area = np.full(2 * n, spacing**2)
    stone = np.repeat(np.arange(2), n).astype(np.int32)
    points = gs.Points(
        place,
        np.full((2 * n, 2), spacing / 2),
        area,
        DENSITY * area,
        np.zeros(2 * n, np.int32),
        stone,
    )
    velocity = np.zeros_like(place)
    velocity[n:, 0] = SPEED
    method = gs.Method(alpha=0.0, time_step=STEP)
    solver = gs.Solver(points, [law], cell=CELL, velocity=velocity, method=method)
    solver.advance(STEPS)
    return float(solver.velocity[:n, 0].mean() / SPEED)


def draw(gaps: FloatArray, soft: FloatArray, hard: FloatArray) -> Figure:
    """Momentum taken over the gap."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    ax.fill_between(
        gaps, soft.min(axis=1), soft.max(axis=1), alpha=0.3, label="deformable, all places"
    )
    ax.plot(gaps, soft.mean(axis=1), "C0o-", ms=4, label="deformable, mean")
    ax.plot(gaps, hard.max(axis=1), "C1s-", ms=4, label="rigid")
    for cells in (1, 2):
        ax.axvline(cells, color="k", linestyle=":", linewidth=0.8)
    ax.set(xlabel="gap between the stones (cells)", ylabel="momentum taken / all")
    ax.legend()
    return figure


MODE = Mode(
    name="near_stones",
    title="Stones closer than two cells",
    mechanism="All deformable materials share one velocity field. A node within a cell of both of "
    "two stones has the mean of their velocities, as if they were welded: they stick as they "
    "part, and push each other before they touch. A deformable stone so acts about a cell larger "
    "than it is, and two closer than two cells act as one.",
    source="Bardenhagen, Brackbill & Sulsky 2000, CMAME 187, 529",
    advice="Draw stones with `gap` of two cells and more, take a finer cell, or `gs.Rigid` "
    "stones, which have fields of their own.",
    run=run,
)
