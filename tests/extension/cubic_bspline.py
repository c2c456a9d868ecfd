"""What the shape function of CONTRIBUTING.md must fulfil; `test_new_shape.py` runs this with it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import gimpslope as gs
from gimpslope.studies import reference
from reference import Material, Reference

Array = NDArray[np.float64]

SHAPE = "cubic_bspline"
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
    assert gs.kernel.shapes() == ["linear", "ugimp", "cpgimp", "quadratic_bspline", SHAPE]
    with pytest.raises(ValueError, match=f"shape must be one of .*'{SHAPE}', got 'quartic'"):
        gs.Method(shape="quartic")


def test_partition_of_unity_that_reproduces_places() -> None:
    found = gs.kernel.shape_functions(SHAPE, places(), cell=CELL, origin=ORIGIN)
    nodes = np.array(ORIGIN) + CELL * found.nodes
    np.testing.assert_allclose(found.values.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(found.gradients.sum(axis=1), 0.0, atol=1e-13)
    np.testing.assert_allclose(np.einsum("nk,nkj->nj", found.values, nodes), places(), atol=1e-14)


def spline(degree: int, z: Array) -> Array:
    """B-spline of unit knots, centred at 0, by the recursion of Cox and de Boor."""
    if degree == 0:
        return np.where((z >= -0.5) & (z < 0.5), 1.0, 0.0)
    half = (degree + 1) / 2
    left, right = spline(degree - 1, z + 0.5), spline(degree - 1, z - 0.5)
    return np.asarray(((half + z) * left + (half - z) * right) / degree)


def dense(position: Array, lines: tuple[Array, Array]) -> tuple[Array, Array, Array]:
    """S, dS/dx and dS/dy, (n_points, n_nodes), of nodes in the order of the twin."""
    z = [(position[:, axis, None] - lines[axis]) / CELL for axis in (0, 1)]
    value = [spline(3, of) for of in z]
    slope = [(spline(2, of + 0.5) - spline(2, of - 0.5)) / CELL for of in z]
    pairs = (value[0], value[1]), (slope[0], value[1]), (value[0], slope[1])
    return tuple((x[:, :, None] * y[:, None, :]).reshape(len(position), -1) for x, y in pairs)


def test_values_by_recursion() -> None:
    """Its derivative is a difference of two quadratic splines."""
    nodes, values, gradients = gs.kernel.shape_functions(SHAPE, places(), cell=CELL, origin=ORIGIN)
    lines = tuple(CELL * np.arange(-12, 13) + corner for corner in ORIGIN)
    expected = dense(places(), lines)
    at = (nodes[..., 0] + 12) * 25 + nodes[..., 1] + 12
    for found, of in zip((values, gradients[..., 0], gradients[..., 1]), expected, strict=True):
        np.testing.assert_allclose(found, np.take_along_axis(of, at, axis=1), atol=1e-14)


@pytest.mark.parametrize(
    ("options", "tolerance"),
    [({}, 1e-9), ({"volumetric_strain": "point"}, 1e-9), ({"precision": "single"}, 1e-3)],
)
def test_it_steps_as_the_twin(
    options: dict[str, Any], tolerance: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A block that yields and slides: layout, sweeps and the second moment in the blend."""
    start, dt, viscosity = block(), 4e-3, 0.1
    solver = gs.Solver(
        start,
        [SOIL],
        cell=CELL,
        walls=WALLS,
        wall_positions=(0.0, 10.0, 0.0, 10.0),
        gravity=(3.0, -9.81),
        method=gs.Method(shape=SHAPE, viscosity=viscosity, time_step=dt, **options),
    )
    monkeypatch.setattr("reference.gimp.weights", lambda *given: dense(given[1], given[3]))
    free = ("free", 0.0, 10.0)
    twin = Reference(
        start.position,
        np.zeros_like(start.position),
        start.half_length,
        start.mass,
        start.volume,
        start.material,
        [Material(2000, 1e6, 0.3, "drucker_prager", 22, 1e3)],
        cell=CELL,
        origin=(0.0, 0.0),
        walls=[("roller", 0.0, 0.0), free, ("coulomb", 0.3, 0.0), free],
        shape="linear",  # in name
        volumetric_strain=options.get("volumetric_strain", "cell_average"),
        blend=("alpha", viscosity * dt / (CELL**2 / 3)),
        time_step=("fixed", dt),
    )
    twin.set_gravity(3.0, -9.81, 0.0)
    for stepped in (solver, twin):
        stepped.advance(200)
    assert solver.plastic_strain.max() > 0.01
    assert np.abs(solver.position - start.position).max() > CELL
    for name in ("position", "velocity", "stress", "volume"):
        ours, theirs = getattr(solver, name), getattr(twin, name)
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
