"""Slopes of the study on finer and finer grids: what converges, at which order, to what, and at
what cost; slopes with stones with one or more models of these, whose limits are compared.

Everything else scales with the cell: the time step by the Courant number, the points by four a
cell; the viscosity of the velocity blend stays the same, which alpha a step would not.
"""

from .output import draw, write
from .plan import CELLS, CELLS_WITH_STONES, DURATION, Slope, plan
from .study import Convergence, converge
from .tables import markdown

__all__ = [
    "CELLS",
    "CELLS_WITH_STONES",
    "DURATION",
    "Convergence",
    "Slope",
    "converge",
    "draw",
    "markdown",
    "plan",
    "write",
]
