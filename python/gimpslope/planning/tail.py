"""How long a slide has to be followed: once it creeps, coarse grids tell how much is to come."""

from __future__ import annotations

import math
from typing import NamedTuple

from .pilot import Pilot

_SHARE = 0.1
_PAST_THE_PEAK = 1.5


class Tail(NamedTuple):
    """Where finer runs may end, and what is to come after.

    Attributes
    ----------
    time : s
    growth : by what each quantity grows from then to the end of the slide, a factor by name
    error : of that, as a share: what two pilots differ in it, or half of it if that is more
    """

    time: float
    growth: dict[str, float]
    error: dict[str, float]

    def extend(self, values: dict[str, float]) -> dict[str, float]:
        """Values of a run that ended early, as they would be in the end."""
        return {name: value * self.growth.get(name, 1.0) for name, value in values.items()}


NO_TAIL = Tail(math.inf, {}, {})
"""Of runs that end by themselves."""


def tail(before: Pilot, last: Pilot, error: float) -> Tail:
    """The earliest snapshot from which on two pilots tell the growth of all quantities to a tenth
    of the error asked for."""
    peak = last.run.energy.peak.time
    for time in last.history:
        if time < _PAST_THE_PEAK * peak or time >= last.reached or time not in before.history:
            continue
        growth, other = _growth(last, time), _growth(before, time)
        errors = {
            name: max(abs(factor - other[name]), abs(factor - 1) / 2)
            for name, factor in growth.items()
        }
        if all(size <= _SHARE * error for size in errors.values()):
            return Tail(time, growth, errors)
    return NO_TAIL


def _growth(pilot: Pilot, time: float) -> dict[str, float]:
    then = pilot.history[time]
    return {name: pilot.values[name] / value if value else math.inf for name, value in then.items()}
