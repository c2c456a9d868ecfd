"""The run file: what is in it, what is refused, and that it survives whatever stops the writer."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
import synthetic_run as synthetic

from gimpslope.io import atomic, hdf5

WRITE_WITHOUT_END = """
import sys
from pathlib import Path
import numpy as np
import synthetic_run as synthetic

writer = synthetic.new_writer(Path(sys.argv[1]))
synthetic.write_points(writer)
number = 0
while True:
    times = 0.01 * np.arange(10 * number, 10 * number + 10)
    writer.append_energy(synthetic.energy_rows(2, times))
    writer.append_snapshot(times[0], synthetic.fields(times[0]))
    writer.append_energy(synthetic.energy_rows(2, times))
    writer.flush()
    number += 1
    print(number, flush=True)
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return synthetic.write_run(tmp_path_factory.mktemp("run") / "run.h5").path


def test_root_attributes_describe_the_run(path: Path) -> None:
    with h5py.File(path, "r") as file:
        assert file.attrs["format"] == "gimpslope run"
        assert file.attrs["format_version"] == 3
        assert file.attrs["gimpslope_version"] == "0.0.0"
        assert file.attrs["created"].endswith("+00:00")
        assert file.attrs["status"] == "finished"
        assert file.attrs["status_detail"] == "the duration was reached"
        assert json.loads(file.attrs["scene"]) == synthetic.SCENE.to_dict()
        assert json.loads(file.attrs["summary"])["points"] == synthetic.SCENE.n_points
        assert file.attrs["threads"] == 1


def test_every_dataset_has_units_and_a_description(path: Path) -> None:
    def check(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            assert item.attrs["units"] and item.attrs["description"], name

    with h5py.File(path, "r") as file:
        file.visititems(check)


def test_layout_of_the_datasets(path: Path) -> None:
    n = synthetic.SCENE.n_points
    with h5py.File(path, "r") as file:
        assert len({len(column) for column in file["energy"].values()}) == 1
        assert file["energy/stage"].dtype == np.uint8
        assert file["points/material"].dtype.kind == "i"
        assert list(file["points"].attrs["material_names"]) == ["soil", "stone"]
        assert file["snapshots/stress"].shape == (17, n, 4)
        assert file["snapshots/stress"].chunks == (1, n, 4)
        assert file["snapshots/volume"].dtype == np.float32
        assert file["final/position"].dtype == np.float64
        assert file["final"].attrs["time"] == synthetic.END


def test_values_come_back_in_the_given_order(path: Path) -> None:
    assert hdf5.read_snapshot_times(path)[4] == 1.0
    for name, expected in synthetic.fields(1.0).items():
        np.testing.assert_allclose(hdf5.read_snapshot(path, 4)[name], expected, rtol=1e-6)
    end, final = hdf5.read_final(path) or pytest.fail("no final state")
    assert end == synthetic.END
    for name, expected in synthetic.fields(end).items():
        np.testing.assert_array_equal(final[name], expected)
    np.testing.assert_array_equal(hdf5.read_points(path)["mass"], synthetic.POINTS.mass)
    with h5py.File(path) as file:
        assert list(file["points"].attrs["material_names"]) == ["soil", "stone"]
    assert hdf5.read_trigger(path) == {
        "energy_released": 12.5,
        "settling_time": 0.2,
        "settling_ratio": 1e-7,
        "settling_unbalanced": 1e-4,
    }


def test_parameters_larger_than_an_hdf5_attribute_header(tmp_path: Path) -> None:
    text = json.dumps("x" * 1_000_000)
    hdf5.RunWriter(
        tmp_path / "a.h5",
        setup=dict.fromkeys(hdf5.SETUP, "{}") | {"scene": text},
        version="0",
        instruction_set="none",
        threads=1,
        volumetric_strain="point",
    )
    assert hdf5.read_attributes(tmp_path / "a.h5")["scene"] == json.loads(text)


def test_points_can_be_replaced_at_the_trigger(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    synthetic.write_points(writer)
    points = synthetic.POINTS
    moved = points.position - 0.01
    rest = (points.mass, points.volume, points.half_length, points.material, points.stone)
    writer.write_points(moved, *rest, ("soil", "stone"))
    np.testing.assert_array_equal(hdf5.read_points(writer.path)["position"], moved)


def test_rows_wait_for_the_flush(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    writer.append_energy(synthetic.energy_rows(0, np.arange(3.0)))
    writer.append_energy(synthetic.energy_rows(0, np.arange(3.0, 5.0)))
    assert len(hdf5.read_energy(writer.path)["time"]) == 0
    writer.flush()
    writer.flush()
    np.testing.assert_array_equal(hdf5.read_energy(writer.path)["time"], np.arange(5.0))


def test_a_file_that_is_not_empty_is_refused_and_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    path.write_text("precious")
    with pytest.raises(FileExistsError, match=r"a.h5"):
        synthetic.new_writer(path)
    assert path.read_text() == "precious"
    synthetic.new_writer(path, overwrite=True)
    assert hdf5.read_attributes(path)["status"] == "running"


def test_an_empty_file_is_used(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    path.touch()
    synthetic.new_writer(path)
    assert hdf5.read_attributes(path)["status"] == "running"


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"output must be .*nowhere"):
        synthetic.new_writer(tmp_path / "nowhere" / "a.h5")


def test_wrong_names_shapes_and_statuses_are_refused(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    synthetic.write_points(writer)
    fields = synthetic.fields(0.0)
    with pytest.raises(ValueError, match="position, velocity"):
        writer.append_snapshot(0.0, {"position": fields["position"]})
    with pytest.raises(ValueError, match="velocity must have shape"):
        writer.append_snapshot(0.0, fields | {"velocity": np.zeros(2)})
    with pytest.raises(ValueError, match="kinetic must have shape"):
        writer.append_energy(synthetic.energy_rows(0, np.arange(3.0)) | {"kinetic": np.zeros(2)})
    with pytest.raises(ValueError, match="status must be one of running, finished"):
        writer.finish("done", "")
    assert len(hdf5.read_snapshot_times(writer.path)) == 0


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"absent.h5"):
        hdf5.read_attributes(tmp_path / "absent.h5")
    (tmp_path / "text.h5").write_text("no")
    with pytest.raises(ValueError, match=r"text.h5.*not HDF5"):
        hdf5.read_attributes(tmp_path / "text.h5")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file.attrs["format"] = "other"
    with pytest.raises(ValueError, match=r"other.h5.*'other'"):
        hdf5.read_attributes(tmp_path / "other.h5")


def test_a_damaged_file_is_named(path: Path, tmp_path: Path) -> None:
    whole, cut = path.read_bytes(), tmp_path / "cut.h5"
    cut.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ValueError, match=r"path must name a whole run file, .*cut\.h5.* damaged: "):
        hdf5.read_attributes(cut)


def test_errors_of_the_system_are_no_damage(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(13, "not for you")

    monkeypatch.setattr(h5py, "File", refused)
    with pytest.raises(PermissionError):
        hdf5.read_attributes(path)


def test_a_failed_change_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    before = writer.path.read_bytes()
    with pytest.raises(RuntimeError), atomic.change(writer.path) as file:
        file["energy/time"].resize(10, axis=0)
        file["energy/time"][:] = 1.0
        raise RuntimeError
    assert writer.path.read_bytes() == before


def test_every_prefix_of_a_change_can_be_read(tmp_path: Path) -> None:
    """Stop after each single write to the disk, as a kill would, for all sorts of changes."""
    writer = synthetic.new_writer(tmp_path / "a.h5")
    states = _states_on_disk(writer)
    assert len(states) > 100
    copy = tmp_path / "copy.h5"
    rows = 0
    for state in states:
        copy.write_bytes(state)
        with h5py.File(copy, "r") as file:
            rows = max(rows, _check_whole(file))
    assert rows == 3000


def _states_on_disk(writer: hdf5.RunWriter) -> list[bytes]:
    states: list[bytes] = []
    write = atomic._StagedFile._write_to_disk

    def watched(staged: atomic._StagedFile, pieces: list[tuple[int, bytes]]) -> None:
        for piece in pieces:
            write(staged, [piece])
            states.append(writer.path.read_bytes())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(atomic._StagedFile, "_write_to_disk", watched)
        synthetic.write_points(writer)
        for first in range(0, 3000, 500):
            times = 0.001 * np.arange(first, first + 500)
            writer.append_energy(synthetic.energy_rows(2, times))
            writer.append_snapshot(times[0], synthetic.fields(times[0]))
            writer.flush()
        writer.write_trigger(
            energy_released=1.0, settling_time=2.0, settling_ratio=3.0, settling_unbalanced=4.0
        )
        writer.write_final(3.0, synthetic.fields(3.0))
        writer.write_timing(1.0, 2.0, 3)
        writer.finish("finished", "done", {})
    return states


def _check_whole(file: h5py.File) -> int:
    """Read everything; what is complete is right. Returns the number of complete rows."""
    assert dict(file.attrs)["format"] == "gimpslope run"
    energy = {name: column[:] for name, column in file["energy"].items()}
    rows = min(len(column) for column in energy.values())
    times = energy["time"][:rows]
    np.testing.assert_allclose(times, 0.001 * np.arange(rows))
    np.testing.assert_allclose(energy["kinetic"][:rows], synthetic.kinetic(times))
    snapshots = {name: dataset[:] for name, dataset in file.get("snapshots", {}).items()}
    for number in range(min(map(len, snapshots.values()), default=0)):
        for name, expected in synthetic.fields(snapshots["time"][number]).items():
            np.testing.assert_allclose(snapshots[name][number], expected, rtol=1e-6)
    for name in ("points", "final"):
        for dataset in file.get(name, {}).values():
            assert dataset[...].any() or name == "final"
    return rows


@pytest.mark.parametrize("attempt", range(4))
def test_a_killed_writer_leaves_a_readable_file(tmp_path: Path, attempt: int) -> None:
    path = tmp_path / "a.h5"
    command = [sys.executable, "-c", WRITE_WITHOUT_END, str(path)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, cwd=Path(__file__).parent
    ) as process:
        assert process.stdout
        for _ in range(5 + attempt):
            process.stdout.readline()
        time.sleep(0.0007 * attempt)
        process.kill()
        flushed = 5 + attempt + len(process.stdout.readlines())
    assert process.returncode == -signal.SIGKILL
    with h5py.File(path, "r") as file:
        assert file.attrs["status"] == "running"
        assert len(file["energy/time"]) >= 20 * flushed
        assert len(file["snapshots/time"]) >= flushed
        last = flushed - 1
        moment = file["snapshots/time"][last]
        expected = synthetic.fields(moment)["position"]
        np.testing.assert_allclose(file["snapshots/position"][last], expected, rtol=1e-6)


def test_written_aside_in_the_order_of_the_calls(tmp_path: Path) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    for start in range(0, 300, 3):
        writer.append_energy(synthetic.energy_rows(2, np.arange(start, start + 3.0)))
        writer.flush_aside()
    writer.flush()
    np.testing.assert_array_equal(hdf5.read_energy(writer.path)["time"], np.arange(300.0))


def test_an_error_aside_is_raised_by_the_next_write_and_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    writer.append_energy(synthetic.energy_rows(2, np.arange(3.0)))

    def full(_: Path) -> None:
        raise OSError("no space left on device")

    with monkeypatch.context() as broken:
        broken.setattr(hdf5.writer, "change", full)
        writer.flush_aside()
        with pytest.raises(OSError, match="no space left"):
            writer.flush()
    writer.flush()
    np.testing.assert_array_equal(hdf5.read_energy(writer.path)["time"], np.arange(3.0))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_wait_for_the_end_of_a_write(tmp_path: Path, number: signal.Signals) -> None:
    writer = synthetic.new_writer(tmp_path / "a.h5")
    writer.append_energy(synthetic.energy_rows(0, np.arange(3.0)))
    before = signal.signal(number, signal.default_int_handler)  # it may be ignored
    try:
        with pytest.raises(KeyboardInterrupt), writer._flushed():
            signal.raise_signal(number)
    finally:
        signal.signal(number, before)
    writer.flush()
    np.testing.assert_array_equal(hdf5.read_energy(writer.path)["time"], np.arange(3.0))
