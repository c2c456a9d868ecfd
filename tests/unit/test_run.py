"""Analysis of a run whose motion is known by formula."""

from __future__ import annotations

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import synthetic_run as synthetic

from gimpslope.analysis import first_outlines
from gimpslope.method import Method
from gimpslope.run import Run, open
from gimpslope.stages import Stages
from gimpslope.studies import comparison, reference
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


def test_plastic_shares_are_of_soil_and_of_stone(run: Run) -> None:
    soil, mass = synthetic.POINTS.stone < 0, synthetic.POINTS.mass
    above = soil & (synthetic.fields(1.0)["plastic_strain"] > 0.01)
    share = run.plastic_share(1.0)
    assert share.soil == pytest.approx(mass[above].sum() / mass[soil].sum())
    assert 0.1 < share.soil < 0.9
    assert share.stone == 0.0
    assert run.plastic_share(1.0, threshold=1e9).soil == 0.0
    strain = synthetic.fields(1.0)["plastic_strain"]
    np.testing.assert_allclose(run.plastic_strain(1.0), strain, rtol=1e-6)


def test_all_that_is_plastic_is_one_band(run: Run) -> None:
    """The strain grows to the right, so that the plastic zone is all to the right of some line."""
    bands = run.plastic_bands(1.0, least=0.0)
    zone = run.plastic_zone(1.0)
    assert len(bands) == 1
    np.testing.assert_array_equal(bands.label == 0, zone)
    volume = synthetic.fields(1.0)["volume"]
    assert bands.area == pytest.approx([volume[zone].sum()])
    assert len(run.plastic_bands(1.0, least=100.0)) == len(run.plastic_bands(1.0, 1e9)) == 0


def test_phases(run: Run, tmp_path: Path) -> None:
    """The kinetic energy goes with the square of a sine over half its period."""
    phases = run.phases()
    assert phases.peak == pytest.approx(synthetic.END / 2)
    rest = synthetic.END * (1 - np.arcsin(0.1) / np.pi)
    assert phases.rest == pytest.approx(rest, abs=1e-4)
    assert run.phases(share=0.25).rest == pytest.approx(synthetic.END * 5 / 6, abs=1e-4)
    early = synthetic.write_run(tmp_path / "early.h5", until=1.0, finished=False)
    assert early.phases() == (None, None, pytest.approx(1.0))


def test_the_fastest_point_is_the_one_farthest_right(run: Run) -> None:
    number = int(np.argmax(synthetic.SHARE))
    start, speed = synthetic.POINTS.position[number], np.sqrt(5) * synthetic.SHARE.max()
    at_peak = run.fastest("peak")
    assert (at_peak.time, at_peak.number) == (2.0, number)
    assert at_peak.speed == pytest.approx(speed)
    assert at_peak.position == pytest.approx(tuple(start + synthetic.displacement(2.0)[number]))
    assert run.fastest_ever() == at_peak
    assert run.fastest(1.0).speed == pytest.approx(speed * synthetic.rate(1.0))
    assert run.fastest().speed == pytest.approx(0.0, abs=1e-9)


def test_the_peak_is_a_time_everywhere(run: Run) -> None:
    assert run.snapshot("peak").time == run.state("peak").time == 2.0
    np.testing.assert_array_equal(run.displacement("peak"), run.displacement(2.0))
    with pytest.raises(TypeError, match=r"time must be a finite number.*'top'"):
        run.snapshot("top")  # type: ignore[arg-type]


def test_displacement_and_run_out_by_percentile(run: Run) -> None:
    mass, moved = synthetic.POINTS.mass, synthetic.displacement(synthetic.END)
    for percentile in (50.0, 99.0):
        limit = run.max_displacement(percentile=percentile).horizontal
        assert mass[moved[:, 0] <= limit + 1e-9].sum() >= percentile / 100 * mass.sum()
        assert mass[moved[:, 0] < limit - 1e-9].sum() < percentile / 100 * mass.sum()
    assert run.max_displacement(percentile=100.0) == pytest.approx(run.max_displacement())
    assert run.run_out() == pytest.approx(2 * REACH)
    assert 0 < run.run_out(percentile=99) < run.run_out()
    assert run.run_out(0.0) == 0.0


def test_surface_at_the_start_is_the_outline(run: Run) -> None:
    """Level at 3 m up to x = 1 m, then down at 45 degrees; cells of 0.2 m, their steps included."""
    surface = run.surface(0.0, width=0.2)
    np.testing.assert_allclose(surface.x, np.arange(20) * 0.2 + 0.1)
    np.testing.assert_allclose(surface.y[:5], 3.0)
    assert np.abs(surface.y[5:] - (4 - surface.x[5:])).max() <= 0.1 + 1e-9
    assert run.surface(0.0).width == pytest.approx(0.4)  # two cells
    assert len(run.surface(0.0).x) == 10
    assert surface.between(1.0, 4.0).roughness(1.0) < 1e-9
    assert surface.roughness(1.0) > 0.01


def test_stones_at_rest_stay_where_they_are(run: Run) -> None:
    motion = run.stone_motion()
    assert motion.rotation.shape == (17, 1)
    np.testing.assert_allclose(motion.time, run.times)
    for still in (motion.rotation, motion.deformation, motion.translation):
        np.testing.assert_allclose(still, 0.0, atol=1e-9)
    np.testing.assert_allclose(motion.centroid[0], [(0.75, 0.75)])
    np.testing.assert_allclose(run.stone_outlines(3.0), first_outlines(run.scene), atol=1e-12)


def test_snapshots_come_in_order(run: Run, tmp_path: Path) -> None:
    assert [state.time for state in run.snapshots()] == run.times.tolist()
    empty = Run(synthetic.new_writer(tmp_path / "run.h5").path)
    with pytest.raises(ValueError, match=r"must have snapshots.*run\.h5"):
        empty.snapshots()


def test_summary(run: Run) -> None:
    moved = synthetic.fields(synthetic.END)["position"]
    expected = {
        "points": synthetic.SCENE.n_points,
        "steps": 400 + 200 + 4000,
        "steps_before_slide": 400 + 200,
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
    summary = summarise(run)
    assert summary.pop("smallest_gap_in_cells") is None, "there is one stone"
    assert summary == pytest.approx(expected, abs=1e-9)
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


def test_a_peak_that_may_be_to_come_is_none(tmp_path: Path) -> None:
    run = synthetic.write_run(tmp_path / "run.h5", until=1.0)
    summary = run.summary
    assert run.phases().peak is None
    assert summary["time_of_peak"] is None and summary["speed_at_peak"] is None
    assert summary["peak_kinetic_energy"] == pytest.approx(synthetic.kinetic(1.0))
    assert run.attributes["summary"] == summary
    assert run._repr_html_().count("<td>still growing</td>") == 2
    shown = comparison.text("early", summary, {"time_of_peak": 1.6, "speed_at_peak": 3.0})
    _, *of_peak, total = shown.splitlines()[:5]
    assert [line.split()[-3:] for line in of_peak] == [
        [paper, "still", "growing"] for paper in ("1.6", "-", "3")
    ]
    assert "still" not in total
    for line in comparison.text("whole", run.summary, {}).splitlines()[1:4]:
        assert "still growing" in line


@pytest.mark.parametrize(
    ("gap", "told"),
    [
        (
            1.031,
            "The nearest two stones are 1.03 cells apart; closer than two cells deformable ones",
        ),
        (7.28, "The nearest two stones are 7.28 cells apart.\n"),
    ],
)
def test_stones_that_share_nodes_are_told(run: Run, gap: float, told: str) -> None:
    assert told in comparison.text("stones", run.summary | {"smallest_gap_in_cells": gap}, {})
    assert "stones are" not in comparison.text("one stone", run.summary, {})


def test_the_papers_lower_bound_is_told_as_one() -> None:
    assert reference.published("speed_at_peak", 3.0) == "> 3"
    assert reference.published("time_of_peak", 1.6) == "1.6"


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
    np.testing.assert_array_equal(mesh.point_data["stress"][:, :4], state.stress)
    np.testing.assert_array_equal(mesh.point_data["displacement"][:, :2], state.displacement)
    np.testing.assert_array_equal(mesh.point_data["density"], state.density)
