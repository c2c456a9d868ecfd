"""The points of the slope of the tests of the solver, on a coarse grid."""

from __future__ import annotations

from typing import Any

import gimpslope as gs

G = 9.81
SOIL = gs.DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
SCENE = gs.Scene(gs.Outline.slope(), SOIL, cell=0.8)
N = SCENE.n_points


def floating(**options: Any) -> gs.Solver:
    """The points of the slope without walls."""
    return gs.Solver(SCENE.points, [SOIL.elastic()], cell=SCENE.cell, **options)
