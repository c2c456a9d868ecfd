"""The numerical method: shape functions, scheme, transfer of velocities and time step."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

from . import _check, _core
from ._record import Record
from .materials import DruckerPrager, Material

Shape = str  # one of `gimpslope.kernel.shapes()`
Scheme = Literal["usf", "usl", "musl"]
Transfer = Literal["flip", "apic", "xpic"]
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
        "ugimp" (GIMP with the points' first domains, eqs. 14-16), "cpgimp" (GIMP with domains
        that follow the deformation) or "quadratic_bspline" (Steffen, Kirby and Berzins 2008, IJNME
        76:922). A spline's nodes go on beyond a free surface; behind a wall the node goes on in
        line with the two before it, which leaves hats in the half cell at the wall (Steffen,
        Wallstedt, Guilkey, Kirby and Berzins 2008, CMES 31:107)
    scheme : order of the sub-steps: "usf" (stress first, eqs. 18-26), "usl" (stress last, from the
        velocities that the nodes have come to; Sulsky, Chen and Schreyer 1994, CMAME 118:179) or
        "musl" (stress last, from those that the points bring back to the nodes; Sulsky, Zhou and
        Schreyer 1995, CPC 87:236). "usl" is unstable where nodes hold little mass (Bardenhagen
        2002, JCP 180:383). With rigid stones "usf" alone
    transfer : how points take their velocities from the nodes: "flip" (FLIP with a share of PIC,
        the next three), "apic" (affine PIC, with which points carry the linear part of the motion
        around them and keep angular momentum; Jiang and others 2015, ACM Trans. Graph. 34:51; not
        with shape "linear", whose second moment vanishes at the nodes) or "xpic" (PIC that leaves
        out the noise that no node sees and, the higher its order, the less else; Hammerquist and
        Nairn 2017, CMAME 318:724). "apic" and "xpic" act in full in every step, however short. With
        rigid stones "flip" alone
    order : of "xpic", in [1, 100], where 1 is PIC and each more costs a sweep over the points;
        None there: 2
    alpha : share of PIC in the velocity of a point per step, in [0, 1]: 0 is FLIP, 1 is PIC
        (eq. 26). Its effect grows as the step shrinks; the next two do not depend on the step
    viscosity : the blend as a kinematic viscosity nu, m2/s, >= 0:
        alpha = nu dt / (h2 (1/6 + lp2 / (3 h2))) for cell h and half-length lp of a point; the
        divisor is the second moment of the shape function
    relaxation_time : the blend as a time tau, s, > 0: alpha = dt / tau.
        At most one of alpha, viscosity and relaxation_time, with transfer "flip" alone; with none
        alpha is 0.01, the study's
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
        (Hughes 1980), against locking where the volume hardly changes, as in soil that flows. Not
        for large elastic motions: a point that crosses into another cell meets another mean stress.
        The mean is over all deformable materials in the cell; a step takes 1.6 times as long.
        None: "cell_average" where any material of the scene yields, else "point"; `gimpslope
        tradeoff` shows that this pays
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
    transfer: Transfer = "flip"
    order: int | None = None
    alpha: float | None = None
    viscosity: float | None = None
    relaxation_time: float | None = None
    courant: float | None = None
    time_step: float | None = None
    domain_update: DomainUpdate | None = None
    volume_update: VolumeUpdate = "linear"
    volumetric_strain: VolumetricStrain | None = None
    precision: Precision = "double"
    threads: int = 1
    allow_unstable: bool = False
    ledger: bool = False

    def __post_init__(self) -> None:
        _check.one_of("shape", self.shape, _core.shapes())
        _check.one_of("scheme", self.scheme, get_args(Scheme))
        _check.one_of("transfer", self.transfer, get_args(Transfer))
        _check.one_of("volume_update", self.volume_update, get_args(VolumeUpdate))
        if self.volumetric_strain is not None:
            _check.one_of("volumetric_strain", self.volumetric_strain, get_args(VolumetricStrain))
        _check.one_of("precision", self.precision, get_args(Precision))
        self._store(
            threads=_check.whole("threads", self.threads, 1),
            allow_unstable=_check.flag("allow_unstable", self.allow_unstable),
            ledger=_check.flag("ledger", self.ledger),
        )
        self._check_domain_update()
        self._check_transfer()
        self._check_blend()
        self._check_step()

    @property
    def blend(self) -> tuple[str, float]:
        """What sets the velocity blend, and its value: ("alpha", 0.01) unless given, and
        ("alpha", 1.0) with any transfer but "flip"."""
        if self.transfer != "flip":
            return "alpha", 1.0
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

    def of(self, materials: Iterable[Material]) -> Method:
        """The method with what it leaves to the materials of a scene: volumetric_strain."""
        if self.volumetric_strain is not None:
            return self
        yields = any(isinstance(material, DruckerPrager) for material in materials)
        return replace(self, volumetric_strain="cell_average" if yields else "point")

    def to_core(self) -> dict[str, Any]:
        """The keyword arguments of the compiled solver that depend on the method."""
        default_update = "jacobian" if self.shape == "cpgimp" else "none"
        return {
            "shape": self.shape,
            "scheme": self.scheme,
            "transfer": self.transfer,
            "order": self.order or (2 if self.transfer == "xpic" else 1),
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

    def _check_transfer(self) -> None:
        if self.transfer == "apic" and self.shape == "linear":
            raise ValueError(
                "transfer must be 'flip' or 'xpic' with shape 'linear', whose second moment "
                "vanishes at the nodes, got 'apic'"
            )
        if self.order is None:
            return
        self._store(order=_check.whole("order", self.order, 1))
        if self.transfer != "xpic":
            raise ValueError(
                f"order must be None unless transfer is 'xpic', got {self.order} "
                f"with transfer {self.transfer!r}"
            )
        if self.order > _core.highest_order:
            raise ValueError(f"order must be at most {_core.highest_order}, got {self.order}")

    def _check_blend(self) -> None:
        if self.alpha is not None:
            self._store(alpha=_check.in_range("alpha", self.alpha, 0, 1))
        if self.viscosity is not None:
            self._store(viscosity=_check.not_negative("viscosity", self.viscosity))
        if self.relaxation_time is not None:
            self._store(relaxation_time=_check.positive("relaxation_time", self.relaxation_time))
        given = self._given("alpha", "viscosity", "relaxation_time")
        if given and self.transfer != "flip":
            name, value = given
            raise ValueError(
                f"{name} must be None unless transfer is 'flip', got {value} "
                f"with transfer {self.transfer!r}"
            )

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
