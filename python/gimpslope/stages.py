"""The loading stages: gravity grows, the slope settles, then it is let go and slides."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

from . import _check
from ._record import Record

Damping = Literal["kinetic", "local"]

_LOCAL_COEFFICIENT = 0.7
_UNBALANCED = 2e-3
_KINETIC_RATIO = 1e-6
_COURANT = 0.9
_OPTIONAL = {"ratio": "()", "unbalanced": "()", "coefficient": "()", "courant": "(]"}


@dataclass(frozen=True)
class Gravity(Record):
    """First stage: gravity grows linearly from zero while all materials are elastic, under the
    damping of the second one.

    Parameters
    ----------
    ramp : time over which gravity grows, s, >= 0; 0 applies it at once, which overshoots and
        leaves other friction on Coulomb walls: 1 % in the time of the peak of slope A at 0.1 m

    Raises
    ------
    TypeError, ValueError
        If the ramp is not a finite number >= 0.
    """

    ramp: float = 0.2

    def __post_init__(self) -> None:
        self._store(ramp=_check.not_negative("ramp", self.ramp))


@dataclass(frozen=True)
class Settling(Record):
    """Second stage: damping brings the elastic slope to rest.

    Each criterion that is given must hold. Where none is, it is `unbalanced` = 2e-3 with kinetic
    damping, `ratio` = 1e-6 with local. The first asks for a static solution, whose time means
    nothing: it takes the longest steps. `Gravity(0.5)` with `Settling(ratio=1e-6)` is loading in
    time; it takes two to six times as many steps, and the slide that follows has the same figures
    to 0.5 %.

    Parameters
    ----------
    ratio : kinetic over potential energy that is at rest, in (0, 1); the slope must stay below it
        for as long as a pressure wave needs to cross the scene twice
    limit : time allowed for it, s, > 0; a slope not at rest by then is an error
    damping : "kinetic" (all velocities are set to zero whenever the kinetic energy has passed
        a peak; Cundall 1976) or "local" (each nodal force loses a share against the node's
        velocity)
    coefficient : that share, in (0, 1), for "local" only; None there: 0.7
    unbalanced : sum of the sizes of the forces left at the nodes over the weight, in (0, 1), when
        kinetic damping has stopped all motion
    courant : Courant number of gravity and settling, in (0, 1]; None: 0.9 with `unbalanced`,
        without the step of the method. It gives way to a velocity blend of more than a half

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range, a coefficient is given for kinetic
        damping, which has none, or `unbalanced` for local, which does not stop.
    """

    ratio: float | None = None
    limit: float = 20.0
    damping: Damping = "kinetic"
    coefficient: float | None = None
    unbalanced: float | None = None
    courant: float | None = None

    def __post_init__(self) -> None:
        self._store(
            limit=_check.positive("limit", self.limit),
            damping=_check.one_of("damping", self.damping, get_args(Damping)),
        )
        if self.ratio is None and self.unbalanced is None:
            kinetic = self.damping == "kinetic"
            self._store(**{"unbalanced": _UNBALANCED} if kinetic else {"ratio": _KINETIC_RATIO})
        if self.unbalanced is not None and self.courant is None:
            self._store(courant=_COURANT)
        for name, ends in _OPTIONAL.items():
            if (value := getattr(self, name)) is not None:
                self._store(**{name: _check.in_range(name, value, 0, 1, ends)})
        for name, damping in (("coefficient", "local"), ("unbalanced", "kinetic")):
            value = getattr(self, name)
            if value is not None and self.damping != damping:
                raise ValueError(
                    f"{name} must be None unless damping is {damping!r}, got {value} "
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
    below `rest_ratio` times its peak, the fastest point slower than `rest_speed`, and no figure of
    it about to change by more than `rest_change`. At a single moment energy and speed may vanish in
    full swing; and where both are small a front may creep on, held back by the viscosity of the
    velocity blend alone, long enough to count.

    Parameters
    ----------
    duration : time simulated at most, s, > 0
    rest_ratio : in [0, 1); 0: the slide lasts its duration
    rest_speed : m/s, > 0; None: is not asked for
    rest_time : s, >= 0; rows of energy are looked at, so that an interval between two may be added
    rest_change : in (0, 1), with a `rest_time` > 0; how much of itself each of the largest
        displacements (in all, sideways, up or down) and the run-out would change by in the rest of
        the duration, at the mean rate of the last `rest_time`; None: is not asked for

    Raises
    ------
    TypeError, ValueError
        If a parameter is not a finite number in its range, or a speed or change is given without a
        ratio.
    """

    duration: float = 10.0
    rest_ratio: float = 0.0
    rest_speed: float | None = None
    rest_time: float = 0.1
    rest_change: float | None = None

    def __post_init__(self) -> None:
        self._store(
            duration=_check.positive("duration", self.duration),
            rest_ratio=_check.in_range("rest_ratio", self.rest_ratio, 0, 1, "[)"),
            rest_time=_check.not_negative("rest_time", self.rest_time),
        )
        if self.rest_speed is not None:
            self._store(rest_speed=_check.positive("rest_speed", self.rest_speed))
        if self.rest_change is not None:
            change = _check.in_range("rest_change", self.rest_change, 0, 1, "()")
            self._store(rest_change=change, rest_time=_check.positive("rest_time", self.rest_time))
        for name in ("rest_speed", "rest_change"):
            value = getattr(self, name)
            if value is not None and self.rest_ratio == 0:
                raise ValueError(f"{name} must be None unless rest_ratio is positive, got {value}")

    def until_rest(self) -> Slide:
        """This slide, which ends when the kinetic energy is below a hundredth of its peak and no
        figure would change by more than 0.2 % until its duration is over, by the last half second.

        On the study's slopes with rigid stones at 0.2 m, and slope A at 0.1 m, each figure is then
        within 0.2 % of its value after the full 10 s. `literal` slides end between 5.6 and 6.1 s.
        In `identified` the fronts creep on, and it takes 9 to 10 s.
        """
        return replace(self, rest_ratio=1e-2, rest_speed=None, rest_time=0.5, rest_change=2e-3)

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
