"""The velocity blend on grids of any cell: as the viscosity that it acts as."""

from __future__ import annotations

from dataclasses import replace

from ..kernel import second_moment
from ..materials import Deformable
from ..method import Method
from ..scene import Scene

_FULLEST = 0.9


def held(scene: Scene, method: Method) -> Method:
    """The method with the viscosity that its blend has in a scene and at its step.

    A share of PIC a step, or a relaxation time, is another viscosity on every grid, and there would
    be no limit of the same problem. Transfers but "flip" have no blend, and stay.
    """
    kind, value = method.blend
    if kind == "viscosity" or method.transfer != "flip":
        return method
    share = value if kind == "alpha" else time_step(scene, method) / value
    viscosity = share * _moment(scene, method) / time_step(scene, method)
    return replace(method, alpha=None, relaxation_time=None, viscosity=viscosity)


def within_limits(scene: Scene, method: Method) -> Method:
    """The method with a Courant number so small that its viscosity needs no more than 0.9 of PIC,
    for more than all of it cannot be had; it matters on very fine grids."""
    if method.viscosity is None:
        return method
    kind, number = method.step
    assert kind == "courant"
    share = method.viscosity * time_step(scene, method) / _moment(scene, method)
    return method if share <= _FULLEST else replace(method, courant=number * _FULLEST / share)


def time_step(scene: Scene, method: Method) -> float:
    """The step at rest, s."""
    kind, value = method.step
    if kind == "fixed":
        return value
    fastest = max(m.wave_speed for m in scene.materials if isinstance(m, Deformable))
    return value * scene.cell / fastest


def _moment(scene: Scene, method: Method) -> float:
    return second_moment(method.shape, scene.spacing / 2, cell=scene.cell)
