"""The loading stages: gravity grows, the slope settles, then it is let go and slides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from . import _check
from ._record import Record

Damping = Literal["kinetic", "local"]

_LOCAL_COEFFICIENT = 0.7


@dataclass(frozen=True)
class Gravity(Record):
    """First stage: gravity grows linearly from zero while all materials are elastic, under the
    damping of the second one.

    Parameters
    ----------
    ramp : time over which gravity grows, s, >= 0; 0 applies it at once

    Raises
    ------
    TypeError, ValueError
        If the ramp is not a finite number >= 0.
    """

    ramp: float = 0.5

    def __post_init__(self) -> None:
        self._store(ramp=_check.not_negative("ramp", self.ramp))


@dataclass(frozen=True)
class Settling(Record):
    """Second stage: damping brings the elastic slope to rest.

    Parameters
    ----------
    ratio : kinetic over potential energy below which the slope is at rest, in (0, 1)
    limit : time allowed for it, s, > 0; a slope not at rest by then is an error
    damping : "kinetic" (all velocities are set to zero whenever the kinetic energy has passed
        a peak) or "local" (each nodal force loses a share against the node's velocity)
    coefficient : that share, in (0, 1), for "local" only; None there: 0.7

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range, or a coefficient is given for
        kinetic damping, which has none.
    """

    ratio: float = 1e-6
    limit: float = 20.0
    damping: Damping = "kinetic"
    coefficient: float | None = None

    def __post_init__(self) -> None:
        self._store(
            ratio=_check.in_range("ratio", self.ratio, 0, 1, "()"),
            limit=_check.positive("limit", self.limit),
            damping=_check.one_of("damping", self.damping, get_args(Damping)),
        )
        if self.coefficient is None:
            return
        self._store(coefficient=_check.in_range("coefficient", self.coefficient, 0, 1, "()"))
        if self.damping != "local":
            raise ValueError(
                f"coefficient must be None unless damping is 'local', got {self.coefficient} "
                f"with damping {self.damping!r}"
            )

    def to_core(self) -> tuple[float, bool]:
        """The arguments of the compiled solver's `set_damping`: local coefficient, kinetic."""
        if self.damping == "kinetic":
            return 0.0, True
        return _LOCAL_COEFFICIENT if self.coefficient is None else self.coefficient, False


@dataclass(frozen=True)
class Slide(Record):
    """Last stage: plasticity is switched on, without damping; time counts from zero.

    It ends before its duration once the slope has been at rest for `rest_time`: the kinetic energy
    below `rest_ratio` times its peak, and the fastest point slower than `rest_speed`. At a single
    moment both may vanish in full swing.

    Parameters
    ----------
    duration : time simulated at most, s, > 0
    rest_ratio : in [0, 1); 0: the slide lasts its duration
    rest_speed : m/s, > 0; None: the kinetic energy alone says
    rest_time : s, >= 0; rows of energy are looked at, so that an interval between two may be added

    Raises
    ------
    TypeError, ValueError
        If a parameter is not a finite number in its range, or a speed is given without a ratio.
    """

    duration: float = 10.0
    rest_ratio: float = 0.0
    rest_speed: float | None = None
    rest_time: float = 0.1

    def __post_init__(self) -> None:
        self._store(
            duration=_check.positive("duration", self.duration),
            rest_ratio=_check.in_range("rest_ratio", self.rest_ratio, 0, 1, "[)"),
            rest_time=_check.not_negative("rest_time", self.rest_time),
        )
        if self.rest_speed is None:
            return
        self._store(rest_speed=_check.positive("rest_speed", self.rest_speed))
        if self.rest_ratio == 0:
            raise ValueError(
                f"rest_speed must be None unless rest_ratio is positive, got {self.rest_speed}"
            )

    def rests(self, kinetic: float, peak: float, max_speed: float) -> bool:
        """Whether a kinetic energy, beside its peak so far (J/m), and a largest speed (m/s) are
        those of a slope at rest."""
        slow = self.rest_speed is None or max_speed < self.rest_speed
        return slow and kinetic < self.rest_ratio * peak


@dataclass(frozen=True)
class Stages(Record):
    """The three stages, with the reference study's settings unless given.

    Raises
    ------
    TypeError
        If a stage is not of its class.
    """

    gravity: Gravity = Gravity()
    settling: Settling = Settling()
    slide: Slide = Slide()

    def __post_init__(self) -> None:
        _check.instance("gravity", self.gravity, Gravity, "a Gravity")
        _check.instance("settling", self.settling, Settling, "a Settling")
        _check.instance("slide", self.slide, Slide, "a Slide")
