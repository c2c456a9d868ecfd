"""Energies that the Python solver tells, and rows of them on the way."""

from __future__ import annotations

import numpy as np
import pytest
from floating_slope import SCENE, SOIL, G, N, floating

import gimpslope as gs


def test_energies_of_a_known_state() -> None:
    stress = np.zeros((N, 4))
    stress[:, :3] = -5e4
    solver = floating(velocity=np.tile((3.0, 4.0), (N, 1)), stress=stress, gravity=(0.0, -G))
    mass, volume = SCENE.points.mass, SCENE.points.volume
    energies = solver.energies()
    assert energies.kinetic == pytest.approx(12.5 * mass.sum())
    assert energies.potential == pytest.approx(G * mass @ SCENE.points.position[:, 1])
    assert energies.elastic == pytest.approx(5e4**2 / (2 * SOIL.bulk_modulus) * volume.sum())
    assert energies.max_speed == pytest.approx(5.0)


def test_release_stress_returns_and_tells_the_energy() -> None:
    random = np.random.default_rng(0)
    stress = 1e5 * random.normal(size=(N, 4))
    solver = gs.Solver.of(SCENE)
    solver.stress = stress
    before = solver.energies().elastic
    released = solver.release_stress()
    expected = gs.kernel.return_mapping(SOIL, stress)
    np.testing.assert_allclose(solver.stress, expected.stress, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(solver.plastic_strain, expected.plastic_strain, rtol=1e-12)
    assert released == pytest.approx(before - solver.energies().elastic, rel=1e-9)
    assert released > 0
    # What was returned is on the surface: again nothing is released but rounding.
    assert abs(solver.release_stress()) < 1e-9 * released


def energies_of(solver: gs.Solver) -> dict[str, float]:
    """By their definitions, from the fields."""
    speed = np.linalg.norm(solver.velocity, axis=1)
    normal, shear = solver.stress[:, :3], solver.stress[:, 3]
    young, poisson = SOIL.young, SOIL.poisson
    double_density = (
        (1 + poisson) * (normal**2).sum(axis=1)
        - poisson * normal.sum(axis=1) ** 2
        + 2 * (1 + poisson) * shear**2
    ) / young
    return {
        "kinetic": 0.5 * solver.mass @ speed**2,
        "potential": G * solver.mass @ solver.position[:, 1],
        "elastic": 0.5 * solver.volume @ double_density,
        "max_speed": speed.max(),
    }


@pytest.mark.parametrize(
    "method",
    [
        gs.Method(threads=2),
        gs.Method(ledger=True),
        gs.Method(volumetric_strain="cell_average"),
        gs.Method(precision="single"),
        gs.Method(time_step=1e-3),
    ],
    ids=["threads", "ledger", "cell average", "single", "fixed step"],
)
def test_rows_on_the_way_are_the_energies_there(method: gs.Method) -> None:
    """Whether they are summed up in the last step or afterwards, and however often one looks."""
    times = [0.0105, 0.02, 0.0311, 0.05]
    once, often = (gs.Solver.of(SCENE, method) for _ in range(2))
    once.advance_through(times)
    rows = once.take_rows()
    assert len(rows["time"]) == len(times)
    for number, time in enumerate(times):
        often.advance_to(time)
        assert rows["step"][number] == often.steps
        assert rows["time"][number] == often.time
        for name, value in energies_of(often).items():
            assert rows[name][number] == pytest.approx(value, rel=1e-12), name
        if method.ledger:
            assert rows["plastic"][number] == often.ledger.plastic
    assert ("plastic" in rows) == method.ledger
    assert len(once.take_rows()["time"]) == 0


def test_energies_follow_what_is_set_after_a_step() -> None:
    solver = gs.Solver.of(SCENE)
    solver.advance_to(0.02)
    for change in ("velocity", "stress", "volume", "position"):
        setattr(solver, change, 1.001 * getattr(solver, change))
        for name, value in energies_of(solver).items():
            assert getattr(solver.energies(), name) == pytest.approx(value, rel=1e-12), change


def test_times_that_are_not_ahead_have_no_row() -> None:
    solver = gs.Solver.of(SCENE, gs.Method(time_step=1e-3))
    solver.advance_through([1e-3, 1.2e-3, 1.4e-3, 3e-3])
    np.testing.assert_allclose(solver.take_rows()["time"], [1e-3, 2e-3, 3e-3])
    with pytest.raises(ValueError, match=r"^times must grow, got \[0\.2 0\.1\]"):
        solver.advance_through([0.2, 0.1])


def test_rows_of_before_a_failure_are_kept() -> None:
    solver = floating(method=gs.Method(time_step=0.02, allow_unstable=True), gravity=(0, -G))
    solver.velocity = np.random.default_rng(1).normal(size=(N, 2))
    with pytest.raises(gs.Diverged) as failure:
        solver.advance_through(0.02 * np.arange(1, 1000))
    assert len(solver.take_rows()["time"]) == failure.value.step - 1 > 0
