"""Domains of cpGIMP that follow the stretch or the diagonal of the deformation gradient.

The inner points of a block are sheared, or turned as a whole: places and velocities are set anew
before each step, so that all see the same even motion. In a simple shear gamma the stretch
U = sqrt(F^T F) has the diagonal 2 / sqrt(4 + gamma^2) and (2 + gamma^2) / sqrt(4 + gamma^2), while
the soil in a slip band keeps its size. F_ii is the cosine of the angle of a rigid turn and vanishes
at 90 degrees. J^(1/2) is 1 in both.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import DomainUpdate
from ..check import Check
from . import rows
from .mode import Findings, Mode

SIDE, PER_SIDE = 15, 4  # of the block, cells; points a cell and direction
SHEAR = 5.0  # gamma
TURN = np.pi / 2
STEPS = {False: 500, True: 2000}
SOFT = gs.Elastic(1.0, 1e-9, 0.0)  # so that no stress moves anything
UPDATES: tuple[DomainUpdate, ...] = ("stretch", "deformation_diagonal", "jacobian")


def run(full: bool) -> Findings:
    """Shear and a quarter turn under the three updates."""
    steps = STEPS[full]
    shears = {update: domains(update, shearing(), SHEAR, steps) for update in UPDATES}
    turns = {update: domains(update, turning(), TURN, steps) for update in UPDATES}
    growth = 1 + TURN**2 / steps  # of (1 + a^2)^(n / 2), what a turn by steps 1 + dt L lengthens
    narrow, wide = 2 / np.sqrt(4 + SHEAR**2), (2 + SHEAR**2) / np.sqrt(4 + SHEAR**2)
    fails = [
        Check.near(
            f"stretch: {name} half-length after a shear of {SHEAR:g}, of the first",
            expected=float(expected),
            got=float(shears["stretch"][-1, axis]),
            within=1e-5,
            why="diagonal of U; steps of a shear add up exactly, the edge of the block reaches in",
        )
        for axis, (name, expected) in enumerate((("smaller", narrow), ("larger", wide)))
    ]
    fails.append(
        Check.at_most(
            "deformation_diagonal: smallest half-length in a turn by 90 degrees, of the first",
            bound=2 * TURN / steps,
            got=float(turns["deformation_diagonal"].min()),
            why="the cosine of 90 degrees, within two steps of it",
        )
    )
    stands = [
        Check.near(
            f"jacobian, the default of cpGIMP: half-length after {name}, of the first",
            expected=1.0,
            got=float(found["jacobian"][-1].max()),
            within=within,
            why=why,
        )
        for name, found, within, why in (
            ("the shear", shears, 1e-9, "a shear keeps the volume"),
            ("the turn", turns, growth - 1, "a turn does, but for the second order of its steps"),
        )
    ]
    stands.append(
        Check.near(
            "stretch: half-length after the turn, of the first",
            expected=1.0,
            got=float(turns["stretch"][-1].max()),
            within=growth - 1,
            why="U of a turn is one: the stretch fails in shear alone",
        )
    )
    return Findings(fails, stands, draw(shears, turns))


def shearing() -> FloatArray:
    """Velocity gradient of a simple shear at the rate 1."""
    return np.array([[0.0, 1.0], [0.0, 0.0]])


def turning() -> FloatArray:
    """Velocity gradient of a turn at the rate 1."""
    return np.array([[0.0, -1.0], [1.0, 0.0]])


def domains(update: DomainUpdate, gradient: FloatArray, end: float, steps: int) -> FloatArray:
    """Half-lengths of an inner point over its first ones, by steps, shape (steps + 1, 2); they end
    where the solver refuses them."""
    points = rows.points((SIDE, SIDE), PER_SIDE, (-SIDE / 2, -SIDE / 2))
    place, first = points.position, 0.5 / PER_SIDE
    velocity = place @ gradient.T
    method = gs.Method(
        shape="cpgimp", domain_update=update, alpha=0.0, time_step=end / steps, allow_unstable=True
    )
    solver = rows.solver(points, SOFT, method, row=False, velocity=velocity)
    middle = int(np.argmin((place**2).sum(axis=1)))
    found = [np.ones(2)]
    for _ in range(steps):
        solver.position, solver.velocity = place, velocity
        try:
            solver.step()
        except gs.Diverged:
            break
        found.append(solver.half_length[middle] / first)
    return np.array(found)


def draw(shears: dict[DomainUpdate, FloatArray], turns: dict[DomainUpdate, FloatArray]) -> Figure:
    """Half-lengths over shear and over angle."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for ax, found, end in ((left, shears, SHEAR), (right, turns, np.degrees(TURN))):
        for number, (update, values) in enumerate(found.items()):
            way = np.linspace(0, end, len(next(iter(found.values()))))[: len(values)]
            ax.plot(way, values[:, 0], f"C{number}-", label=f"{update}, x")
            ax.plot(way, values[:, 1], f"C{number}--", label=f"{update}, y")
    left.set(xlabel="shear $\\gamma$", ylabel="half-length / first")
    right.set(xlabel="angle of the turn (degrees)")
    left.legend(loc="upper left", fontsize=8)
    return figure


MODE = Mode(
    name="stretched_domains",
    title="Domains that follow shear and turns",
    mechanism="cpGIMP keeps its domains along the axes of the grid and must say how long a "
    "deformed domain is along them. The diagonal of the stretch grows without bound along a slip "
    "band, where soil is sheared but keeps its size, until a domain reaches over many cells; the "
    "diagonal of the deformation gradient vanishes where soil turns by 90 degrees. Both explode "
    "or collapse in a slide.",
    source="Coombs et al. 2020, CMAME 358, 112622",
    advice='With `shape="cpgimp"` keep `domain_update="jacobian"`, its default; "stretch" is for '
    "compression and extension without shear.",
    run=run,
)
