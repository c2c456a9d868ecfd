"""The reference study: "Modeling of soil-rock mixture landslides with the generalized interpolation
material point method", Frontiers in Earth Science 2022, 10:968250.

The paper leaves out its outline, its cone and the details of its walls, and its labels of
horizontal and vertical displacement are swapped: a point of the crest cannot drop by 8.9 m and move
5.4 m sideways. Two readings are offered; neither is tuned further.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

from .. import _check
from ..materials import Cone, DruckerPrager, Material, Rigid
from ..method import Method, Precision, VolumetricStrain
from ..outline import Outline
from ..recording import Recording
from ..scene import Scene
from ..setup import Setup
from ..stages import Slide, Stages
from ..walls import Coulomb, Fixed, Roller, Walls
from . import reference_stones


@dataclass(frozen=True)
class Reading:
    """What the paper leaves open: the cone, the walls, and the strength of its velocity blend.

    The paper blends by alpha = 0.01 a step, which acts as a viscosity that depends on the step;
    here it is given as that viscosity, m2/s.
    """

    cone: Cone
    walls: Walls
    viscosity: float


READINGS = MappingProxyType(
    {
        "identified": Reading("plane_strain_associated", Walls(Fixed(), bottom=Fixed()), 0.5625),
        "literal": Reading("outer", Walls(Roller(), bottom=Coulomb(0.2)), 0.094),
    }
)
"""`identified` meets all of the paper's figures of slope A; `literal` takes its words for it."""

SLOPES = MappingProxyType({"soil": "A", "arbitrary": "B", "round": "C", "oval": "D"})
"""The slopes, and the letters that the paper gives them."""

PAPER = MappingProxyType(
    {
        "soil": {
            "time_of_peak": 1.6,
            "speed_at_peak": 3.0,
            "max_displacement_total": 9.3,
            "max_displacement_horizontal": 8.9,
            "max_displacement_vertical": 5.4,
        },
        "arbitrary": {"time_of_peak": 2.0, "max_displacement_total": 8.7},
        "round": {"time_of_peak": 1.5},
        "oval": {"time_of_peak": 1.8},
    }
)
"""The paper's figures for each slope, in SI units by the names of a run's summary, with the labels
of horizontal and vertical displacement put right."""

LOWER_BOUNDS = frozenset({"speed_at_peak"})
"""Of these the paper says what they exceed: the speed of slope A is "exceeding 3 m/s"."""

STONE_MODULI = MappingProxyType({"deformable": 20e9, "softened": 0.5e9})
STONE_MODELS = (*STONE_MODULI, "rigid")
"""How stones are modelled: as the paper has them; with a Young's modulus (Pa) so low that the step
may be six times longer; and not deforming at all."""

_ROCK_DENSITY = 2400.0  # kg/m3

VOLUMETRIC_STRAIN: VolumetricStrain = "point"
"""The paper's, on whose grids soil locks; `Method` leaves it to the material."""

RECORDING = Recording(
    snapshot_times=(0.5, 1.0, *(round(1.4 + 0.05 * k, 2) for k in range(15)), 3.5, 5.0, 10.0)
)
"""With the times of the paper's maps; a peak between 1.4 and 2.1 s is met to a fortieth of a
second."""


def soil(reading: str = "identified") -> DruckerPrager:
    """The soil of the paper's table 1."""
    return DruckerPrager(
        density=1800,
        young=30e6,
        poisson=0.33,
        friction=22,
        cohesion=1e3,
        cone=_reading(reading).cone,
    )


def rock(
    reading: str = "identified",
    model: str = "deformable",
    modulus: float | None = None,
    friction: float | None = None,
) -> Material:
    """The stone of the paper's table 1, in one of `STONE_MODELS`, with another Young's modulus (Pa)
    where one is given; a rigid one with that angle of friction along soil (degrees)."""
    cone = _reading(reading).cone
    _check.one_of("stone_model", model, STONE_MODELS)
    if model == "rigid":
        if modulus is not None:
            raise ValueError(f"stone_modulus must be left out of rigid stones, got {modulus!r}")
        return Rigid(_ROCK_DENSITY, friction)
    if friction is not None:
        raise ValueError(f"stone_friction must be left out of stones not rigid, got {friction!r}")
    return DruckerPrager(
        density=_ROCK_DENSITY,
        young=STONE_MODULI[model] if modulus is None else modulus,
        poisson=0.2,
        friction=42,
        cohesion=900e3,
        cone=cone,
    )


def slope(
    name: str = "soil",
    reading: str = "identified",
    cell: float = 0.1,
    *,
    seed: int = 1,
    stone_model: str = "deformable",
    stone_modulus: float | None = None,
    stone_friction: float | None = None,
) -> Scene:
    """One of the four slopes, 9 m high, 45 degrees: 23,490 points at 0.1 m.

    Parameters
    ----------
    name : one of `SLOPES`
    reading : one of `READINGS`
    cell : side of a grid cell, m
    seed : of the places and shapes of the stones
    stone_model : one of `STONE_MODELS`
    stone_modulus : Young's modulus of stones that are not rigid, Pa; None: that of the model
    stone_friction : angle of friction of rigid stones along soil, degrees; None: soil sticks
    """
    _check.one_of("slope", name, tuple(SLOPES))
    walls = _reading(reading).walls
    if name == "soil":
        return Scene(Outline.slope(), soil(reading), cell=cell, walls=walls)
    return Scene(
        Outline.slope(),
        soil(reading),
        stones=reference_stones.stones(name, seed),
        stone=rock(reading, stone_model, stone_modulus, stone_friction),
        cell=cell,
        walls=walls,
    )


def method(
    reading: str = "identified",
    *,
    courant: float | None = None,
    time_step: float | None = None,
    precision: Precision = "double",
    threads: int = 1,
    ledger: bool = True,
    volumetric_strain: VolumetricStrain | None = VOLUMETRIC_STRAIN,
) -> Method:
    """uGIMP, USF, volume strains of the points and the reading's viscosity, as the paper has it
    unless given otherwise; a Courant number, or a time step in s."""
    return Method(
        viscosity=_reading(reading).viscosity,
        courant=courant,
        time_step=time_step,
        precision=precision,
        threads=threads,
        ledger=ledger,
        volumetric_strain=volumetric_strain,
    )


def setup(
    name: str = "soil",
    *,
    reading: str = "identified",
    cell: float = 0.1,
    duration: float = 10.0,
    seed: int = 1,
    stone_model: str = "deformable",
    stone_modulus: float | None = None,
    stone_friction: float | None = None,
    courant: float | None = None,
    time_step: float | None = None,
    threads: int = 1,
    volumetric_strain: VolumetricStrain | None = VOLUMETRIC_STRAIN,
) -> Setup:
    """All of a run of one of the four slopes, its slide of a duration in s; the rest as in `slope`
    and `method`."""
    return Setup(
        slope(
            name,
            reading,
            cell,
            seed=seed,
            stone_model=stone_model,
            stone_modulus=stone_modulus,
            stone_friction=stone_friction,
        ),
        method(
            reading,
            courant=courant,
            time_step=time_step,
            threads=threads,
            volumetric_strain=volumetric_strain,
        ),
        Stages(slide=Slide(duration)),
        RECORDING,
    )


def title(name: str) -> str:
    """A slope as the paper names it and we do: "A soil", "B arbitrary" and so on."""
    return f"{SLOPES[name]} {name}"


def published(name: str, value: float) -> str:
    """One of the paper's figures in words, by its name: "1.6", or "> 3" for a lower bound."""
    return f"{'> ' * (name in LOWER_BOUNDS)}{value:g}"


def reading_of(scene: Scene) -> str:
    """The name of the reading whose walls and cone a scene of the study has.

    Raises `ValueError` if it is none of them.
    """
    for name, reading in READINGS.items():
        if scene.walls == reading.walls and getattr(scene.soil, "cone", None) == reading.cone:
            return name
    raise ValueError(f"scene must be of one of the readings {', '.join(READINGS)}, got {scene}")


def _reading(name: str) -> Reading:
    if name not in READINGS:
        raise ValueError(f"reading must be one of {', '.join(READINGS)}, got {name!r}")
    return READINGS[name]
