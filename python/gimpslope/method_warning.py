"""Warnings of runs that enter a region where a method is known to fail.

Each names the mode of failure under which `gimpslope stability` measures and explains it, but for
that of impulses on rigid stones, which tells all that is known.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING

from .analysis.holes import holes
from .kernel import second_moment
from .materials import Deformable, DruckerPrager
from .method import Method
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
NEAR_LIMIT_OF_USL = 0.45
NEAR_LIMIT_OF_LINEAR_USL = 0.15
"""The same with USL, whose limit at the worst place of evenly spaced points is 0.46, and 0.16 with
linear hats."""
TORN = 2.0
"""Width of a hole, cells, from which on it is warned of. Points so far apart feel less than a third
of the rate at which they part, with uGIMP, and from 2.5 on nothing (two a cell and direction)."""
NEAR_STONES = 2.0
"""Gap between stones, cells, below which deformable ones share nodes."""

UNSETTLED = 0.1
"""Cells that the last changes by impulses which did not settle come to, from which on it is warned
of them; the edges of stones and soil are known no better."""


class MethodWarning(UserWarning):
    """A run does what the method is known to do badly."""


def warn_at_start(setup: Setup, solver: Solver) -> None:
    """Warn of what the settings of a run and the first step of its solver tell."""
    step = solver.time_step
    _warn(_blend(setup, step), _cone(setup.scene), _near_stones(setup.scene))
    _warn(_step_limit(setup.method, step / solver.stable_time_step))


def warn_at_end(setup: Setup, solver: Solver) -> None:
    """Warn of what the places of the points and the impulses on rigid stones tell once the slide is
    over."""
    _warn(_fracture(setup.scene, solver))
    _warn(_unsettled(setup.scene, solver), page=False)


def _blend(setup: Setup, step: float) -> Iterator[str]:
    kind, alpha = setup.method.blend
    if kind != "alpha" or setup.method.transfer != "flip":
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


def _step_limit(method: Method, share: float) -> Iterator[str]:
    of_usl = NEAR_LIMIT_OF_LINEAR_USL if method.shape == "linear" else NEAR_LIMIT_OF_USL
    if method.scheme == "usl" and share > of_usl:
        yield (
            f"small_masses: USL at {share:.2g} of the longest stable step of USF may be unstable "
            'where nodes hold little mass; Method(scheme="musl") is not'
        )
    elif share > NEAR_LIMIT:
        yield f"step_limit: the time step is {share:.2g} of the longest stable one"


def _fracture(scene: Scene, solver: Solver) -> Iterator[str]:
    count = holes(solver.position, TORN * scene.cell / 2)
    if count:
        yield (
            f"fracture: {count} hole{'s' * (count > 1)} wider than {TORN:g} cells, across which "
            "points hardly feel each other: the grid has torn the soil, whatever its strength"
        )


def _unsettled(scene: Scene, solver: Solver) -> Iterator[str]:
    where = {"interfaces": "soil slides along rigid stones", "contacts": "rigid stones touch"}
    cure = {"interfaces": "heavier stones", "contacts": "fewer stones on top of each other"}
    for name, found in solver.unsettled.items():
        if found.sum > UNSETTLED * scene.cell:
            yield (
                f"in {found.steps:,} of {solver.steps:,} steps the impulses where {where[name]} "
                f"did not settle: their last changes alone come to {found.sum / scene.cell:.2g} "
                f"cells; {cure[name]} settle sooner"
            )


def _warn(*messages: Iterator[str], page: bool = True) -> None:
    for each in messages:
        for message in each:
            named = f" (`gimpslope stability {message.split(':')[0]}`)" if page else ""
            text = f"{message}{named}"
            warnings.warn(text, MethodWarning, stacklevel=_outside())


def _outside() -> int:
    """The level, counted from the caller, of the first frame that is not of this package."""
    frame, level = sys._getframe(1), 1
    while frame.f_globals["__name__"].split(".")[0] == "gimpslope" and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    return level
