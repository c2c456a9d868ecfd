"""The material points: what they are made of and what has become of them."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .bodies import Rigid
from .drucker_prager import Material

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Points:
    """The state, in plain attributes that may be read and assigned.

    position, velocity (n, 2); stress (n, 4) as xx, yy, zz, xy; body_force (n, 2), m/s2; mass,
    volume, plastic_strain (n,); half_length (n, 2); deformation_gradient (n, 2, 2); affine
    (n, 2, 2), B of APIC; materials, and of each point which one; whether it is rigid.
    """

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        half_length: ArrayLike,
        mass: ArrayLike,
        volume: ArrayLike,
        material: ArrayLike,
        materials: Sequence[Material | Rigid],
    ) -> None:
        self.position = np.array(position, float)
        self.velocity = np.array(velocity, float)
        self.half_length = np.array(half_length, float)
        self.mass = np.array(mass, float)
        self.volume = np.array(volume, float)
        self.material = np.array(material, int)
        self.materials = list(materials)
        n = len(self.position)
        self.stress = np.zeros((n, 4))
        self.plastic_strain = np.zeros(n)
        self.body_force = np.zeros((n, 2))
        self.deformation_gradient = np.tile(np.eye(2), (n, 1, 1))
        self.affine = np.zeros((n, 2, 2))
        self.first_half_length = self.half_length.copy()
        self.first_volume = self.volume.copy()
        rigid = [i for i, material in enumerate(self.materials) if isinstance(material, Rigid)]
        self.rigid = np.isin(self.material, rigid)

    @property
    def soft_mass(self) -> Array:
        """What they give the grid, kg/m: none of rigid ones."""
        return np.where(self.rigid, 0.0, self.mass)

    @property
    def soft_volume(self) -> Array:
        """That of deformable ones, m3/m."""
        return np.where(self.rigid, 0.0, self.volume)

    def deformable(self) -> Iterator[tuple[Material, Mask]]:
        """The deformable materials and their points."""
        for i, material in enumerate(self.materials):
            if not isinstance(material, Rigid):
                yield material, self.material == i

    def soft_kinetic_energy(self) -> float:
        """That of deformable ones, J/m."""
        of = ~self.rigid
        return float(np.sum(self.mass[of, None] * self.velocity[of] ** 2) / 2)
