"""Where the energy of a step goes, from whole tensors and nodes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .drucker_prager import Material, elastic_increment
from .walls import SIDES, Wall

Array = NDArray[np.float64]


@dataclass
class Ledger:
    """J/m; with kinetic, elastic and potential energy, and less external, constant."""

    plastic: float = 0.0
    friction: float = 0.0
    impact: float = 0.0
    damping: float = 0.0
    transfer: float = 0.0
    external: float = 0.0
    hypoelastic: float = 0.0
    integration: float = 0.0
    rigidity: float = 0.0


def elastic_strain(material: Material, stress: Array) -> Array:
    """The strain (n, 3, 3) that Hooke's law turns into the stress, by a linear system."""
    basis = np.eye(9).reshape(9, 3, 3)
    stiffness = elastic_increment(material, basis).reshape(9, 9).T
    return np.asarray(np.linalg.solve(stiffness, stress.reshape(-1, 9).T).T.reshape(-1, 3, 3))


def double_dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("nij,nij->n", a, b))


def points(
    ledger: Ledger,
    material: Material,
    *,
    turned: Array,
    stress: Array,
    strain: Array,
    volume_before: Array,
    volume: Array,
) -> None:
    """Stress `turned` with the material becomes `stress` under the increment `strain`."""
    elastic = elastic_strain(material, stress - turned)
    ledger.plastic += float(volume @ double_dot(stress, strain - elastic))
    kept = double_dot(stress - turned, elastic) / 2
    start = double_dot(turned, elastic_strain(material, turned)) / 2
    ledger.hypoelastic -= float((volume - volume_before) @ start)
    ledger.integration += float(volume @ kept)


def nodes(
    ledger: Ledger,
    *,
    places: Array,
    walls: Sequence[Wall],
    cell: float,
    dt: float,
    mass: Array,
    raw: Array,
    before: Array,
    after: Array,
    internal: Array,
    weight: Array,
    full_weight: Array,
    body: Array,
    damping: Array,
    held: NDArray[np.bool_],
    stress_first: bool,
) -> None:
    """Nodes go from the raw velocity to the one that walls allow, and by the forces to `after`;
    those that rigid stones hold, by these. Points are strained by the velocity that the walls
    allow or, where not `stress_first`, afterwards."""
    m = mass[:, None]
    middle = (before + after) / 2
    impulse = m * (after - before) - dt * (internal + weight + body + damping)
    for taken, stopped in (
        (m * (raw**2 - before**2) / 2, before == 0),
        (-impulse * middle, (before == 0) | (after == 0)),
    ):
        rubbed = _rubbed(stopped, places, walls, cell)
        by_stones = np.broadcast_to(held[:, None], taken.shape)
        ledger.rigidity += float(taken[by_stones].sum())
        ledger.friction += float(taken[rubbed & ~by_stones].sum())
        ledger.impact += float(taken[~rubbed & ~by_stones].sum())
    ledger.damping -= float(dt * np.sum(damping * middle))
    ledger.external += float(dt * np.sum((body + weight - full_weight) * middle))
    of_strains = internal if stress_first else -internal
    ledger.integration -= float(dt / 2 * np.sum((of_strains - full_weight) * (after - before)))
    ledger.transfer += float(np.sum(m * (after**2 - raw**2)) / 2)


def _rubbed(stopped: Array, places: Array, walls: Sequence[Wall], cell: float) -> Array:
    """Components (n, 2) along a Coulomb wall that no other wall can have brought to a stop."""
    along = np.zeros_like(stopped)
    hit = np.zeros_like(stopped)
    for (axis, into), (kind, _, position) in zip(SIDES, walls, strict=True):
        touched = into * (places[:, axis] - position) >= -1e-9 * cell
        if kind == "coulomb":
            along[touched, 1 - axis] = True
        if kind != "free":
            hit[touched, axis] = True
        if kind == "fixed":
            hit[touched] = True
    return np.asarray(along & ~(hit & stopped))
