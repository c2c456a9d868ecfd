"""From a scene to what is the same on every grid of a plan."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..energy import Energy
from ..method import Method
from ..recording import Recording
from ..scene import Scene
from ..setup import Setup
from ..stages import Slide, Stages
from . import blend, grids, stones

_RIGID_SHARE = 0.1
_PAST_THE_PEAK = 0.9
_FOR = 0.1  # s
_SNAPSHOTS = 50


@dataclass(frozen=True)
class Problem:
    """What is run, on any grid.

    Attributes
    ----------
    setup : on the coarsest grid
    reasons : what was chosen for all grids, and why
    """

    setup: Setup
    reasons: tuple[str, ...]

    def finer(self) -> Problem:
        """The same, with the next grid as the coarsest."""
        return replace(self, setup=self.on(1))

    def on(self, levels: int, setup: Setup | None = None) -> Setup:
        """The setup, or another one of the coarsest grid, with the cell halved so many times."""
        setup = setup or self.setup
        scene = grids.finer(setup.scene, levels)
        return replace(setup, scene=scene, method=blend.within_limits(scene, setup.method))


def pose(
    scene: Scene, error: float, method: Method, stages: Stages, *, until_rest: bool
) -> Problem:
    """The problem of a scene: blend held as a viscosity, stones rigid where they may be, the slide
    no longer than is needed for what is wanted to an `error`."""
    method = method.of(scene.materials)  # of those that are asked for, not of rigid ones
    held = blend.held(scene, method)
    reasons = []
    if held != method:
        kind, value = method.blend
        reasons.append(
            f"the blend of {kind} = {value:g} is held as a viscosity of {held.viscosity:.3g} m2/s, "
            f"that of a cell of {scene.cell:g} m, or each grid would be another problem"
        )
    if (method.precision, method.transfer, method.scheme) == ("double", "flip", "usf"):
        scene, why = stones.made_rigid(scene, _RIGID_SHARE * error)
        reasons += [why] if why else []
    slide = stages.slide
    if not until_rest:
        slide = past_the_peak(slide)
        reasons.append("the slide ends when its kinetic energy has passed its peak by a tenth")
    coarsest = grids.coarsest(scene)
    stepped = replace(held, time_step=None, courant=_courant(scene, held))
    return Problem(
        Setup(
            coarsest,
            blend.within_limits(coarsest, stepped),
            replace(stages, slide=slide),
            Recording(snapshot_interval=slide.duration / _SNAPSHOTS),
        ),
        tuple(reasons),
    )


def past_the_peak(slide: Slide) -> Slide:
    """A slide that ends when its kinetic energy has passed its peak."""
    return Slide(slide.duration, rest_ratio=_PAST_THE_PEAK, rest_time=_FOR)


def passed(energy: Energy) -> float:
    """When such a slide would have ended, s; its end where it has not."""
    top = energy.peak
    low = (energy.time > top.time) & (energy.kinetic < _PAST_THE_PEAK * top.value)
    return float(energy.time[low].min(initial=energy.time[-1] - _FOR)) + _FOR


def _courant(scene: Scene, method: Method) -> float:
    """The Courant number that a method has on the grid of the scene."""
    kind, value = method.step
    return value if kind == "courant" else value / blend.time_step(scene, Method(courant=1.0))
