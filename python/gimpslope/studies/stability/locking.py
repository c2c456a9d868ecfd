"""Soil that cannot change its volume locks when each point has a volume strain of its own.

The strip footing on clay of `gimpslope verify`: the load should stay at (2 + pi) c.
"""

from __future__ import annotations

from ..verify import footing
from .mode import Findings, Mode


def run(full: bool) -> Findings:
    """With a volume strain a point and a cell."""
    outcome = footing.run(full)
    locks = [check for check in outcome.checks if check.quantity.startswith("point")]
    cured = [check for check in outcome.checks if check not in locks]
    return Findings(locks, cured, outcome.figure)


MODE = Mode(
    name="locking",
    title="Volumetric locking",
    mechanism="Soil that does not dilate keeps its volume as it flows. Four points a cell, each "
    "with a volume strain of its own, are more constraints than the nodes have freedom, so the "
    "soil is too stiff and its load rises without a limit. The mean stress takes up the "
    "constraints and forms a checkerboard.",
    source="Nagtegaal, Parks & Rice 1974, CMAME 4, 153; Hughes 1980, IJNME 15, 1413",
    advice='Leave `Method.volumetric_strain` as it is, or give "cell_average": strains are '
    'averaged over cells wherever a material yields. "point", as in most codes and in the '
    "study's own runs, locks.",
    run=run,
)
