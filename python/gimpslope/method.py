"""The numerical method: shape functions, velocity blend and time step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

from . import _check, _core
from ._record import Record

Shape = str  # one of `gimpslope.kernel.shapes()`
Scheme = Literal["usf"]
DomainUpdate = Literal["jacobian", "stretch", "deformation_diagonal"]
VolumeUpdate = Literal["linear", "exponential"]
Precision = Literal["double", "single"]
VolumetricStrain = Literal["point", "cell_average"]

GIMP = ("ugimp", "cpgimp")
"""Shape functions of points that have domains."""


@dataclass(frozen=True)
class Method(Record):
    """How the motion is computed. Equation numbers are those of Front. Earth Sci. 2022, 10:968250.

    Parameters
    ----------
    shape : shape functions, one of `gimpslope.kernel.shapes()`: "linear" (plain MPM, eq. 8),
        "ugimp" (GIMP with the points' first domains, eqs. 14-16) or "cpgimp" (GIMP with domains
        that follow the deformation)
    scheme : order of the sub-steps: "usf" (stress first, eqs. 18-26)
    alpha : share of PIC in the velocity of a point per step, in [0, 1]: 0 is FLIP, 1 is PIC
        (eq. 26). Its effect grows as the step shrinks; the next two do not depend on the step
    viscosity : the blend as a kinematic viscosity nu, m2/s, >= 0:
        alpha = nu dt / (h2 (1/6 + lp2 / (3 h2))) for cell h and half-length lp of a point; the
        divisor is the second moment of the shape function
    relaxation_time : the blend as a time tau, s, > 0: alpha = dt / tau.
        At most one of alpha, viscosity and relaxation_time; with none alpha is 0.01, the study's
    courant : time step as a share of cell / (wave speed + speed of the points),
        in (0, 1], any positive number with `allow_unstable`
    time_step : fixed time step, s, > 0. At most one of courant and time_step; with none
        courant is 0.4
    domain_update : for "cpgimp" only: half-lengths scaled by "jacobian" J^(1/2), by the "stretch"
        U_ii or by the "deformation_diagonal" F_ii; None there: "jacobian"
    volume_update : factor of the volume in a step: "linear" 1 + tr(L) dt (eq. 23 with the trace
        of the strain rate) or "exponential" exp(tr(L) dt)
    volumetric_strain : of a point: its own, "point", or the mean over the points of its cell,
        "cell_average", with the mean stress in the forces to match: the mean dilatation of B-bar
        (Hughes 1980), against locking where the volume hardly changes, as in undrained clay. Not
        for large elastic motions: a point that crosses into another cell meets another mean stress.
        The mean is over all deformable materials in the cell
    precision : in which the points are stepped: "double", or "single", where places count from a
        node near each point, and the grid and all that is computed on the way stays in double.
        Their state is given out in double and kept beside. "single" tells what the digits are
        worth; it needs a quarter more memory, and measured no faster at any size
    threads : number of threads, >= 1; the result does not depend on it
    allow_unstable : accept a time step above the stable limit
    ledger : keep account of every joule (see `Ledger`); costs speed, changes nothing else

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range, or if two exclude each other.
    """

    shape: Shape = "ugimp"
    scheme: Scheme = "usf"
    alpha: float | None = None
    viscosity: float | None = None
    relaxation_time: float | None = None
    courant: float | None = None
    time_step: float | None = None
    domain_update: DomainUpdate | None = None
    volume_update: VolumeUpdate = "linear"
    volumetric_strain: VolumetricStrain = "point"
    precision: Precision = "double"
    threads: int = 1
    allow_unstable: bool = False
    ledger: bool = False

    def __post_init__(self) -> None:
        _check.one_of("shape", self.shape, _core.shapes())
        _check.one_of("scheme", self.scheme, get_args(Scheme))
        _check.one_of("volume_update", self.volume_update, get_args(VolumeUpdate))
        _check.one_of("volumetric_strain", self.volumetric_strain, get_args(VolumetricStrain))
        _check.one_of("precision", self.precision, get_args(Precision))
        self._store(
            threads=_check.whole("threads", self.threads, 1),
            allow_unstable=_check.flag("allow_unstable", self.allow_unstable),
            ledger=_check.flag("ledger", self.ledger),
        )
        self._check_domain_update()
        self._check_blend()
        self._check_step()

    @property
    def blend(self) -> tuple[str, float]:
        """What sets the velocity blend, and its value: ("alpha", 0.01) unless given."""
        return self._given("alpha", "viscosity", "relaxation_time") or ("alpha", 0.01)

    @property
    def step(self) -> tuple[str, float]:
        """What sets the time step, and its value: ("courant", number) or ("fixed", seconds)."""
        if self.time_step is not None:
            return "fixed", self.time_step
        return "courant", 0.4 if self.courant is None else self.courant

    @property
    def has_domains(self) -> bool:
        """Whether points have domains, over which GIMP averages the shape functions."""
        return self.shape in GIMP

    def to_core(self) -> dict[str, Any]:
        """The keyword arguments of the compiled solver that depend on the method."""
        default_update = "jacobian" if self.shape == "cpgimp" else "none"
        return {
            "shape": self.shape,
            "scheme": self.scheme,
            "blend": self.blend,
            "time_step": self.step,
            "domain_update": self.domain_update or default_update,
            "volume_update": self.volume_update,
            "volumetric_strain": self.volumetric_strain,
            "precision": self.precision,
            "threads": self.threads,
            "allow_unstable": self.allow_unstable,
            "ledger": self.ledger,
        }

    def _check_domain_update(self) -> None:
        if self.domain_update is None:
            return
        _check.one_of("domain_update", self.domain_update, get_args(DomainUpdate))
        if self.shape != "cpgimp":
            raise ValueError(
                f"domain_update must be None unless shape is 'cpgimp', got {self.domain_update!r} "
                f"with shape {self.shape!r}"
            )

    def _check_blend(self) -> None:
        if self.alpha is not None:
            self._store(alpha=_check.in_range("alpha", self.alpha, 0, 1))
        if self.viscosity is not None:
            self._store(viscosity=_check.not_negative("viscosity", self.viscosity))
        if self.relaxation_time is not None:
            self._store(relaxation_time=_check.positive("relaxation_time", self.relaxation_time))
        self._given("alpha", "viscosity", "relaxation_time")

    def _check_step(self) -> None:
        if self.time_step is not None:
            self._store(time_step=_check.positive("time_step", self.time_step))
        if self.courant is not None:
            self._store(courant=_check.positive("courant", self.courant))
        self._given("courant", "time_step")
        limit = _core.courant_limit
        if self.courant is not None and self.courant > limit and not self.allow_unstable:
            raise ValueError(
                f"courant must be a number in (0, {limit:g}] unless allow_unstable is set, "
                f"got {self.courant}"
            )

    def _given(self, *names: str) -> tuple[str, float] | None:
        """The one of the fields that is not None, with its value; refuses more than one."""
        given = [(name, getattr(self, name)) for name in names if getattr(self, name) is not None]
        if len(given) > 1:
            shown = ", ".join(f"{name}={value}" for name, value in given)
            raise ValueError(f"at most one of {', '.join(names)} must be given, got {shown}")
        return given[0] if given else None
