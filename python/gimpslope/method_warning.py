"""Warnings of runs that enter a region where a method is known to fail.

Each names the mode of failure under which `gimpslope stability` measures and explains it.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from .analysis.islands import islands
from .kernel import second_moment, shape_functions
from .materials import Deformable, DruckerPrager
from .summary import smallest_gap

if TYPE_CHECKING:
    from .scene import Scene
    from .setup import Setup
    from .solver import Solver

SLUGGISH = 2e-3
"""Viscosity of a share alpha of PIC from which on it is warned of, in H sqrt(g H) for a slope of
height H. In slope A on cells of 0.2 m such a viscosity takes 7 % of the energy."""
CONE = 2.0
"""Difference, degrees, of the friction angle that a cone has in plane strain from that given."""
NEAR_LIMIT = 0.9
"""Time step over the longest stable one from which on it is warned of."""
NEAR_STONES = 2.0
"""Gap between stones, cells, below which deformable ones share nodes."""


class MethodWarning(UserWarning):
    """A run does what the method is known to do badly."""


def warn_at_start(setup: Setup, solver: Solver) -> None:
    """Warn of what the settings of a run and the first step of its solver tell."""
    step = solver.time_step
    _warn(_blend(setup, step), _cone(setup.scene), _near_stones(setup.scene))
    _warn(_step_limit(step / solver.stable_time_step))


def warn_at_end(setup: Setup, solver: Solver) -> None:
    """Warn of what the places of the points tell once the slide is over."""
    _warn(_fracture(setup, solver))


def _blend(setup: Setup, step: float) -> Iterator[str]:
    kind, alpha = setup.method.blend
    if setup.method.transfer != "flip" or kind != "alpha":
        return
    scene = setup.scene
    moment = second_moment(setup.method.shape, scene.spacing / 2, cell=scene.cell)
    viscosity = alpha * moment / step
    _, bottom, _, top = scene.outline.bounds
    height = top - bottom
    allowed = SLUGGISH * height * math.sqrt(scene.gravity * height)
    if viscosity > allowed:
        yield (
            f"blend: alpha = {alpha:g} acts as a viscosity of {viscosity:.2g} m2/s at a step of "
            f"{step:.2g} s, more than {allowed:.2g} = {SLUGGISH:g} H sqrt(g H): it slows the slide "
            "the more the shorter the step is; Method(viscosity=...) does not depend on it"
        )


def _cone(scene: Scene) -> Iterator[str]:
    soil = scene.soil
    if not isinstance(soil, DruckerPrager):
        return
    angle = soil.plane_strain_friction
    if angle is None:
        has = "never fails in plane strain"
    elif abs(angle - soil.friction) > CONE:
        has = f"has a friction angle of {angle:.1f} degrees in plane strain"
    else:
        return
    yield (
        f'cones: the cone "{soil.cone}" {has} where {soil.friction:g} are given; "plane_strain" '
        "meets the angle"
    )


def _near_stones(scene: Scene) -> Iterator[str]:
    kinds = scene.materials[1:]
    if not any(isinstance(kind, Deformable) for kind in kinds):
        return
    gap = smallest_gap(scene)
    if gap is not None and gap < NEAR_STONES:
        yield (
            f"near_stones: stones {gap:.2g} cells apart share nodes and stick together; a finer "
            "cell, a gap of two cells or rigid stones cure it"
        )


def _step_limit(share: float) -> Iterator[str]:
    if share > NEAR_LIMIT:
        yield f"step_limit: the time step is {share:.2g} of the longest stable one"


def _fracture(setup: Setup, solver: Solver) -> Iterator[str]:
    """Nodes that no point reaches but that others enclose are twice a point's reach wide."""
    scene, method = setup.scene, setup.method
    half_length = solver.half_length if method.has_domains else None
    reached = shape_functions(
        method.shape, solver.position, half_length, cell=scene.cell, origin=scene.origin
    )
    held = reached.nodes[reached.values > 0]
    low, high = held.min(axis=0), held.max(axis=0)
    rows = high[1] - low[1] + 1
    numbers = np.unique((held - low) @ (rows, 1))
    holes = len(islands(np.column_stack(np.divmod(numbers, rows))))
    if holes:
        yield (
            f"fracture: points drawn apart until they share no node have left {holes} "
            f"hole{'s' * (holes > 1)} in the soil, whatever its strength"
        )


def _warn(*messages: Iterator[str]) -> None:
    for each in messages:
        for message in each:
            text = f"{message} (`gimpslope stability {message.split(':')[0]}`)"
            warnings.warn(text, MethodWarning, stacklevel=_outside())


def _outside() -> int:
    """The level, counted from the caller, of the first frame that is not of this package."""
    frame, level = sys._getframe(1), 1
    while frame.f_globals["__name__"].split(".")[0] == "gimpslope" and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    return level
