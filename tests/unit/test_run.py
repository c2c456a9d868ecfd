"""Analysis of a run whose motion is known by formula."""

from __future__ import annotations

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import synthetic_run as synthetic

from gimpslope.method import Method
from gimpslope.run import Run, open
from gimpslope.stages import Stages
from gimpslope.summary import summarise

REACH = synthetic.travel(synthetic.END) * synthetic.SHARE.max()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return synthetic.write_run(tmp_path_factory.mktemp("run") / "run.h5")


def test_parameters_come_back(run: Run) -> None:
    assert open(run.path).status == "finished"
    assert run.status_detail == "the duration was reached"
    assert run.scene.to_dict() == synthetic.SCENE.to_dict()
    assert run.method == Method()
    assert run.stages == Stages()
    assert run.trigger["energy_released"] == 12.5
    assert len(run.points) == synthetic.SCENE.n_points


def test_energy_of_each_stage(run: Run) -> None:
    np.testing.assert_allclose(run.energy.kinetic, synthetic.kinetic(run.energy.time))
    assert run.energy.time[0] == 0 and run.energy.time[-1] == pytest.approx(synthetic.END)
    assert len(run.energy.stage("gravity")) == 5
    assert len(run.energy.stage("settling")) == 3
    with pytest.raises(ValueError, match=r"'gravity', 'settling', 'slide'.*'fall'"):
        run.energy.stage("fall")


def test_peak(run: Run) -> None:
    peak = run.energy.peak
    assert peak.time == pytest.approx(synthetic.END / 2)
    assert peak.value == pytest.approx(synthetic.kinetic(synthetic.END / 2))
    fastest = synthetic.SHARE.max() * np.sqrt(5)
    assert run.energy.speed_at_peak == pytest.approx(fastest)


def test_snapshot_fields(run: Run) -> None:
    snapshot = run.snapshot(1.0)
    expected = synthetic.fields(1.0)
    speed = np.hypot(*expected["velocity"].T)
    np.testing.assert_allclose(snapshot.speed, speed, rtol=1e-6)
    np.testing.assert_allclose(snapshot.displacement, synthetic.displacement(1.0), atol=1e-6)
    density = synthetic.POINTS.mass / expected["volume"]
    np.testing.assert_allclose(snapshot.density, density, rtol=1e-6)


def test_the_nearest_snapshot_is_taken(run: Run) -> None:
    assert len(run.times) == 17
    assert run.snapshot(1.1).time == 1.0
    assert run.snapshot(1.2).time == 1.25
    assert run.snapshot(4.002).time == 4.0


@pytest.mark.parametrize("time", [-0.1, 4.1, float("nan")])
def test_times_outside_of_the_run_are_refused(run: Run, time: float) -> None:
    with pytest.raises(ValueError, match=r"time must be a.*number.*got"):
        run.snapshot(time)


def test_displacement(run: Run) -> None:
    np.testing.assert_allclose(run.displacement(), synthetic.displacement(synthetic.END))
    np.testing.assert_allclose(run.displacement(1.0), synthetic.displacement(1.0), atol=1e-6)
    largest = run.max_displacement()
    assert largest.total == pytest.approx(np.sqrt(5) * REACH)
    assert largest.horizontal == pytest.approx(2 * REACH)
    assert largest.vertical == pytest.approx(REACH)


def test_plastic_zone_is_the_soil_above_the_threshold(run: Run) -> None:
    strain = synthetic.fields(1.0)["plastic_strain"]
    assert 0 < np.sum(strain > 0.01) < np.sum(strain > 0.001)
    np.testing.assert_array_equal(run.plastic_zone(1.0), strain > 0.01)
    np.testing.assert_array_equal(run.plastic_zone(1.0, threshold=0.05), strain > 0.05)
    assert not run.plastic_zone(4.0, threshold=0.0)[synthetic.POINTS.material == 1].any()
    with pytest.raises(ValueError, match="threshold"):
        run.plastic_zone(1.0, threshold=-1.0)


def test_summary(run: Run) -> None:
    moved = synthetic.fields(synthetic.END)["position"]
    expected = {
        "points": synthetic.SCENE.n_points,
        "steps": 400 + 200 + 4000,
        "stones": 1,
        "peak_kinetic_energy": synthetic.kinetic(2.0),
        "time_of_peak": 2.0,
        "speed_at_peak": synthetic.SHARE.max() * np.sqrt(5),
        "max_speed": synthetic.SHARE.max() * np.sqrt(5),
        "max_displacement_total": np.sqrt(5) * REACH,
        "max_displacement_horizontal": 2 * REACH,
        "max_displacement_vertical": REACH,
        "toe": moved[:, 0].max(),
        "final_kinetic_energy": 0.0,
        "simulated_time": synthetic.END,
        "wall_seconds": 2.0,
        "point_steps_per_second": 500.0,
    }
    assert summarise(run) == pytest.approx(expected, abs=1e-9)
    assert json.loads(json.dumps(run.summary)) == run.attributes["summary"]


def test_a_killed_run_is_summarised_from_its_last_snapshot(tmp_path: Path) -> None:
    run = synthetic.write_run(tmp_path / "run.h5", until=1.0, finished=False)
    summary = run.summary
    assert run.status == "running"
    assert run.final.time == 1.0
    assert summary["simulated_time"] == pytest.approx(1.0)
    moved = synthetic.displacement(1.0)
    assert summary["max_displacement_vertical"] == pytest.approx(np.abs(moved[:, 1]).max())
    assert summary["wall_seconds"] is None


def test_a_run_killed_before_the_slide(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "run.h5")
    writer.append_energy(synthetic.energy_rows(0, np.arange(0, 0.5, 0.1)))
    writer.flush()
    run = Run(writer.path)
    assert run.summary["steps"] == 400
    assert run.summary["time_of_peak"] is None and run.summary["toe"] is None
    assert "not recorded" in run._repr_html_()
    for ask in (lambda: run.points, lambda: run.final, lambda: run.energy.peak):
        with pytest.raises(ValueError, match=r"run.h5"):
            ask()


def test_a_run_can_be_read_while_it_is_written(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "run.h5")
    synthetic.write_points(writer)
    run = Run(writer.path)
    for time in (0.0, 0.25):
        writer.append_snapshot(time, synthetic.fields(time))
        writer.flush()
        assert run.times[-1] == time


def test_table_for_notebooks(run: Run) -> None:
    table = run._repr_html_()
    assert "run.h5: finished" in table
    assert "<td>2.000 s</td>" in table
    assert repr(run).endswith("run.h5': finished>")


def test_a_snapshot_goes_through_meshio(run: Run, tmp_path: Path) -> None:
    state = run.snapshot(synthetic.END)
    state.to_meshio().write(tmp_path / "end.vtu")
    mesh = meshio.read(tmp_path / "end.vtu")
    np.testing.assert_array_equal(mesh.points[:, :2], state.position)
    np.testing.assert_array_equal(mesh.point_data["stress"], state.stress)
    np.testing.assert_array_equal(mesh.point_data["displacement"][:, :2], state.displacement)
    np.testing.assert_array_equal(mesh.point_data["density"], state.density)
