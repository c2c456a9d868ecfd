"""How points deform with the nodes, and the forces by which they resist.

Gradients of the shape functions sx, sy are (n, nodes); `cells` are the numbers of the cells that
volume strains and mean stresses are averaged over (Hughes 1980), None where each point has its own.
"""

import numpy as np
from numpy.typing import NDArray

from . import ledger as accounts
from .drucker_prager import elastic_increment, energy_density, return_mapping, rotate
from .ledger import Ledger
from .points import Points

Array = NDArray[np.float64]
Cells = NDArray[np.int64]


def cell_numbers(position: Array, corner: Array, cell: float) -> Cells:
    """A number for the cell of each point, counted from the first node of a grid. Rounding alone
    tells on which side of a cell line a point lies that is on it: as the kernel has it."""
    places = np.trunc((position - corner) * (1 / cell))
    return np.unique(places, axis=0, return_inverse=True)[1].ravel()


def velocity_gradient(points: Points, sx: Array, sy: Array, v: Array, cells: Cells | None) -> Array:
    """Of the points (n, 2, 2), by the node velocities v; none of rigid ones."""
    gradient = np.stack([sx @ v, sy @ v], axis=2)
    if cells is not None:
        gradient = _averaged(points, gradient, cells)
    gradient[points.rigid] = 0.0
    return gradient


def deform(points: Points, ledger: Ledger, gradient: Array, dt: float, volume_update: str) -> Array:
    """Volume, deformation gradient and stress after the velocity gradient; gives the strain
    increments (n, 3, 3)."""
    dilation = np.trace(gradient, axis1=1, axis2=2) * dt
    linear = volume_update == "linear"
    volume_before = points.volume
    points.volume = points.volume * (1 + dilation if linear else np.exp(dilation))
    points.deformation_gradient = (np.eye(2) + gradient * dt) @ points.deformation_gradient

    strain = np.zeros((len(points.mass), 3, 3))
    strain[:, :2, :2] = (gradient + np.swapaxes(gradient, 1, 2)) * dt / 2
    spin = (gradient[:, 1, 0] - gradient[:, 0, 1]) * dt / 2
    turned = rotate(_tensor(points.stress), spin)
    trial = turned.copy()
    for material, of in points.deformable():
        trial[of] += elastic_increment(material, strain[of])
    points.stress = _returned(points, _components(trial))
    for material, of in points.deformable():
        accounts.points(
            ledger,
            material,
            turned=turned[of],
            stress=_tensor(points.stress)[of],
            strain=strain[of],
            volume_before=volume_before[of],
            volume=points.volume[of],
        )
    return strain


def deform_last(
    points: Points, ledger: Ledger, gradient: Array, dt: float, volume_update: str
) -> None:
    """The same after forces that belong to the stress before."""
    before = points.stress * points.volume[:, None]
    strain = deform(points, ledger, gradient, dt, volume_update)
    late = _tensor(points.stress * points.volume[:, None] - before)
    ledger.integration -= float(np.sum(late[:, :2, :2] * strain[:, :2, :2]))


def internal_force(points: Points, sx: Array, sy: Array, cells: Cells | None) -> Array:
    """Of the stresses at the nodes, N/m."""
    sigma = _tensor(points.stress)[:, :2, :2]
    if cells is not None:
        sigma = _averaged(points, sigma, cells)
    sigma = sigma * points.soft_volume[:, None, None]
    return np.asarray(-(sx.T @ sigma[:, :, 0] + sy.T @ sigma[:, :, 1]))


def release(points: Points) -> float:
    """Return the stresses to the yield surface; elastic energy released, J/m."""
    before = _elastic_energy(points)
    points.stress = _returned(points, points.stress)
    return before - _elastic_energy(points)


def domains(points: Points, update: str) -> Array:
    """Half lengths (n, 2) of domains that follow the deformation."""
    f = points.deformation_gradient
    if update == "jacobian":
        growth = np.sqrt(points.volume / points.first_volume)[:, None]
    elif update == "stretch":
        squares, axes = np.linalg.eigh(np.swapaxes(f, 1, 2) @ f)
        stretch = axes * np.sqrt(squares)[:, None, :] @ np.swapaxes(axes, 1, 2)
        growth = np.diagonal(stretch, axis1=1, axis2=2)
    else:
        growth = np.diagonal(f, axis1=1, axis2=2)
    return np.asarray(points.first_half_length * growth)


def _averaged(points: Points, tensor: Array, cells: Cells) -> Array:
    """Tensors (n, 2, 2) whose mean is that over the volume of the soft points in a cell."""
    trace = np.trace(tensor, axis1=1, axis2=2)
    mean = np.zeros_like(trace)
    for cell in np.unique(cells[~points.rigid]):
        of = (cells == cell) & ~points.rigid
        mean[of] = np.average(trace[of], weights=points.volume[of])
    return np.asarray(tensor + ((mean - trace) / 2)[:, None, None] * np.eye(2))


def _returned(points: Points, stress: Array) -> Array:
    returned = stress.copy()
    for material, of in points.deformable():
        tensor, plastic_strain = return_mapping(material, _tensor(stress[of]))
        returned[of] = _components(tensor)
        points.plastic_strain[of] += plastic_strain
    return returned


def _elastic_energy(points: Points) -> float:
    energy = 0.0
    for material, of in points.deformable():
        energy += float(points.volume[of] @ energy_density(material, _tensor(points.stress[of])))
    return energy


def _tensor(stress: Array) -> Array:
    """(n, 4) as xx, yy, zz, xy -> (n, 3, 3)."""
    tensor = np.zeros((len(stress), 3, 3))
    tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = stress[:, 0], stress[:, 1], stress[:, 2]
    tensor[:, 0, 1] = tensor[:, 1, 0] = stress[:, 3]
    return tensor


def _components(tensor: Array) -> Array:
    """(n, 3, 3) -> (n, 4) as xx, yy, zz, xy."""
    return np.stack([tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2], tensor[:, 0, 1]], axis=1)
