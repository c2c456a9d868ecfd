"""The stages of a simulation, and what they leave in the run file."""

from __future__ import annotations

import json
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from coarse_slope import METHOD, SLOPE, STAGES, recording, simulate

import gimpslope as gs
from gimpslope.io.hdf5 import ENERGY, FIELDS, POINTS
from gimpslope.setup import Setup
from gimpslope.simulation import Simulation

SUMMARY_KEYS = {
    "smallest_gap_in_cells",
    "points",
    "steps",
    "steps_before_slide",
    "stones",
    "peak_kinetic_energy",
    "time_of_peak",
    "speed_at_peak",
    "max_speed",
    "max_displacement_total",
    "max_displacement_horizontal",
    "max_displacement_vertical",
    "toe",
    "final_kinetic_energy",
    "simulated_time",
    "wall_seconds",
    "point_steps_per_second",
}


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


def contents(path: Path) -> dict[str, Any]:
    """All datasets of a file, and its attributes but those that tell when and how fast."""
    found: dict[str, Any] = {}

    def visit(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = item[...].tobytes()
        for key, value in item.attrs.items():
            found[f"{name}.{key}"] = str(value)

    with h5py.File(path, "r") as file:
        file.visititems(visit)
        for key in file.attrs.keys() - {"created", "timing", "summary"}:
            found[f".{key}"] = str(file.attrs[key])
    return found


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> gs.Run:
    return simulate(
        tmp_path_factory.mktemp("run") / "slope.h5",
        energy_interval=0.01,
        snapshot_interval=0.5,
        snapshot_times=(1.6, 0.123, 99.0),
    )


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


def test_snapshots_at_the_times_asked_for(finished: gs.Run) -> None:
    expected = [0.0, 0.123, 0.5, 1.0, 1.5, 1.6, 2.0, 2.5, 3.0]
    np.testing.assert_allclose(finished.times, expected, rtol=1e-12)


def test_times_are_those_asked_for_to_the_last_bit(finished: gs.Run) -> None:
    assert finished.times.tolist() == [0.0, 0.123, 0.5, 1.0, 1.5, 1.6, 2.0, 2.5, 3.0]


def test_no_row_is_written_twice(finished: gs.Run) -> None:
    assert (np.diff(finished.energy.step) > 0).all()


def test_energy_rows_at_the_interval(finished: gs.Run) -> None:
    for stage in ("gravity", "settling"):
        steps = np.diff(finished.energy.stage(stage).time)
        np.testing.assert_allclose(steps, 0.01, rtol=1e-9)
    steps = np.diff(finished.energy.time)
    assert (steps > 0).all() and steps.max() < 0.01 * (1 + 1e-9)
    for time_ in finished.times:  # a row a snapshot, too
        assert np.abs(finished.energy.time - time_).min() < 1e-12


def test_snapshots_agree_with_the_energy_rows(finished: gs.Run) -> None:
    mass = finished.points.mass
    for time_ in finished.times:
        row = int(np.argmin(np.abs(finished.energy.time - time_)))
        snapshot = finished.snapshot(time_)
        kinetic = 0.5 * np.sum(mass * snapshot.speed**2)
        assert finished.energy.kinetic[row] == pytest.approx(kinetic, rel=1e-5)
        assert finished.energy.max_speed[row] == pytest.approx(snapshot.speed.max(), rel=1e-6)
        potential = 9.81 * np.sum(mass * snapshot.position[:, 1])
        assert finished.energy.potential[row] == pytest.approx(potential, rel=1e-6)


def test_the_slope_falls(finished: gs.Run) -> None:
    """Only what was potential or elastic energy can have become kinetic."""
    rows = finished.energy
    total = rows.kinetic + rows.potential + rows.elastic
    assert rows.potential[-1] < 0.9 * rows.potential[0]
    assert total.max() <= total[0] * (1 + 1e-6)


# The run file


def test_summary_has_its_keys_and_agrees_with_the_file(finished: gs.Run) -> None:
    summary: dict[str, Any] = finished.summary
    assert summary.keys() == SUMMARY_KEYS
    with h5py.File(finished.path, "r") as file:
        assert json.loads(file.attrs["summary"]) == summary
    final = finished.final
    moved = np.abs(final.displacement)
    assert summary["points"] == SLOPE.n_points and summary["stones"] == 0
    ends = [finished.energy.stage(stage).step[-1] for stage in ("settling", "slide")]
    assert summary["steps"] == sum(ends)
    assert summary["peak_kinetic_energy"] == finished.energy.kinetic.max()
    assert summary["final_kinetic_energy"] == finished.energy.kinetic[-1]
    assert summary["max_displacement_horizontal"] == moved[:, 0].max()
    assert summary["max_displacement_vertical"] == moved[:, 1].max()
    assert summary["max_displacement_total"] == pytest.approx(np.hypot(*moved.T).max())
    assert summary["toe"] == final.position[:, 0].max()
    assert summary["max_speed"] >= summary["speed_at_peak"] > 0
    rate = summary["points"] * summary["steps"] / summary["wall_seconds"]
    assert summary["point_steps_per_second"] == pytest.approx(rate)
    timing = finished.attributes["timing"]
    threads = finished.attributes["threads"]
    assert 0 < timing["processor_seconds"] < 1.1 * threads * timing["wall_seconds"] + 0.05


def test_file_is_complete_for_plain_h5py(finished: gs.Run) -> None:
    n, times = SLOPE.n_points, len(finished.times)
    with h5py.File(finished.path, "r") as file:
        rows = len(file["energy/time"])
        for name, quantity in POINTS.items():
            assert file["points"][name].shape == (n, *quantity.shape)
        for name in ENERGY:
            assert file["energy"][name].shape == (rows,)
        for name, quantity in FIELDS.items():
            assert file["snapshots"][name].shape == (times, n, *quantity.shape)
            assert file["final"][name].shape == (n, *quantity.shape)
            assert np.isfinite(file["final"][name]).all()
            np.testing.assert_allclose(
                file["snapshots"][name][-1], file["final"][name], rtol=1e-6, atol=1e-6
            )
        assert file.attrs["gimpslope_version"] == gs.__version__
        assert set(np.unique(file["energy/stage"])) == {0, 1, 2}


@pytest.mark.parametrize(
    ("scene", "given", "used"),
    [
        (SLOPE, None, "cell_average"),
        (SLOPE, "point", "point"),
        (block(), None, "point"),
        (block(), "cell_average", "cell_average"),
    ],
    ids=["soil", "soil_as_told", "elastic", "elastic_as_told"],
)
def test_file_tells_which_volume_strains_were_used(
    scene: gs.Scene, given: Any, used: str, tmp_path: Path
) -> None:
    """Also where the method leaves them to the materials, as the setup goes on to do."""
    method = gs.Method(volumetric_strain=given)
    run = simulate(tmp_path / "run.h5", scene=scene, method=method, duration=0.01)
    assert run.attributes["volumetric_strain"] == used
    assert run.method == method


def test_opened_while_h5py_reads_it(finished: gs.Run) -> None:
    with h5py.File(finished.path, "r"):
        assert gs.open(finished.path).status == "finished"


def test_parameters_come_back_from_the_file(finished: gs.Run) -> None:
    assert finished.scene == SLOPE
    assert finished.method == METHOD
    assert finished.stages == STAGES
    again = Simulation(finished.setup).solver
    np.testing.assert_array_equal(again.position, SLOPE.points.position)


def test_repeated_run_is_the_same_to_the_last_bit(finished: gs.Run, tmp_path: Path) -> None:
    again = finished.setup.simulate(tmp_path / "again.h5", progress=False)
    assert contents(again.path) == contents(finished.path)


def test_a_run_with_a_stone(tmp_path: Path) -> None:
    corners = np.array([(2.0, 1.6), (4.8, 1.6), (4.8, 3.2), (2.0, 3.2)])
    # A soft stone keeps the step large.
    stone = gs.DruckerPrager(2400, 200e6, 0.2, friction=42, cohesion=900e3)
    scene = replace(SLOPE, stones=[gs.Outline(corners)], stone=stone)
    run = simulate(tmp_path / "run.h5", scene=scene, duration=0.5)
    assert run.scene == scene
    assert run.summary["stones"] == 1
    held = run.points.material == 1
    assert held.sum() == np.count_nonzero(scene.stones[0].contains(scene.points.position))
    np.testing.assert_array_equal(run.points.mass, scene.points.mass)
    strain = run.final.plastic_strain
    assert strain[held].max() == 0 < strain[~held].max()
    with h5py.File(run.path, "r") as file:
        assert list(file["points"].attrs["material_names"]) == ["soil", "stone"]


def test_simulations_in_turns_do_not_touch_each_other(tmp_path: Path) -> None:
    def make() -> list[Simulation]:
        soft = replace(SLOPE, soil=replace(SLOPE.soil, young=20e6), cell=1.0)
        short = replace(STAGES, slide=gs.Slide(0.4))
        return [Simulation(Setup(scene, METHOD, short)) for scene in (SLOPE, soft)]

    alone = []
    for number, simulation in enumerate(make()):
        with recording(simulation, tmp_path / f"alone{number}.h5") as recorder:
            for stage in ("load", "settle", "release", "slide"):
                getattr(simulation, stage)(recorder)
        alone.append(contents(tmp_path / f"alone{number}.h5"))
    first, second = make()
    with (
        recording(first, tmp_path / "turn0.h5") as one,
        recording(second, tmp_path / "turn1.h5") as other,
    ):
        for stage in ("load", "settle", "release", "slide"):
            getattr(first, stage)(one)
            getattr(second, stage)(other)
    assert [contents(tmp_path / f"turn{number}.h5") for number in (0, 1)] == alone


def test_simulations_in_threads_do_not_touch_each_other(finished: gs.Run, tmp_path: Path) -> None:
    options = {
        "energy_interval": 0.01,
        "snapshot_interval": 0.5,
        "snapshot_times": (1.6, 0.123, 99.0),
    }
    paths = [tmp_path / "a.h5", tmp_path / "b.h5"]
    workers = [threading.Thread(target=simulate, args=[p], kwargs=options) for p in paths]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(timeout=20)
    expected = contents(finished.path)
    assert [contents(path) == expected for path in paths] == [True, True]


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
