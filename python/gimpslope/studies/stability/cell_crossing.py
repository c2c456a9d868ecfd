"""Points that cross a grid line carry their stress from one side of a node to the other at once.

What is carried is measured by the problem `translation` of `gimpslope verify`; here the jump of the
force at a node is set beside it for each shape function, and what comes of it in the column under
its own weight of the problem `column`.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape
from ..check import Check
from ..verify import column, translation
from .mode import Findings, Mode, Table

STEP = 2e-3  # between offsets at which the force is taken, cells
ALLOWED = 10 * STEP  # a force that bends but does not jump changes by so much at most


def run(full: bool) -> Findings:
    """The jump for every shape function; the column with linear hats and with GIMP."""
    offsets = np.arange(0, 4 if full else 1, STEP) * translation.CELL
    forces = {shape: force(shape, offsets) for shape in gs.kernel.shapes()}
    jumps = {shape: float(np.abs(np.diff(values)).max()) for shape, values in forces.items()}
    crossing = 2 * float(translation.SPACING[0]) / translation.CELL
    cells = 20 if full else 10
    errors = {
        shape: column.press(column.SOFT, cells, gs.Method(shape=shape)).error
        for shape in ("linear", "ugimp")
    }
    fails = [
        Check.near(
            "linear: jump of the force at a node, sigma A",
            expected=crossing,
            got=jumps["linear"],
            within=1e-9,
            why="a column of points crosses the node: 2 sigma s, to rounding",
        ),
        Check.at_least(
            f"linear: error of the stress, column of {cells} cells",
            bound=1.0,
            got=errors["linear"],
            why="off by the load itself; a plain 1D code: 2.8 with 10, 5.1 with 20",
        ),
    ]
    stands = [
        *(
            Check.at_most(
                f"{shape}: jump of the force at a node, sigma A",
                bound=ALLOWED,
                got=jump,
                why=f"its slopes are continuous: a step of {STEP:g} h changes it by little",
            )
            for shape, jump in jumps.items()
            if shape != "linear"
        ),
        Check.at_most(
            f"uGIMP: error of the stress, column of {cells} cells",
            bound=1.1 * column.PLAIN_1D["ugimp"][cells],
            got=errors["ugimp"],
            why="plain 1D code: two digits, other history, 10 %",
        ),
    ]
    listed: list[tuple[str | float, ...]] = [
        (shape, jump, crossing if shape == "linear" else 0.0) for shape, jump in jumps.items()
    ]
    columns = ("shape", "largest jump of the force, sigma A", "theory")
    return Findings(fails, stands, draw(offsets, forces), Table(columns, listed))


def force(shape: Shape, offsets: FloatArray) -> FloatArray:
    """At the node, sigma A, with domains that fill the block where points have such."""
    half_length = translation.SPACING / 2
    load = translation.STRESS * translation.CELL
    found: FloatArray = translation.force(offsets, shape, half_length) / load
    return found


def draw(offsets: FloatArray, forces: dict[Shape, FloatArray]) -> Figure:
    """The force at the node as the block passes."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for shape, values in forces.items():
        ax.plot(offsets / translation.CELL, values, linewidth=1.0, label=shape)
    ax.set(xlabel="way of the block (cells)", ylabel=r"force at a node / $\sigma A$")
    ax.legend(loc="upper right", ncols=2)
    return figure


MODE = Mode(
    name="cell_crossing",
    title="Cell crossing",
    mechanism="The slope of a linear hat changes its sign at the node. A point that crosses a "
    "grid line carries the force of its whole stress from one side of a node to the other in one "
    "step. The jump does not shrink with the step, and the kicks heat the body until it comes "
    "apart.",
    source="Steffen, Kirby & Berzins 2008, IJNME 76, 922; Bardenhagen & Kober 2004, CMES 5, 477",
    advice='Keep `Method(shape="ugimp")`, the default, or use "cpgimp" or splines; "linear" is for '
    "comparison and for motions of less than a cell.",
    run=run,
)
