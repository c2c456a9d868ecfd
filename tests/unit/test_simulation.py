"""The stages of a simulation, from gravity to the end of the slide."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from coarse_slope import METHOD, SLOPE, STAGES, recording, simulate, simulate_whole

import gimpslope as gs
from gimpslope.setup import Setup
from gimpslope.simulation import Simulation

HEIGHT, WIDTH = 4.0, 2.0
ROCK = gs.Elastic(density=2000, young=1e9, poisson=0.3)
WEIGHT = ROCK.density * 9.81  # N/m3
CONSTRAINED = ROCK.bulk_modulus + 4 / 3 * ROCK.shear_modulus  # Pa
FULL_ELASTIC = WIDTH * WEIGHT**2 * HEIGHT**3 / (6 * CONSTRAINED)  # J/m


def block(cell: float = 0.5) -> gs.Scene:
    """Rock between rollers: it can only shorten, so that the exact solution is that of a bar."""
    corners = np.array([(0.0, 0.0), (WIDTH, 0.0), (WIDTH, HEIGHT), (0.0, HEIGHT)])
    walls = gs.Walls(gs.Roller(), gs.Roller(), gs.Roller(), gs.Free())
    return gs.Scene(gs.Outline(corners), ROCK, cell=cell, walls=walls)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> gs.Run:
    return simulate_whole(tmp_path_factory.mktemp("run") / "slope.h5")


# Gravity and settling


def test_gravity_grows_linearly(tmp_path: Path) -> None:
    """Elastic energy then grows with the square of time, apart from a swing about equilibrium.

    A bar under a load that grows over the time T swings with at most 1/(omega T) of its load, and
    at first with all it carries; energy is quadratic, so twice that share. The mesh takes
    1/(4 n^2) of the energy of n cells: the stress of a cell is constant.
    """
    ramp = 0.5
    swing = 1 / (ROCK.wave_speed * np.pi / (2 * HEIGHT) * ramp)
    run = simulate(
        tmp_path / "run.h5", scene=block(), stages=gs.Stages(gs.Gravity(ramp)), duration=0.01
    )
    rows = run.energy.stage("gravity")
    assert rows.time[0] == 0 and rows.time[-1] == pytest.approx(ramp, abs=1e-12)
    expected = (rows.time / ramp) ** 2
    np.testing.assert_allclose(
        rows.elastic / FULL_ELASTIC, expected, atol=2 * swing + 1 / (4 * 8**2), rtol=0
    )


@pytest.mark.parametrize("cell", [0.5, 0.25])
@pytest.mark.parametrize(
    "settling",
    [gs.Settling(1e-10), gs.Settling(1e-14, damping="local"), gs.Settling(unbalanced=1e-4)],
    ids=["kinetic", "local", "static"],
)
def test_confined_block_settles_to_the_exact_solution(
    settling: gs.Settling, cell: float, tmp_path: Path
) -> None:
    """sigma_yy = -rho g (H - y) in the mean of each cell, and at no point off by more than half a
    point's weight, since the two rows of a cell share one strain. Swinging at the ratio r leaves
    rho c sqrt(2 r g H) at most, which is 1e-5 of the stress at the base for r = 1e-14; kinetic
    damping ends far below its ratio; forces off by a share of the weight in all change the stress
    at the base by no more than that. Confinement makes sigma_xx = sigma_zz = nu/(1 - nu) sigma_yy,
    exact but for the single precision of snapshots, 6e-8."""
    scene = block(cell)
    stages = gs.Stages(gs.Gravity(0.1), settling, gs.Slide(0.01))
    run = simulate(tmp_path / "run.h5", scene=scene, stages=stages)
    xx, yy, zz, xy = run.snapshot(0.0).stress.T
    y = scene.points.position[:, 1]
    base = WEIGHT * HEIGHT
    off = (yy + WEIGHT * (HEIGHT - y)) / base
    in_cell = off.reshape(round(HEIGHT / cell), 2, -1).mean(axis=1)
    np.testing.assert_allclose(in_cell, 0, atol=1e-3)
    np.testing.assert_allclose(off, 0, atol=scene.spacing / 2 / HEIGHT + 1e-3)
    ratio_0 = ROCK.poisson / (1 - ROCK.poisson)
    np.testing.assert_allclose(xx / base, ratio_0 * yy / base, atol=2e-7)
    np.testing.assert_allclose(zz / base, ratio_0 * yy / base, atol=2e-7)
    np.testing.assert_allclose(xy / base, 0, atol=1e-9)
    assert run.trigger["energy_released"] == 0


def test_at_rest_for_as_long_as_waves_cross_twice(finished: gs.Run) -> None:
    rows = finished.energy.stage("settling")
    ratio = rows.kinetic / rows.potential
    crossing = 2 * np.hypot(11, 9) / SLOPE.soil.wave_speed
    at_rest = rows.time > rows.time[-1] - crossing
    assert rows.time[-1] - rows.time[0] >= crossing
    assert (ratio[at_rest] <= STAGES.settling.ratio).all()
    assert finished.trigger["settling_ratio"] == pytest.approx(ratio[-1], rel=1e-12)
    assert finished.trigger["settling_time"] == pytest.approx(rows.time[-1] - rows.time[0])


def test_a_slope_that_does_not_settle_is_an_error(tmp_path: Path) -> None:
    stages = replace(STAGES, settling=gs.Settling(ratio=1e-30, limit=0.4))
    with pytest.raises(gs.NotSettledError, match=r"limit = 0\.4 s.*not stayed below ratio = 1e-30"):
        simulate(tmp_path / "run.h5", stages=stages)
    run = gs.open(tmp_path / "run.h5")
    assert run.status == "failed"
    assert "NotSettledError" in run.status_detail and "limit = 0.4" in run.status_detail
    assert run.energy.stage("settling").time[-1] == pytest.approx(0.3 + 0.4, abs=0.006)
    assert len(run.energy) == 0 and run.trigger == {}
    assert run.summary["peak_kinetic_energy"] is None


def test_a_limit_below_the_crossing_time_is_told_as_it_is(tmp_path: Path) -> None:
    stages = replace(STAGES, settling=gs.Settling(ratio=1e-6, limit=0.1))
    with pytest.raises(gs.NotSettledError, match=r"limit = 0\.1 s.* for 0\.181 s, in which a wave"):
        simulate(tmp_path / "run.h5", stages=stages)


def test_a_slope_that_falls_is_not_at_rest(tmp_path: Path) -> None:
    falling = replace(SLOPE, walls=gs.Walls(gs.Free(), gs.Free(), gs.Free(), gs.Free()))
    stages = replace(STAGES, settling=gs.Settling(limit=1.5))
    with pytest.raises(gs.NotSettledError):
        simulate(tmp_path / "run.h5", scene=falling, stages=stages)


# The trigger


def test_trigger_starts_anew_and_records_the_energy_released(tmp_path: Path) -> None:
    simulation = Simulation(Setup(SLOPE, METHOD, STAGES))
    solver = simulation.solver
    with recording(simulation, tmp_path / "run.h5") as recorder:
        simulation.load(recorder)
        simulation.settle(recorder)
        assert solver.time > STAGES.gravity.ramp and solver.steps > 0
        assert (solver.plastic_strain == 0).all()
        elastic, stress, position = solver.energies().elastic, solver.stress, solver.position
        simulation.release(recorder)
    assert solver.time == 0 and solver.steps == 0
    returned = gs.kernel.return_mapping(SLOPE.soil, stress)
    np.testing.assert_allclose(solver.stress, returned.stress, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(solver.plastic_strain, returned.plastic_strain, atol=1e-14)
    run = gs.open(tmp_path / "run.h5")
    released = run.trigger["energy_released"]
    assert released > 0.001 * elastic
    assert released == pytest.approx(elastic - solver.energies().elastic, rel=1e-9)
    np.testing.assert_array_equal(run.points.position, position)


def test_slide_starts_at_zero(finished: gs.Run) -> None:
    assert finished.energy.time[0] == 0 and finished.energy.step[0] == 0
    assert finished.times[0] == 0
    # Snapshots are in single precision: half an ulp of 11 m.
    assert finished.max_displacement(0.0).total < 1e-6
    assert finished.energy.elastic[0] < finished.energy.stage("settling").elastic[-1]


# The slide


def test_slide_ends_at_its_duration(finished: gs.Run) -> None:
    assert finished.status == "finished" and "3 s" in finished.status_detail
    assert finished.energy.time[-1] == pytest.approx(3.0, abs=1e-12)
    assert finished.final.time == pytest.approx(3.0, abs=1e-12)
    assert finished.summary["simulated_time"] == pytest.approx(3.0, abs=1e-12)


def test_duration_overrides_that_of_the_stages(tmp_path: Path) -> None:
    run = simulate(tmp_path / "run.h5", duration=0.1)
    assert run.final.time == pytest.approx(0.1, abs=1e-12)
    assert run.stages == replace(STAGES, slide=gs.Slide(0.1))


def test_slide_ends_at_rest(tmp_path: Path) -> None:
    stages = replace(STAGES, slide=gs.Slide(5.0, rest_ratio=0.7, rest_time=0.0))
    run = simulate(tmp_path / "run.h5", stages=stages)
    share = run.energy.kinetic / np.maximum.accumulate(run.energy.kinetic)
    assert share[-1] < 0.7 and (share[:-1] >= 0.7).all()
    assert 1.0 < run.final.time < 5.0
    assert run.status == "finished" and "at rest" in run.status_detail
    assert run.final.time == run.energy.time[-1]


def test_slide_ends_when_the_fastest_point_and_the_energy_have_rested(tmp_path: Path) -> None:
    slide = gs.Slide(5.0, rest_ratio=0.7, rest_speed=1.0, rest_time=0.2)
    run = simulate(tmp_path / "run.h5", stages=replace(STAGES, slide=slide))
    energy = run.energy
    rests = [
        slide.rests(kinetic, peak, speed)
        for kinetic, peak, speed in zip(
            energy.kinetic, np.maximum.accumulate(energy.kinetic), energy.max_speed, strict=True
        )
    ]
    last_unrest = energy.time[np.flatnonzero(~np.array(rests))[-1]]
    interval = energy.time[-1] - energy.time[-2]
    assert 0.2 - 1e-9 <= energy.time[-1] - last_unrest < 0.2 + 1.01 * interval
    assert energy.max_speed[-1] < 1.0 < energy.max_speed.max()
    assert run.final.time < 5.0 and "at rest" in run.status_detail


def test_the_slope_falls(finished: gs.Run) -> None:
    """Only what was potential or elastic energy can have become kinetic."""
    rows = finished.energy
    total = rows.kinetic + rows.potential + rows.elastic
    assert rows.potential[-1] < 0.9 * rows.potential[0]
    assert total.max() <= total[0] * (1 + 1e-6)


# What must not change the result


@pytest.mark.parametrize("wall", [gs.Coulomb(0.0), gs.Coulomb(0.6)])
def test_a_block_rests_on_a_coulomb_wall(wall: gs.Coulomb, tmp_path: Path) -> None:
    """Rounding must not swing it up: its energy stays, to a millionth of what is stored in it, and
    no point moves by more than a twentieth of its settlement."""
    rock = gs.Elastic(density=1800, young=30e6, poisson=0.33)
    stiffness = rock.bulk_modulus + 4 / 3 * rock.shear_modulus
    block = gs.Outline(np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]))
    walls = gs.Walls(gs.Free(), gs.Free(), wall, gs.Free())
    scene = gs.Scene(block, rock, cell=0.1, walls=walls)
    run = gs.simulate(scene, 6.0, output=tmp_path / "run.h5", progress=False)
    total = run.energy.kinetic + run.energy.potential + run.energy.elastic
    assert np.ptp(total) < 1e-6 * run.energy.potential[0]
    assert run.energy.kinetic.max() < 1e-9 * run.energy.potential[0]
    settlement = 1800 * 9.81 * 1.0**2 / (2 * stiffness)
    assert abs(run.final.displacement[:, 1]).max() < 0.05 * settlement


@pytest.mark.parametrize("method", [gs.Method(), gs.Method(viscosity=0.2)])
def test_looking_more_often_changes_little(method: gs.Method, tmp_path: Path) -> None:
    """Steps are shortened to end at a row. Their blend goes with them, so that 20 times as many
    rows do not damp more; what is left is the error of the step itself, at most a few per cent."""
    soil = gs.DruckerPrager(1800, 30e6, 0.33, friction=22, cohesion=1e3)
    scene = gs.Scene(gs.Outline.slope(height=3, crest=1), soil, cell=0.25)
    peaks = [
        gs.simulate(
            scene,
            1.0,
            method=method,
            output=tmp_path / f"{interval}.h5",
            energy_interval=interval,
            progress=False,
        ).energy.peak.value
        for interval in (5e-3, 2.5e-4)
    ]
    assert peaks[1] == pytest.approx(peaks[0], rel=0.03)
