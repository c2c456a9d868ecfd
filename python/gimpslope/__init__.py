"""Landslides of soil-rock slopes with the generalized interpolation material point method.

A scene (outline, materials, walls) is simulated through its loading stages by a compiled kernel,
and the run file is opened for analysis:

>>> import gimpslope as gs
>>> soil = gs.DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
>>> scene = gs.Scene(gs.Outline.slope(height=9, crest=2, angle=45), soil, cell=0.1)
>>> run = gs.simulate(scene, duration=10, output="soil.h5")  # doctest: +SKIP
>>> run.energy.plot()  # doctest: +SKIP

Angles are in degrees, everything else in SI units.
"""

from importlib.metadata import version

from . import kernel, stones
from .ledger import Ledger
from .materials import DruckerPrager, Elastic, Material, Rigid
from .method import Method
from .method_warning import MethodWarning
from .outline import Outline
from .planning import Answer, Plan, plan
from .recording import Recording
from .run import Run, open
from .scene import Points, Scene
from .scene_file import load
from .setup import Setup
from .simulation import NotSettledError, simulate
from .solver import Diverged, Energies, Solver
from .stages import Gravity, Settling, Slide, Stages
from .stones import Ellipse, Stone, Stones
from .walls import Coulomb, Fixed, Free, Roller, Walls

__version__ = version("gimpslope")

__all__ = [
    "Answer",
    "Coulomb",
    "Diverged",
    "DruckerPrager",
    "Elastic",
    "Ellipse",
    "Energies",
    "Fixed",
    "Free",
    "Gravity",
    "Ledger",
    "Material",
    "Method",
    "MethodWarning",
    "NotSettledError",
    "Outline",
    "Plan",
    "Points",
    "Recording",
    "Rigid",
    "Roller",
    "Run",
    "Scene",
    "Settling",
    "Setup",
    "Slide",
    "Solver",
    "Stages",
    "Stone",
    "Stones",
    "Walls",
    "kernel",
    "load",
    "open",
    "plan",
    "simulate",
    "stones",
]
