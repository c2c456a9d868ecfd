"""What is measured: slope A, let go from rest under full gravity, stepped in several ways."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ... import _check, _core, kernel
from ..._check import FloatArray
from ...materials import DruckerPrager, Material
from ...method import Method, Precision, Scheme, Shape, VolumetricStrain
from ...scene import Points, Scene
from ...solver import Solver
from .. import reference

SLOPE_A = 23_490
"""Points of slope A at its cell of 0.1 m."""

STONE = DruckerPrager(density=2400, young=20e9, poisson=0.20, friction=42, cohesion=900e3)
"""The stone of the reference study."""

MOST_POINTS = 100_000_000
"""More than fit into the memory of the machines that this is for."""

_MARGIN = 40  # cells that points of the plain loop may go beyond the slope
_STONE_SPACING = 1.0  # between the centres of stones, m


class Slope(NamedTuple):
    """The scene without its stones, and the points and materials with them."""

    scene: Scene
    points: Points
    materials: tuple[Material, ...]


@dataclass(frozen=True)
class Case:
    """One way to step slope A.

    The cell is chosen for about the number of points, and the points are displaced by up to a
    quarter of their spacing: a regular lattice flatters the memory.

    Parameters
    ----------
    points : about that many, in [10, `MOST_POINTS`]
    threads : number of threads, >= 1
    precision, shape, scheme, volumetric_strain, ledger : as of `Method`
    stones : share of the area that is stone, in discs a metre apart, in [0, 0.7]
    instruction_set : one of `gimpslope.kernel.instruction_sets()`; the fastest where left out

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range.
    """

    points: int = SLOPE_A
    threads: int = 1
    precision: Precision = "double"
    shape: Shape = "ugimp"
    scheme: Scheme = "usf"
    volumetric_strain: VolumetricStrain = reference.VOLUMETRIC_STRAIN
    ledger: bool = False
    stones: float = 0.0
    instruction_set: str = ""

    def __post_init__(self) -> None:
        _check.in_range("points", _check.whole("points", self.points, 10), 10, MOST_POINTS)
        _check.in_range("stones", self.stones, 0.0, 0.7)
        if self.threads != 1 and not kernel.has_threads():
            raise ValueError(f"threads must be 1, for this build has none, got {self.threads}")
        self.method()

    @property
    def standard(self) -> Case:
        """The case of this size and number of threads that others are compared with."""
        return Case(self.points, self.threads, instruction_set=self.instruction_set)

    def method(self) -> Method:
        """That of the reference study, with what this case changes."""
        method = reference.method(
            threads=self.threads,
            precision=self.precision,
            volumetric_strain=self.volumetric_strain,
            ledger=self.ledger,
        )
        return replace(method, shape=self.shape, scheme=self.scheme)

    def slope(self) -> Slope:
        """Slope A with displaced points, and stones where there are any."""
        scene = reference.slope(cell=0.1 * (SLOPE_A / self.points) ** 0.5)
        points = _displaced(scene.points, scene.spacing / 4)
        if self.stones == 0.0:
            return Slope(scene, points, scene.materials)
        materials = (scene.soil, STONE)
        material = _in_stones(points.position, self.stones).astype(np.int32)
        density = np.array([kind.density for kind in materials])[material]
        return Slope(
            scene, replace(points, material=material, mass=points.volume * density), materials
        )

    def solver(self) -> Solver:
        """The kernel's state at the start."""
        scene, points, materials = self.slope()
        return Solver(
            points,
            materials,
            cell=scene.cell,
            walls=scene.walls,
            wall_positions=scene.wall_positions,
            gravity=(0.0, -scene.gravity),
            method=self.method(),
            instruction_set=self.instruction_set,
        )

    def plain(self) -> _core.Plain:
        """The same step as a plain loop on one thread: uGIMP in double precision, no ledger."""
        scene, points, materials = self.slope()
        method = self.standard.method()
        return _core.Plain(
            points.position,
            np.zeros_like(points.position),
            points.half_length,
            points.mass,
            points.volume,
            points.material,
            [material.to_core() for material in materials],
            cell=scene.cell,
            origin=scene.origin,
            walls=scene.walls.to_core(scene.wall_positions),
            blend=method.blend,
            time_step=method.step,
            gravity=(0.0, -scene.gravity),
            margin=_MARGIN,
            instruction_set=self.instruction_set,
        )


def _displaced(points: Points, distance: float) -> Points:
    random = np.random.default_rng(seed=1)
    shift = random.uniform(-distance, distance, points.position.shape)
    return replace(points, position=np.maximum(points.position + shift, 1e-3 * distance))


def _in_stones(position: FloatArray, share: float) -> npt.NDArray[np.bool_]:
    """Which points lie in the discs that take that share of a square lattice."""
    from_centre = (position / _STONE_SPACING) % 1.0 - 0.5
    inside: npt.NDArray[np.bool_] = (from_centre**2).sum(axis=1) < share / np.pi
    return inside
