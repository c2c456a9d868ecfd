"""Pictures of runs.

Functions draw into the Axes they are given, or a new one, and return it. `figures.study` makes the
figures of the reference study for several runs.
"""

from . import study
from .bars import displacement_bars, displacement_bars_by_run
from .curves import kinetic_energies, kinetic_energy, ledger
from .maps import displacement, map_of, plastic_zone, shape, speed
from .profiles import surfaces
from .single import PLASTIC_TIMES, SPEED_TIMES, write_figures

__all__ = [
    "PLASTIC_TIMES",
    "SPEED_TIMES",
    "displacement",
    "displacement_bars",
    "displacement_bars_by_run",
    "kinetic_energies",
    "kinetic_energy",
    "ledger",
    "map_of",
    "plastic_zone",
    "shape",
    "speed",
    "study",
    "surfaces",
    "write_figures",
]
