"""The stable step: the frequencies of the assembled points, and points let loose at the limit."""

import math

import numpy as np
import pytest

import gimpslope as gs
from gimpslope import _core
from gimpslope.method import Scheme

CELL = 1.0


def assembled(shape: str, per_side: int, poisson: float, shift: tuple[float, float]) -> float:
    """Largest frequency of an endless elastic lattice of points, times cell / wave speed.

    A block of 3 x 3 cells stands for it, whose last nodes are its first ones again.
    """
    spacing = CELL / per_side
    line = (np.arange(3 * per_side) + 0.5) * spacing
    points = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2) + shift
    half = np.full_like(points, spacing / 2)
    nodes, values, gradients = gs.kernel.shape_functions(shape, points, half, cell=CELL)
    grid, count = nodes % 3 @ (1, 3), 9
    material = gs.Elastic(1.0, 1.0, poisson)
    bulk, shear = material.bulk_modulus, material.shear_modulus
    stiff, soft = bulk + 4 / 3 * shear, bulk - 2 / 3 * shear
    law = np.array([[stiff, soft, 0], [soft, stiff, 0], [0, 0, shear]])
    stiffness, mass = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
    for place, value, (dx, dy) in zip(grid, values, np.moveaxis(gradients, 2, 1), strict=True):
        strain = np.zeros((3, 2 * count))
        np.add.at(strain[0], 2 * place, dx)
        np.add.at(strain[1], 2 * place + 1, dy)
        np.add.at(strain[2], 2 * place, dy)
        np.add.at(strain[2], 2 * place + 1, dx)
        stiffness += spacing**2 * strain.T @ law @ strain
        np.add.at(mass, 2 * place, spacing**2 * value)
        np.add.at(mass, 2 * place + 1, spacing**2 * value)
    np.testing.assert_allclose(mass, CELL**2, rtol=1e-12)
    root = 1 / np.sqrt(mass)
    frequencies = np.linalg.eigvalsh(root[:, None] * stiffness * root)
    return math.sqrt(frequencies[-1]) * CELL / material.wave_speed


@pytest.mark.parametrize("poisson", [-0.6, 0.0, 0.33, 0.45])
@pytest.mark.parametrize("per_side", [1, 2, 3, 4])
def test_contiguous_domains_are_stable_at_the_limit(per_side: int, poisson: float) -> None:
    """dt = limit cell / c does not exceed 2 / omega (leapfrog), wherever the lattice lies: the
    domains add up to bilinear finite elements with lumped masses, omega <= 2 c / cell."""
    places = [(0.0, 0.0), (0.2, 0.0), (0.31, 0.45), (0.5, 0.5)]
    largest = max(assembled("ugimp", per_side, poisson, place) for place in places)
    assert _core.courant_limit * largest <= 2.0 * (1 + 1e-12)
    assert largest > 1.0


@pytest.mark.parametrize("per_side", [1, 2, 3, 4])
def test_splines_are_stable_at_the_limit(per_side: int) -> None:
    """They are smoother than the domains are."""
    places = [(0.0, 0.0), (0.2, 0.0), (0.31, 0.45), (0.5, 0.5)]
    largest = max(assembled("quadratic_bspline", per_side, 0.33, place) for place in places)
    assert _core.courant_limit * largest <= 2.0
    assert largest > 1.0


@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize("shape", ["linear", "ugimp", "quadratic_bspline"])
@pytest.mark.parametrize("poisson", [0.0, 0.45])
def test_scattered_points_with_free_edges_are_stable_at_the_limit(
    shape: str, poisson: float, scheme: Scheme
) -> None:
    """Nodes at an edge that hold little mass are stiffer than the bound, but their motion is taken
    anew from the points at every step. Energy of a random motion under FLIP must not grow; an
    unstable step multiplies it at every step."""
    random = np.random.default_rng(seed=3)
    line = (np.arange(12) + 0.5) * 0.5
    lattice = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    n = len(lattice)
    material = gs.Elastic(1000, 1e6, poisson)
    for _ in range(3):
        place = lattice + random.uniform(0, 1, 2) + random.uniform(-0.25, 0.25, lattice.shape)
        points = gs.Points(
            place, np.full((n, 2), 0.25), np.full(n, 0.25), np.full(n, 250.0), np.zeros(n, int)
        )
        method = gs.Method(
            shape=shape, scheme=scheme, alpha=0.0, time_step=CELL / material.wave_speed
        )
        solver = gs.Solver(points, [material], cell=CELL, method=method)
        solver.velocity = 1e-6 * random.uniform(-1, 1, lattice.shape)
        before = solver.energies().kinetic
        solver.advance(2000)
        after = solver.energies()
        assert after.kinetic + after.elastic < 2 * before


def test_stable_step_is_the_cell_over_the_wave_speed() -> None:
    soil = gs.Elastic(1800, 30e6, 0.33)
    scene = gs.Scene(gs.Outline.slope(2, 1), soil, cell=0.25)
    assert gs.Solver.of(scene).stable_time_step == pytest.approx(0.25 / soil.wave_speed)
    assert soil.wave_speed == pytest.approx(157.1, abs=0.1)
