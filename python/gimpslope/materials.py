"""Materials: linear elasticity and Drucker-Prager plasticity, in plane strain, and rigid ones."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Literal, get_args

from . import _check, _core
from ._record import Record

Cone = Literal["outer", "inner", "plane_strain_associated", "plane_strain"]


@dataclass(frozen=True)
class Material(Record, ABC):
    """What every material has: a density.

    Not made by itself; see `Elastic`, `DruckerPrager` and `Rigid`. The compiled kernel checks the
    ranges and holds the formulas.
    """

    density: float

    def __post_init__(self) -> None:
        self._store(density=_check.finite("density", self.density))

    @abstractmethod
    def elastic(self) -> Material:
        """The same material without its yield surface, if it has one."""

    @abstractmethod
    def to_core(self) -> _core.Material:
        """The material as the compiled kernel takes it."""


@dataclass(frozen=True)
class Deformable(Material):
    """A material with isotropic elasticity; see `Elastic` and `DruckerPrager`."""

    young: float
    poisson: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self._store(
            young=_check.finite("young", self.young),
            poisson=_check.finite("poisson", self.poisson),
        )

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus K = E / (3 (1 - 2 nu)), Pa."""
        return self.to_core().bulk_modulus

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G = E / (2 (1 + nu)), Pa."""
        return self.to_core().shear_modulus

    @property
    def wave_speed(self) -> float:
        """Speed of pressure waves sqrt((K + 4 G / 3) / density), m/s."""
        return self.to_core().wave_speed

    def elastic(self) -> Elastic:
        """The same material without its yield surface, if it has one."""
        return Elastic(self.density, self.young, self.poisson)


@dataclass(frozen=True)
class Elastic(Deformable):
    """Linear elastic material.

    Parameters
    ----------
    density : kg/m3, > 0
    young : Young's modulus, Pa, > 0
    poisson : Poisson's ratio, in (-1, 0.5)

    Raises
    ------
    TypeError, ValueError
        If a parameter is not a finite number in its range.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        self.to_core()

    def to_core(self) -> _core.Material:
        """The material as the compiled kernel takes it."""
        return _core.Material(self.density, self.young, self.poisson)


@dataclass(frozen=True)
class DruckerPrager(Deformable):
    """Linear elastic, perfectly plastic material with the Drucker-Prager cone.

    It yields at sqrt(J2) + eta p = xi c and flows along the gradient of sqrt(J2) + etabar p, with
    p the mean stress, tension positive. The cone says how eta and xi follow from the friction
    angle phi. The reference study (Front. Earth Sci. 2022, 10:968250) does not name its cone.

    ========================= ================================= ================================
    cone                      eta                               xi
    ========================= ================================= ================================
    "outer"                   6 sin phi / (sqrt3 (3 - sin phi)) 6 cos phi / (sqrt3 (3 - sin phi))
    "inner"                   6 sin phi / (sqrt3 (3 + sin phi)) 6 cos phi / (sqrt3 (3 + sin phi))
    "plane_strain_associated" 3 tan phi / sqrt(9 + 12 tan2 phi) 3 / sqrt(9 + 12 tan2 phi)
    "plane_strain"            sin phi / D                       cos phi / D
    ========================= ================================= ================================

    The first two meet Mohr-Coulomb's corners of compression and extension, the third its collapse
    load in plane strain with associated flow (de Souza Neto, Peric & Owen 2008, section 6.4.4);
    for these etabar is eta with the dilation angle psi in place of phi. The fourth meets
    Mohr-Coulomb in plane strain with flow at the angle psi: etabar = 3 sin psi /
    sqrt(9 + 3 sin2 psi) and D = sqrt(1 - etabar2 / 3) + etabar sin phi / 3. With psi = phi it is
    the third.

    Parameters
    ----------
    density : kg/m3, > 0
    young : Young's modulus, Pa, > 0
    poisson : Poisson's ratio, in (-1, 0.5)
    friction : friction angle phi, degrees, in [0, 90)
    cohesion : c, Pa, >= 0; friction and cohesion may not both be zero
    dilation : dilation angle psi, degrees, in [0, friction]
    cone : one of the four names above
    tension_cutoff : largest mean stress, Pa, from 0 to the apex of the cone c / tan(phi);
        None: the apex

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type, not finite or out of its range.
    """

    friction: float
    cohesion: float
    dilation: float = 0.0
    cone: Cone = "plane_strain_associated"
    tension_cutoff: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._store(
            friction=_check.finite("friction", self.friction),
            cohesion=_check.finite("cohesion", self.cohesion),
            dilation=_check.finite("dilation", self.dilation),
            cone=_check.one_of("cone", self.cone, get_args(Cone)),
        )
        if self.tension_cutoff is not None:
            self._store(tension_cutoff=_check.finite("tension_cutoff", self.tension_cutoff))
        self.to_core()

    @property
    def cone_coefficients(self) -> tuple[float, float, float]:
        """eta, xi and etabar of the cone."""
        return self.to_core().cone_coefficients

    @property
    def plane_strain_friction(self) -> float | None:
        """Friction angle phi_e that the cone has at collapse in plane strain, degrees:
        sin phi_e = eta sqrt(1 - etabar^2 / 3) / (1 - eta etabar / 3), after de Souza Neto, Peric &
        Owen 2008, section 6.4.4. None where the cone has no collapse in plane strain."""
        eta, _, etabar = self.cone_coefficients
        sine = eta * math.sqrt(1 - etabar**2 / 3) / (1 - eta * etabar / 3)
        return math.degrees(math.asin(sine)) if sine < 1 else None

    @property
    def tension_limit(self) -> float:
        """Largest mean stress, Pa: the cut-off, or the apex c / tan(phi)."""
        return self.to_core().tension_limit

    def to_core(self) -> _core.Material:
        """The material as the compiled kernel takes it."""
        return _core.Material(
            self.density,
            self.young,
            self.poisson,
            law="drucker_prager",
            friction=self.friction,
            cohesion=self.cohesion,
            dilation=self.dilation,
            cone=self.cone,
            tension_cutoff=math.inf if self.tension_cutoff is None else self.tension_cutoff,
        )


@dataclass(frozen=True)
class Rigid(Material):
    """A material of stones that do not deform: each moves as one.

    A stone has a velocity field of its own. It holds the nodes of the grid in it and up to about
    half a cell around it: soil sticks to it there or, with a friction angle, slides along it and
    comes off it, and its momentum and angular momentum take up what the soil gives them. Walls push
    it with their friction, other rigid stones with the smaller of both frictions. No wave runs in
    it, so that the other materials set the time step alone. Of stones only, and in double precision
    only.

    Parameters
    ----------
    density : kg/m3, > 0
    friction : angle of friction along soil, which then comes off without a pull, degrees, in
        [0, 90); None: soil sticks to the stone
    mutual_friction : angle of friction along other rigid stones, degrees, in [0, 90); None:
        `friction`, and 0 where soil sticks

    Raises
    ------
    TypeError, ValueError
        If a parameter is not a finite number in its range.
    """

    friction: float | None = None
    mutual_friction: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("friction", "mutual_friction"):
            if (angle := getattr(self, name)) is not None:
                self._store(**{name: _check.finite(name, angle)})
        self.to_core()

    def elastic(self) -> Rigid:
        """Itself."""
        return self

    def to_core(self) -> _core.Material:
        """The material as the compiled kernel takes it."""
        mutual = self.friction if self.mutual_friction is None else self.mutual_friction
        return _core.Material(
            self.density,
            law="rigid",
            interface_friction=self.friction,
            mutual_friction=0.0 if mutual is None else mutual,
        )
