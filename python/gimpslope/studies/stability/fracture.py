"""Points that are drawn apart until no node is shared come apart, whatever their strength.

A row of points, `PER_CELL` a cell at first, has moved apart evenly and goes on doing so. Each
point should strain at the rate at which they part; a step of the kernel tells at which rate it
does. Where neighbours share no node any more, a node sees one velocity and the point strains not
at all. Neighbours share one up to a spacing of twice what a shape function reaches from its
point: 1 for linear hats, 1 + l for a domain of half-length l, 1.5 for quadratic splines, in cells.
Domains that follow the stretch, l = spacing / 2, always reach the neighbour.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape
from ...method_warning import TORN
from ..check import Check
from . import rows
from .mode import Findings, Mode, Table

PER_CELL = 2
LONGEST = 3.2  # spacing, cells
COUNT, EDGE = 24, 6  # points; those at either end that see where the row ends
RATE, STEP = 1e-6, 1e-3  # of the motion, 1 / time; s
NOTHING = 1e-9  # of the rate
REACH = {"linear": 1.0, "ugimp": 1.0 + 0.5 / PER_CELL, "quadratic_bspline": 1.5}  # cells
FOLLOWS = "cpgimp"
WIDEST = 2.5  # spacing up to which a domain follows: a kernel takes one of 3 cells at most


def run(full: bool) -> Findings:
    """The rate over the spacing, for each shape function."""
    spacings = np.arange(0.5, LONGEST, 0.025 if full else 0.1)
    rates = {shape: rate(shape, spacings) for shape in gs.kernel.shapes()}
    lost = {shape: broken(spacings, values) for shape, values in rates.items()}
    fails = [
        Check.near(
            f"{shape}: spacing from which on points part freely, cells",
            expected=2 * reach,
            got=lost[shape],
            within=1.5 * float(spacings[1] - spacings[0]),
            why="twice the reach of a point, within the step of the spacings looked at",
        )
        for shape, reach in REACH.items()
    ]
    fails.append(
        Check.at_most(
            f"ugimp: rate at a spacing of {TORN:g} cells, of the true one",
            bound=1 / 3,
            got=float(np.interp(TORN, spacings, rates["ugimp"])),
            why="most nodes between two points see one of them alone: a run warns of such holes",
        )
    )
    held = rates[FOLLOWS][spacings <= WIDEST]
    stands = [
        Check.at_least(
            f"{FOLLOWS} (not the default): smallest mean rate to {WIDEST:g} cells, of the true one",
            bound=0.1,
            got=float(held.min()),
            why="its domain follows: neighbours share a node however far they are",
        ),
        Check.near(
            "uGIMP, first spacing: rate over the true one",
            expected=1.0,
            got=float(rates["ugimp"][0]),
            within=1e-6,
            why="a linear motion of contiguous domains is reproduced",
        ),
    ]
    listed: list[tuple[str | float, ...]] = [
        (
            shape,
            lost[shape],
            2 * REACH[shape] if shape in REACH else "none",
            half(spacings, rates[shape]),
        )
        for shape in rates
    ]
    columns = (
        "shape",
        "spacing at which all is lost, cells",
        "theory",
        "at which half the rate is lost, cells",
    )
    return Findings(fails, stands, draw(spacings, rates), Table(columns, listed))


def rate(shape: Shape, spacings: FloatArray) -> FloatArray:
    """Mean over inner points and places of the strain rate over the true one, by spacing."""
    return np.array(
        [
            np.mean([_strained(shape, s, offset) for offset in np.arange(0.03, 1, 0.1)])
            for s in spacings
        ]
    )


def _strained(shape: Shape, spacing: float, offset: float) -> float:
    x = offset + spacing * np.arange(COUNT)
    place = np.column_stack([np.repeat(x, PER_CELL), np.tile(_levels(), COUNT)])
    n = len(place)
    across = 0.5 / PER_CELL
    domain = min(spacing, WIDEST) / 2 if shape == FOLLOWS else across
    area = np.full(n, 2 * across * spacing)
    points = gs.Points(
        place, np.tile([domain, across], (n, 1)), area, area, np.zeros(n, dtype=np.int32)
    )
    velocity = np.column_stack([RATE * place[:, 0], np.zeros(n)])
    method = gs.Method(shape=shape, alpha=0.0, time_step=STEP)
    solver = rows.solver(points, rows.material(), method, row=True, velocity=velocity)
    solver.step()
    inner = (place[:, 0] > x[EDGE]) & (place[:, 0] < x[-EDGE - 1])
    return float(solver.stress[inner, 0].mean() / (RATE * STEP))


def _levels() -> FloatArray:
    return (np.arange(PER_CELL) + 0.5) / PER_CELL


def broken(spacings: FloatArray, rates: FloatArray) -> float:
    """The first spacing from which on nothing is felt; infinite if there is none."""
    felt = np.flatnonzero(np.abs(rates) > NOTHING)
    return float(spacings[felt[-1] + 1]) if felt[-1] + 1 < len(spacings) else float("inf")


def half(spacings: FloatArray, rates: FloatArray) -> float:
    """The first spacing at which less than half of the rate is felt; infinite if there is none."""
    less = np.flatnonzero(rates < 0.5)
    return float(spacings[less[0]]) if len(less) else float("inf")


def draw(spacings: FloatArray, rates: dict[Shape, FloatArray]) -> Figure:
    """Rate over spacing."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for number, (shape, values) in enumerate(rates.items()):
        ax.plot(spacings, values, f"C{number}-", label=shape)
        if shape in REACH:
            ax.axvline(2 * REACH[shape], color=f"C{number}", linestyle=":", linewidth=0.8)
    ax.set(xlabel="spacing of the points (cells); dotted: 2 x reach", ylabel="strain rate / true")
    ax.legend(loc="lower left")
    return figure


MODE = Mode(
    name="fracture",
    title="Numerical fracture",
    mechanism="Points feel each other through the nodes that they share. Drawn apart to more than "
    "2 (h + l), 2.5 cells at two a cell, neighbours share none: they no longer strain or pull, "
    "and the body has come apart whatever its strength. Well before that nodes between them see "
    "one side only and the strain is too small.",
    source="Bardenhagen & Kober 2004, CMES 5, 477; Sadeghirad, Brannon & Burghardt 2011, IJNME 86, "
    "1435",
    advice="Holes and loose pieces in soil drawn out to five times its length are no cracks. Take "
    'more points a cell or `shape="cpgimp"` where extension matters; do not read the run-out of '
    "single points.",
    run=run,
)
