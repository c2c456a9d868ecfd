"""What makes a run cheaper and hardly another: tried on the coarsest grid, and kept where it is so.

An error of the time step shrinks as the step does, and this as the cell: of what a saving changes
on the coarsest grid, a quarter is left on the third, which is the coarsest that a result may be of.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..setup import Setup
from ..stages import Gravity
from . import blend
from .pilot import Pilot, change, fly
from .target import Target

_SHARE = 0.2
"""Of the error asked for, what all savings together may cost."""

_ON_THE_THIRD = 1 / 4
_COURANT = 0.8


class Saving(NamedTuple):
    """A change of a setup, and what it has done to one."""

    apply: Callable[[Setup], Setup]
    told: Callable[[Setup], str]


def _gravity_at_once(setup: Setup) -> Setup:
    return replace(setup, stages=replace(setup.stages, gravity=Gravity(ramp=0.0)))


def _long_steps(setup: Setup) -> Setup:
    """Steps of the Courant number 0.8, or the largest one that the blend allows."""
    kind, number = setup.method.step
    assert kind == "courant"
    longer = blend.within_limits(setup.scene, replace(setup.method, courant=_COURANT))
    return setup if longer.step[1] <= number else replace(setup, method=longer)


SAVINGS = (
    Saving(_gravity_at_once, lambda _: "gravity is applied at once"),
    Saving(_long_steps, lambda setup: f"the Courant number is {setup.method.step[1]:.2g}"),
)


@dataclass(frozen=True)
class Saved:
    """The setup with the savings that are worth it.

    Attributes
    ----------
    setup : with them
    pilot : its run on the coarsest grid
    changes : share by which they change each quantity on the third grid
    reasons : a sentence each
    seconds : wall time of all that was tried, s
    """

    setup: Setup
    pilot: Pilot
    changes: dict[str, float]
    reasons: tuple[str, ...]
    seconds: float


def save(setup: Setup, target: Target, directory: Path) -> Saved:
    """Try each saving that changes the setup, on top of those before."""
    names = target.quantities
    plain = fly(setup, directory / "plain.h5", names)
    saved = Saved(setup, plain, dict.fromkeys(names, 0.0), (), plain.seconds)
    for number, saving in enumerate(SAVINGS):
        changed = saving.apply(saved.setup)
        if changed == saved.setup:
            continue
        pilot = fly(changed, directory / f"saving_{number}.h5", names)
        found = change(pilot, plain)
        changes = {name: _ON_THE_THIRD * size for name, size in found.items()}
        told = saving.told(changed)
        worst = float(np.max(list(changes.values())))  # NaN if one of them is
        if worst <= _SHARE * target.error:
            reason = f"{told}: that changes no quantity by more than {worst:.1g} of itself"
            saved = Saved(changed, pilot, changes, (*saved.reasons, reason), saved.seconds)
        else:
            known = math.isfinite(worst)
            size = f"by {worst:.1g} of itself" if known else "that is not reached, or 0"
            reason = f"not kept: {told}, which changes a quantity {size}"
            saved = replace(saved, reasons=(*saved.reasons, reason))
        saved = replace(saved, seconds=saved.seconds + pilot.seconds)
    return saved
