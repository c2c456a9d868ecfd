"""Patterns of velocity that no node sees: more points than nodes have motions that cancel there.

A free block gets such a pattern (from the singular value decomposition of its shape functions) and
nothing else. The grid stays at rest, nothing strains and no force arises: under FLIP the pattern
stays for good, under a share alpha of PIC it falls by 1 - alpha a step, and PIC, APIC and XPIC,
which take the velocity from the grid, drop it in one step.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from . import rows
from .mode import Findings, Mode

SIDE, PER_SIDE, OFFSET = 4, 2, 0.31  # of the block, cells; points; place on the grid, cells
SPEED, STEP = 1e-6, 0.4
STEPS = {False: 200, True: 1000}
ALPHA = 0.01  # the default
ZERO = 1e-20  # share of the energy that rounding leaves


def run(full: bool) -> Findings:
    """The energy of the pattern under each transfer."""
    steps = STEPS[full]
    kept = {name: decay(method, steps) for name, method in transfers().items()}
    law = (1 - ALPHA) ** (2 * steps)
    fails = [
        Check.near(
            f"FLIP: energy of the pattern after {steps} steps, of the first",
            expected=1.0,
            got=float(kept["FLIP"][-1]),
            within=1e-9,
            why="no node sees it, nothing takes it: rounding",
        )
    ]
    stands = [
        Check.near(
            f"alpha = {ALPHA:g}, the default: the same",
            expected=law,
            got=float(kept[f"alpha = {ALPHA:g}"][-1]),
            within=1e-6 * law,
            why="(1 - alpha)^(2 n)",
        ),
        *(
            Check.at_most(
                f"{name}: energy of the pattern after one step, of the first",
                bound=ZERO,
                got=float(values[1]),
                why="velocities come from the grid, which has none of it",
            )
            for name, values in kept.items()
            if name not in ("FLIP", f"alpha = {ALPHA:g}")
        ),
    ]
    return Findings(fails, stands, draw(kept))


def transfers() -> dict[str, gs.Method]:
    """The ways in which points take their velocities."""
    return {
        "FLIP": gs.Method(alpha=0.0, time_step=STEP),
        f"alpha = {ALPHA:g}": gs.Method(alpha=ALPHA, time_step=STEP),
        "PIC": gs.Method(alpha=1.0, time_step=STEP),
        "APIC": gs.Method(transfer="apic", time_step=STEP),
        **{f"XPIC({m})": gs.Method(transfer="xpic", order=m, time_step=STEP) for m in (2, 5)},
    }


def pattern(points: gs.Points) -> FloatArray:
    """Velocities with no image on the grid, of the largest speed SPEED, shape (n, 2)."""
    nodes, values, _ = gs.kernel.shape_functions(
        "ugimp", points.position, points.half_length, cell=1.0
    )
    _, number = np.unique(nodes.reshape(-1, 2), axis=0, return_inverse=True)
    dense = np.zeros((len(points), int(number.max()) + 1))
    np.add.at(dense, (np.arange(len(points))[:, None], number.reshape(values.shape)), values)
    held = dense.sum(axis=0) > 0
    _, sizes, across = np.linalg.svd(dense[:, held].T)
    unseen = across[np.sum(sizes > 1e-10 * sizes[0]) :]
    mixed = np.random.default_rng(1).standard_normal((2, len(unseen))) @ unseen
    found: FloatArray = SPEED * (mixed / np.abs(mixed).max()).T
    return found


def decay(method: gs.Method, steps: int) -> FloatArray:
    """Kinetic energy over the first by steps."""
    points = rows.points((SIDE, SIDE), PER_SIDE, (OFFSET, OFFSET))
    solver = rows.solver(points, rows.material(), method, row=False, velocity=pattern(points))
    energy = [solver.energies().kinetic]
    for _ in range(steps):
        solver.step()
        energy.append(solver.energies().kinetic)
    return np.array(energy) / energy[0]


def draw(kept: dict[str, FloatArray]) -> Figure:
    """Energy over steps."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    for name, values in kept.items():
        ax.semilogy(np.maximum(values, 1e-34), label=name)
    ax.set(xlabel="steps", ylabel="energy of the pattern / first", xlim=(0, 60))
    ax.legend(loc="center right")
    return figure


MODE = Mode(
    name="null_space",
    title="Ringing that no node sees",
    mechanism="There are more points than nodes, so some patterns of velocity cancel at every "
    "node. FLIP gives points the change of the nodes' velocities alone, so that what arises of "
    "such patterns at cell crossings and impacts stays for good and shows as noise in velocities "
    "and, once points have moved, in stresses. A share alpha of PIC takes it by 1 - alpha a "
    "step; PIC, APIC and XPIC take it at once, the last with little of anything else.",
    source="Brackbill 1988, J. Comput. Phys. 75, 469; Gritton & Berzins 2017, Comput. Part. Mech. "
    "4, 131; Hammerquist & Nairn 2017, CMAME 318, 724",
    advice="Keep a little PIC: the default, or better a `viscosity` (see `blend`). Do not read the "
    "velocity of a single point under `alpha=0`.",
    run=run,
)
