"""What the shape function of CONTRIBUTING.md must fulfil; `test_new_shape.py` runs this with it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import gimpslope as gs
from gimpslope.studies import reference

Array = NDArray[np.float64]

SHAPE = "quadratic_bspline"
CELL, ORIGIN = 0.5, (0.3, -0.7)
SOIL = gs.DruckerPrager(density=2000, young=1e6, poisson=0.3, friction=22, cohesion=1e3)
WALLS = gs.Walls(left=gs.Roller(), bottom=gs.Coulomb(0.3))


def places() -> Array:
    """On both sides of the origin, the first ones on and between grid lines."""
    inside = np.random.default_rng(0).uniform(-3.0, 3.0, (400, 2))
    return np.vstack([np.array(ORIGIN) + CELL * np.array([[0, 0], [-1, 0.5], [2.5, -1.5]]), inside])


def block() -> gs.Points:
    """4 m by 3 m, two points a cell and direction, with domains a cell wide."""
    spacing = CELL / 2
    x, y = np.meshgrid(np.arange(16) + 0.5, np.arange(12) + 0.5)
    n, volume = x.size, spacing**2
    return gs.Points(
        position=spacing * np.column_stack([x.ravel(), y.ravel()]),
        half_length=np.full((n, 2), CELL / 2),
        volume=np.full(n, volume),
        mass=np.full(n, SOIL.density * volume),
        material=np.zeros(n, int),
    )


def test_its_name_is_known() -> None:
    assert gs.kernel.shapes() == ["linear", "ugimp", "cpgimp", SHAPE]
    with pytest.raises(ValueError, match=f"shape must be one of .*'{SHAPE}', got 'cubic'"):
        gs.Method(shape="cubic")


def test_partition_of_unity_that_reproduces_places() -> None:
    found = gs.kernel.shape_functions(SHAPE, places(), cell=CELL, origin=ORIGIN)
    nodes = np.array(ORIGIN) + CELL * found.nodes
    np.testing.assert_allclose(found.values.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(found.gradients.sum(axis=1), 0.0, atol=1e-13)
    np.testing.assert_allclose(np.einsum("nk,nkj->nj", found.values, nodes), places(), atol=1e-14)


def test_it_is_gimp_with_domains_a_cell_wide() -> None:
    """Three boxes one cell wide, convolved: two are the hat, and the domain is the third."""
    half = np.full_like(places(), CELL / 2)
    spline = gs.kernel.shape_functions(SHAPE, places(), cell=CELL, origin=ORIGIN)
    gimp = gs.kernel.shape_functions("ugimp", places(), half, cell=CELL, origin=ORIGIN)
    np.testing.assert_array_equal(spline.nodes, gimp.nodes)
    np.testing.assert_allclose(spline.values, gimp.values, atol=1e-15)
    np.testing.assert_allclose(spline.gradients, gimp.gradients, atol=1e-14)


@pytest.mark.parametrize(
    ("options", "tolerance"),
    [({}, 1e-9), ({"volumetric_strain": "cell_average"}, 1e-9), ({"precision": "single"}, 1e-3)],
)
def test_it_steps_as_gimp_with_domains_a_cell_wide(
    options: dict[str, Any], tolerance: float
) -> None:
    """A block that yields and slides: layout, sweeps and the second moment in the blend."""

    def stepped(shape: str) -> gs.Solver:
        solver = gs.Solver(
            block(),
            [SOIL],
            cell=CELL,
            walls=WALLS,
            wall_positions=(0.0, 10.0, 0.0, 10.0),
            gravity=(3.0, -9.81),
            method=gs.Method(shape=shape, viscosity=0.1, **options),
        )
        solver.advance(300)
        return solver

    spline, gimp = stepped(SHAPE), stepped("ugimp")
    assert spline.plastic_strain.max() > 0.01
    assert np.abs(spline.position - block().position).max() > CELL
    for name in ("position", "velocity", "stress", "volume"):
        ours, theirs = getattr(spline, name), getattr(gimp, name)
        scale = np.abs(theirs).max()
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=tolerance * scale, err_msg=name)


def test_free_fall_keeps_speed_and_energy() -> None:
    """So fast that points are sorted anew, and nodes laid out for them, at every other step."""
    start, gravity = np.array([-150.0, -100.0]), np.array([0.0, -9.81])
    points = block()
    solver = gs.Solver(
        points,
        [SOIL],
        cell=CELL,
        velocity=np.tile(start, (len(points), 1)),
        gravity=gravity,
        method=gs.Method(shape=SHAPE, alpha=0.5, ledger=True),
    )
    before = sum(solver.energies()[:3])
    solver.advance_to(1.0)
    expected = np.tile(start + gravity, (len(points), 1))
    np.testing.assert_allclose(solver.velocity, expected, rtol=1e-11)
    assert np.abs(solver.stress).max() < 1e-6  # Pa
    energies, ledger = solver.energies(), solver.ledger
    turned_over = solver.mass.sum() * 9.81 * 9.81 / 2
    assert sum(energies[:3]) + ledger.taken == pytest.approx(before, abs=1e-11 * turned_over)
    assert ledger.taken == pytest.approx(ledger.integration, abs=1e-11 * turned_over)


def test_slope_slides_and_its_energy_is_accounted_for(tmp_path: Path) -> None:
    cell = 0.8
    run = gs.simulate(
        reference.slope(cell=cell),
        duration=2.0,
        method=gs.Method(shape=SHAPE, viscosity=0.5625, ledger=True),
        output=tmp_path / "slope.h5",
        progress=False,
    )
    assert gs.open(run.path).method.shape == SHAPE
    assert run.max_displacement().total > 2 * cell
    ledger = run.ledger
    assert 0 < run.energy.peak.value < ledger.turned_over
    assert np.ptp(ledger.balance) < 1e-11 * ledger.turned_over
