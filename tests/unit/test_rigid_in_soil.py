"""A rigid stone pushed within elastic soil, against exact displacements."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from rigid_scene import points, rectangle

import gimpslope as gs
from gimpslope.studies.verify.inclusion import DISKS

MODULUS, POISSON = 2e6 / 2.6, 0.3  # of shear
BOX, FORCE = 1.0, 1e3  # half the width of the box, m; N/m


def displacement_in_annulus(radius: float, outer: float) -> float:
    """Of a rigid disk in elastic soil that is held at an outer circle, in plane strain:

    u = F / (8 pi mu (1 - nu)) (k ln(b/a) - (b2 - a2) / (b2 + a2) / k), k = 3 - 4 nu.

    From Kelvin's line force, the doublet grad(cos t / r), a translation and the field of degree
    two (U, V) = (3 - m, 3 m - 1) r2 with m = 2 (1 - nu) / (1 - 2 nu), where u = (U cos t, V sin t):
    U + V must vanish at both circles, U - V be 2 u at the inner and 0 at the outer one.
    """
    kolosov, a2, b2 = 3 - 4 * POISSON, radius**2, outer**2
    factor = FORCE / (8 * np.pi * MODULUS * (1 - POISSON))
    return float(factor * (kolosov * np.log(outer / radius) - (b2 - a2) / (b2 + a2) / kolosov))


def displacement_in_box(radius: float, held: NDArray[np.complex128]) -> float:
    """The same where places `held` of a closed curve are fixed, symmetric about both axes.

    By Kolosov's potentials (Muskhelishvili 1953): 2 mu (u + i v) = k f - z conj(f') - conj(g) with
    f = -c ln z + sum of a_n z^n, g = k c ln z + sum of b_n z^n, c = F / (2 pi (1 + k)), n even, and
    real a_n, b_n that fit both boundaries best.
    """
    kolosov, largest = 3 - 4 * POISSON, np.abs(held).max()
    inner = radius * np.exp(2j * np.pi * (np.arange(400) + 0.5) / 400)
    z = np.concatenate([inner, held])
    columns = [np.where(np.abs(z) <= radius * (1 + 1e-9), -2 * MODULUS, 0.0) + 0j]
    for n in range(-40, 41, 2):
        power = (z / (largest if n > 0 else radius)) ** n
        columns += [kolosov * power - z * np.conj(n * power / z), -np.conj(power)]
    c = FORCE / (2 * np.pi * (1 + kolosov))
    given = c * (2 * kolosov * np.log(np.abs(z)) - z / np.conj(z))
    table = np.column_stack(columns)
    parts = np.vstack([table.real, table.imag]), np.concatenate([given.real, given.imag])
    return float(np.linalg.lstsq(*parts, rcond=None)[0][0])


def square() -> NDArray[np.complex128]:
    side = BOX * np.cos(np.pi * (np.arange(100) + 0.5) / 100)
    return np.concatenate([side + 1j * BOX, side - 1j * BOX, BOX + 1j * side, -BOX + 1j * side])


def displacement_by_elements(radius: float, outer: float, count: int = 1000) -> float:
    """In the annulus, from the energy of `count` rings in which U and V are linear."""
    lame = 2 * MODULUS * POISSON / (1 - 2 * POISSON)
    law = np.array([[lame + 2 * MODULUS, lame, 0], [lame, lame + 2 * MODULUS, 0], [0, 0, MODULUS]])
    r, stiffness = np.linspace(radius, outer, count + 1), np.zeros((2 * count + 2, 2 * count + 2))
    for k in range(count):
        width, half = r[k + 1] - r[k], 0.5 / (0.5 * (r[k] + r[k + 1]))
        e_rr, e_tt = [-1 / width, 0, 1 / width, 0], [half] * 4
        g_rt = [-half, -1 / width - half, -half, 1 / width - half]
        strain = np.array([e_rr, e_tt, g_rt])
        of = slice(2 * k, 2 * k + 4)
        stiffness[of, of] += np.pi * width / (2 * half) * strain.T @ law @ strain
    stiffness[0] -= stiffness[1]  # the inner circle moves as one: V = -U
    stiffness[:, 0] -= stiffness[:, 1]
    kept = [0, *range(2, 2 * count)]
    load = np.zeros(len(kept))
    load[0] = FORCE
    return float(np.linalg.solve(stiffness[np.ix_(kept, kept)], load)[0])


@pytest.mark.parametrize("radius", [0.2, 0.4])
def test_solutions_for_a_rigid_disk_agree(radius: float) -> None:
    circle = BOX * np.exp(2j * np.pi * np.arange(400) / 400)
    exact = displacement_in_annulus(radius, BOX)
    assert displacement_by_elements(radius, BOX) == pytest.approx(exact, rel=1e-6)
    assert displacement_in_box(radius, circle) == pytest.approx(exact, rel=1e-9)
    box = displacement_in_box(radius, square())
    assert exact < box < displacement_in_annulus(radius, np.sqrt(2) * BOX)


def pushed_in_a_box(stone: gs.Material, cells: int, radius: float) -> float:
    """Displacement at rest of a disk in the middle of a box of soil, half of which is so many cells
    wide, less the exact one, as a share of that.

    By Clapeyron: twice the elastic energy over the force. Kinetic damping stops all at once, so
    that the last step of each swing moves the points but does not strain them: they end up to 4 %
    farther than the stresses say, with a quarter of the step up to 1 %.
    """
    cell = BOX / cells
    place = rectangle(2 * BOX, 2 * BOX, cell / 2)
    inside = np.hypot(*(place - BOX).T) < radius
    soil = gs.Elastic(2000.0, 2 * MODULUS * (1 + POISSON), POISSON)
    given = points(
        cell / 2, (place[~inside], soil.density, 0, -1), (place[inside], stone.density, 1, 0)
    )
    solver = gs.Solver(
        given,
        [soil, stone],
        cell=cell,
        walls=gs.Walls(gs.Fixed(), gs.Fixed(), gs.Fixed(), gs.Fixed()),
        wall_positions=(0.0, 2 * BOX, 0.0, 2 * BOX),
        method=gs.Method(alpha=0.0, courant=0.4),
    )
    of = given.stone == 0
    solver.body_force = np.where(of[:, None], [FORCE / solver.mass[of].sum(), 0.0], 0.0)
    solver.set_damping(kinetic=True)
    solver.advance_to(0.2 if isinstance(stone, gs.Rigid) else 0.5)
    moved = 2 * solver.energies().elastic / FORCE
    return float(moved / displacement_in_box(radius, square()) - 1)


# As heavy as it is stiff, so that its waves are as slow as those of the soil.
STIFF_AND_HEAVY = gs.Elastic(2e5, 2e8, 0.3)


def assert_acts_as_large_as_its_nodes(radius: float, cells: int) -> None:
    """Displacements lie between those of the least and the largest disk that each may act as."""
    exact = displacement_in_box(radius, square())
    for disk, stone in zip(DISKS, (gs.Rigid(2000.0), STIFF_AND_HEAVY), strict=True):
        _, least, most = disk.larger
        low, high = (
            displacement_in_box(radius + larger * BOX / cells, square()) / exact - 1
            for larger in (most, least)
        )
        assert low < pushed_in_a_box(stone, cells, radius) < high, disk.label


@pytest.mark.parametrize("cells", [10, 20])
@pytest.mark.parametrize("radius", [0.3, 0.4])
def test_pushed_in_soil_it_nears_the_exact_displacement(radius: float, cells: int) -> None:
    """A stiff stone in the field of the soil is half a cell too large: with ten and twenty cells to
    a wall, and three and six to the radius, 8.5 and 4.4 % too little, 10.5 and 4.9 % at 0.4 m. A
    rigid one in a field of its own moves by 1.7 % too much and 2.3 % too little, and by 6.3 and
    4.4 % too little."""
    assert_acts_as_large_as_its_nodes(radius, cells)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.3, 0.4])
def test_pushed_in_soil_on_a_fine_grid(radius: float) -> None:
    """Forty cells to a wall: 1.0 and 1.3 % too little; a stiff stone in the field of the soil 2.0
    and 2.7 %."""
    assert_acts_as_large_as_its_nodes(radius, 40)
