"""The points of a run at one time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from ._check import FloatArray

if TYPE_CHECKING:
    import meshio


class MaxDisplacement(NamedTuple):
    """Largest displacements of any point, m; each may be of another point."""

    total: float
    horizontal: float
    vertical: float


@dataclass(frozen=True, eq=False)
class PointsAtStart:
    """The points at the start of the slide, in the order in which they were given.

    Attributes
    ----------
    position : m, shape (n, 2)
    mass : kg/m, shape (n,)
    volume : area in the plane, m2, shape (n,)
    half_length : half the sides of the point's rectangle, m, shape (n, 2)
    material : index into the scene's materials, 0 being the soil, shape (n,)
    stone : number of the stone that the point is part of, -1 in the soil, shape (n,)
    """

    position: FloatArray
    mass: FloatArray
    volume: FloatArray
    half_length: FloatArray
    material: npt.NDArray[np.int32]
    stone: npt.NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.position)


@dataclass(frozen=True, eq=False)
class Snapshot:
    """The points at one time of the slide.

    Attributes
    ----------
    time : since the trigger, s
    position : m, shape (n, 2)
    velocity : m/s, shape (n, 2)
    stress : xx, yy, zz, xy, tension positive, Pa, shape (n, 4)
    plastic_strain : equivalent plastic strain: the sum since the trigger, its return of stresses
        included, of sqrt(2/3 de:de), de the deviatoric part of the plastic strain increment of a
        step; change of volume does not count, shape (n,)
    volume : area in the plane, m2, shape (n,)
    points : the points at the start of the slide
    """

    time: float
    position: FloatArray
    velocity: FloatArray
    stress: FloatArray
    plastic_strain: FloatArray
    volume: FloatArray
    points: PointsAtStart

    @property
    def speed(self) -> FloatArray:
        """Magnitude of the velocity, m/s, shape (n,)."""
        speed: FloatArray = np.linalg.norm(self.velocity, axis=1)
        return speed

    @property
    def displacement(self) -> FloatArray:
        """Displacement since the trigger, m, shape (n, 2)."""
        return self.position - self.points.position

    @property
    def half_length(self) -> FloatArray:
        """Half the sides of a point's domain, those of the start scaled to the present volume, m.

        They serve pictures and surfaces. Shape (n, 2).
        """
        growth = np.sqrt(self.volume / self.points.volume)
        return self.points.half_length * growth[:, np.newaxis]

    @property
    def density(self) -> FloatArray:
        """Mass over present volume, kg/m3, shape (n,)."""
        density: FloatArray = self.points.mass / self.volume
        return density

    def to_meshio(self) -> meshio.Mesh:
        """The points as vertices with their fields, for any format that meshio writes.

        `run.snapshot(1.6).to_meshio().write("slope.vtu")` makes a file for ParaView. The fields are
        those of `gimpslope.io.vtk.to_mesh`.
        """
        from .io.vtk import to_mesh

        return to_mesh(self)

    @property
    def displacement_sizes(self) -> FloatArray:
        """Displacement in all, sideways (|u_x|) and up or down (|u_y|), m, shape (n, 3)."""
        moved = self.displacement
        return np.column_stack([np.linalg.norm(moved, axis=1), np.abs(moved)])

    @property
    def max_displacement(self) -> MaxDisplacement:
        """Largest displacements of any point since the trigger, m."""
        return MaxDisplacement(*self.displacement_sizes.max(axis=0).tolist())
