"""What a simulation leaves in its run file, and that it is the same again."""

from __future__ import annotations

import json
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from coarse_slope import METHOD, SLOPE, STAGES, recording, simulate, simulate_whole

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


ELASTIC = replace(SLOPE, soil=gs.Elastic(density=1800, young=30e6, poisson=0.33))


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
    return simulate_whole(tmp_path_factory.mktemp("run") / "slope.h5")


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
        (ELASTIC, None, "point"),
        (ELASTIC, "cell_average", "cell_average"),
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
