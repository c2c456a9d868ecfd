"""Stresses that are turned to first order in the spin grow with every turn.

Measured by the problem `shear` of `gimpslope verify`: one rigid turn of a stressed point in the
kernel, and by the update s + dt (w s - s w) that many codes have. This lengthens a deviator that
it turns by the angle a by sqrt(1 + 4 a^2) a step, (1 + 16 pi^2 / n^2)^(n / 2) in a turn of n steps.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..check import Check
from ..verify import shear
from .mode import Findings, Mode, Table


def run(full: bool) -> Findings:
    """One turn in 100 to 10,000 steps; in full in 100,000 as well."""
    steps = [*shear.PUBLISHED, 100_000] if full else list(shear.PUBLISHED)
    start = shear.deviator(shear.FIRST)
    first_order = {n: shear.deviator(shear.turned_at_first_order(n)) / start for n in steps}
    exact = {n: float(np.abs(shear.turned(n) - shear.FIRST).max()) / start for n in steps}
    fails = [
        Check.near(
            f"first order: deviator after a turn in {n} steps, of the first",
            expected=growth(n),
            got=got,
            within=1e-9 * growth(n),
            why="(1 + 16 pi^2 / n^2)^(n / 2), to rounding; published 2.19, 1.082, 1.0079",
        )
        for n, got in first_order.items()
    ]
    stands = [
        Check.at_most(
            "kernel: change of the stress in a turn, of the deviator",
            bound=1e-11,
            got=max(exact.values()),
            why="exact rotation: rounding of at most 100,000 steps",
        )
    ]
    listed: list[tuple[str | float, ...]] = [
        (n, first_order[n], growth(n), 1 + exact[n]) for n in steps
    ]
    columns = ("steps a turn", "first order, of the first deviator", "theory", "kernel, at most")
    return Findings(fails, stands, draw(first_order, exact), Table(columns, listed))


def growth(steps: int) -> float:
    """Of the deviator in a turn, to first order in the spin."""
    return float((1 + 16 * np.pi**2 / steps**2) ** (steps / 2))


def draw(first_order: dict[int, float], exact: dict[int, float]) -> Figure:
    """Error of the deviator after a turn over steps."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    steps = np.array(list(first_order))
    ax.loglog(steps, [growth(int(n)) - 1 for n in steps], "k-", linewidth=0.8, label="theory")
    ax.loglog(
        steps, np.array(list(first_order.values())) - 1, "C3^", label="first order in the spin"
    )
    ax.loglog(steps, list(exact.values()), "C0o", label="kernel")
    ax.set(xlabel="steps a turn", ylabel="error of the deviator")
    ax.legend()
    return figure


MODE = Mode(
    name="spin",
    title="Spin to first order",
    mechanism="The Jaumann rate turns the stress with the material. Adding dt (w s - s w) moves "
    "it along the tangent of its circle, so that every step lengthens the deviator, by the "
    "square of the angle. The energy of it is made from nothing; smaller steps make it less, but "
    "no step makes it none.",
    source="Hughes & Winget 1980, IJNME 15, 1862; Jaumann rate: Front. Earth Sci. 2022, 10:968250, "
    "eq. 24",
    advice="Nothing: the kernel turns stresses by the exact rotation. In another code hold one "
    "turn against these numbers.",
    run=run,
)
