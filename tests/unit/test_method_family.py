"""What sets schemes and transfers apart, against theory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kernel_scene import block
from numpy.typing import NDArray

import gimpslope as gs
from gimpslope.studies import reference
from gimpslope.studies.verify import bar

Array = NDArray[np.float64]

CELL = 0.5
SPEED = 1e-9  # m/s: points stay where they are
SOFT = gs.Elastic(density=2000, young=1e-9, poisson=0.0)  # next to no force


def points(columns: int, rows: int, jitter: float = 0.0) -> gs.Points:
    made = block(columns, rows, cell=CELL, jitter=jitter)
    names = ("position", "half_length", "volume", "mass", "material")
    return gs.Points(**{name: made[name] for name in names})


def xpic(order: int) -> gs.Method:
    return gs.Method(transfer="xpic", order=order, time_step=1e-3)


@pytest.mark.parametrize("order", [1, 2, 3, 6])
def test_xpic_damps_what_nodes_see_by_a_power_of_what_they_smooth(order: int) -> None:
    """A wave of the nodes, of angle theta a cell, is W = (5 + 3 cos theta) / 8 of itself after a
    way through two uGIMP points a cell and back, and 1 - (1 - W)^m after a step of XPIC(m), which
    follows from its definition (Hammerquist and Nairn 2017)."""
    theta, steps, cells = np.pi / 3, 4, 60
    given = points(2 * cells, 2)
    solver = gs.Solver(given, [SOFT], cell=CELL, method=xpic(order))
    found = gs.kernel.shape_functions(
        "ugimp", given.position, given.half_length, cell=CELL, origin=(0.0, 0.0)
    )
    wave = np.einsum("nk,nk->n", found.values, np.cos(theta * found.nodes[..., 0]))
    solver.velocity = SPEED * np.column_stack([wave, wave])
    solver.advance(steps)
    kept = (1 - (1 - (5 + 3 * np.cos(theta)) / 8) ** order) ** steps
    inner = np.abs(given.position[:, 0] / CELL - cells / 2) < 5  # far from the ends
    np.testing.assert_allclose(
        solver.velocity[inner, 0], SPEED * kept * wave[inner], rtol=0, atol=1e-10 * SPEED
    )


@pytest.mark.parametrize(
    ("method", "left"),
    [
        (gs.Method(alpha=0.0, time_step=1e-3), 1.0),
        (gs.Method(alpha=0.1, time_step=1e-3), 0.9**5),
        (xpic(1), 0.0),
        (xpic(2), 0.0),
        (xpic(5), 0.0),
        (gs.Method(transfer="apic", time_step=1e-3), 0.0),
    ],
    ids=["flip", "blend", "pic", "xpic2", "xpic5", "apic"],
)
def test_noise_without_a_grid_image(method: gs.Method, left: float) -> None:
    """Velocities that cancel at every node are the null space of S+: FLIP keeps them for ever, XPIC
    of any order drops them in a step."""
    given, steps = points(160, 4), 5
    solver = gs.Solver(given, [SOFT], cell=CELL, method=method)
    sign = np.where(np.floor(given.position[:, 0] / (CELL / 2)) % 2 == 0, 1.0, -1.0)
    solver.velocity = SPEED * np.column_stack([sign, 0 * sign])
    solver.advance(steps)
    inner = np.abs(given.position[:, 0] - 40 * CELL) < 5 * CELL
    np.testing.assert_allclose(
        solver.velocity[inner, 0], SPEED * left * sign[inner], rtol=0, atol=1e-12 * SPEED
    )


def angular_momentum(solver: gs.Solver, affine: bool) -> float:
    """About the origin, kg m/s; with what points carry of an affine motion."""
    x, v = solver.position, solver.velocity
    spin = x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]
    if affine:
        spin = spin + solver.affine[:, 2] - solver.affine[:, 1]
    return float(solver.mass @ spin)


def spun(shape: str, **options: Any) -> tuple[float, float]:
    """Angular momentum of an elastic block that turns and flies: at first, and its change."""
    given = points(12, 8, jitter=0.3)
    arm = given.position - given.position.mean(axis=0)
    solver = gs.Solver(
        given,
        [gs.Elastic(density=2000, young=1e5, poisson=0.3)],
        cell=CELL,
        velocity=np.array([1.0, 0.5]) + 2.0 * np.column_stack([-arm[:, 1], arm[:, 0]]),
        method=gs.Method(shape=shape, courant=0.2, **options),
    )
    affine = options.get("transfer") == "apic"
    before = angular_momentum(solver, affine)
    solver.advance(200)
    return before, angular_momentum(solver, affine) - before


@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize("shape", ["ugimp", "cpgimp", "quadratic_bspline"])
def test_apic_keeps_angular_momentum(shape: str, scheme: str) -> None:
    """To rounding, through cells and domains that change (Jiang and others 2015). PIC
    loses a good part of it."""
    before, change = spun(shape, scheme=scheme, transfer="apic")
    assert abs(change) < 1e-12 * abs(before)
    before, change = spun(shape, scheme=scheme, alpha=1.0)
    assert change < -0.05 * abs(before)


def swung(**options: Any) -> float:
    """Energy of the bar of `gimpslope verify` after ten periods at C = 0.5, parts of the first."""
    cell = bar.LENGTH / bar.CELLS
    corners = np.array([(0, 0), (bar.LENGTH, 0), (bar.LENGTH, cell), (0, cell)])
    scene = gs.Scene(
        gs.Outline(corners),
        gs.Elastic(density=bar.DENSITY, young=bar.YOUNG, poisson=0.0),
        cell=cell,
        walls=gs.Walls(left=gs.Fixed(), bottom=gs.Roller(), top=gs.Roller()),
    )
    along = scene.points.position[:, 0]
    solver = gs.Solver(
        scene.points,
        scene.materials,
        cell=cell,
        walls=scene.walls,
        wall_positions=scene.wall_positions,
        velocity=np.column_stack([bar.SPEED * np.sin(bar.WAVE_NUMBER * along), 0 * along]),
        method=gs.Method(time_step=bar.step(0.5), **options),
    )
    start = solver.energies().kinetic
    solver.advance_to(bar.PERIODS * bar.PERIOD)
    end = solver.energies()
    return (end.kinetic + end.elastic) / start


@pytest.mark.parametrize(
    ("scheme", "published"), [("usf", 1.0003), ("usl", 0.9994), ("musl", 0.9996)]
)
def test_energy_of_a_bar_by_scheme(scheme: str, published: float) -> None:
    """A 1D code's, within what the energy swings by in a period at this step, as in `bar`."""
    assert swung(scheme=scheme, alpha=0.0) == pytest.approx(published, abs=3e-4)


def test_energy_of_a_bar_by_transfer() -> None:
    """PIC takes half of it; XPIC, whose noise is of the fourth order in the wave number, and APIC
    take next to nothing."""
    assert swung(alpha=1.0) < 0.5
    assert swung(transfer="xpic") == pytest.approx(1.0, abs=3e-4)
    assert swung(transfer="apic") == pytest.approx(1.0, abs=1e-3)


def test_a_run_file_tells_its_member(tmp_path: Path) -> None:
    method = gs.Method(
        shape="quadratic_bspline", scheme="musl", transfer="xpic", order=3, courant=0.2, ledger=True
    )
    run = gs.simulate(
        reference.slope(cell=0.8),
        duration=0.3,
        method=method,
        output=tmp_path / "run.h5",
        progress=False,
    )
    assert gs.open(run.path).method == method
    assert np.ptp(run.ledger.balance) < 1e-11 * run.ledger.turned_over
