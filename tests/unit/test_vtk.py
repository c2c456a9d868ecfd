"""Export for ParaView: every snapshot, its time, and the fields, read back by meshio."""

from pathlib import Path
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
import synthetic_run as synthetic
from made_snapshot import made

from gimpslope.io import vtk
from gimpslope.io.vtk import to_mesh, write_vtu_series
from gimpslope.run import Run
from gimpslope.snapshot import Snapshot


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return synthetic.write_run(tmp_path_factory.mktemp("vtk") / "slope.h5", until=1.0)


def collection(path: Path) -> dict[str, float]:
    """The files and times of a PVD file."""
    root = ElementTree.parse(path).getroot()
    assert (root.tag, root.get("type")) == ("VTKFile", "Collection")
    return {found.attrib["file"]: float(found.attrib["timestep"]) for found in root.iter("DataSet")}


def names(directory: Path) -> list[str]:
    return sorted(path.name for path in directory.iterdir())


def test_every_snapshot_with_its_time(run: Run, tmp_path: Path) -> None:
    path = write_vtu_series(run, tmp_path / "series")
    files = collection(path)
    assert path == tmp_path / "series" / "slope.pvd"
    assert names(path.parent) == sorted([*files, "slope.pvd"])
    assert list(files) == [f"slope_{number:04d}.vtu" for number in range(5)]
    assert list(files.values()) == [0.0, 0.25, 0.5, 0.75, 1.0]
    for name, time in files.items():
        points = meshio.read(path.parent / name).points
        expected = synthetic.POINTS.position + synthetic.displacement(time)
        np.testing.assert_allclose(points[:, :2], expected, rtol=1e-15)


def test_fields_are_those_of_the_run(run: Run, tmp_path: Path) -> None:
    path = write_vtu_series(run, tmp_path, times=[1.0])
    mesh = meshio.read(path.with_name("slope_0000.vtu"))
    expected = synthetic.fields(1.0)
    data = mesh.point_data
    close = {"rtol": 1e-6, "atol": 1e-12}
    np.testing.assert_allclose(data["velocity"][:, :2], expected["velocity"], **close)
    np.testing.assert_allclose(data["displacement"][:, :2], synthetic.displacement(1.0), **close)
    np.testing.assert_allclose(data["stress"][:, :4], expected["stress"], **close)
    np.testing.assert_allclose(data["plastic_strain"], expected["plastic_strain"], **close)
    density = synthetic.POINTS.mass / expected["volume"]
    np.testing.assert_allclose(data["density"], density, **close)
    np.testing.assert_array_equal(data["material"], synthetic.POINTS.material)
    np.testing.assert_array_equal(data["stone"], synthetic.POINTS.stone)
    assert set(data["stone"]) == {-1, 0}
    for name, width in {"velocity": 3, "displacement": 3, "stress": 6}.items():
        assert data[name].shape == (len(mesh.points), width)
    assert not data["velocity"][:, 2].any()
    assert not data["stress"][:, 4:].any()
    assert not mesh.points[:, 2].any()


def test_points_are_vertices() -> None:
    mesh = to_mesh(made([(0.5, 0.1), (1.0, 2.0), (3.0, 0.0)]))
    assert [block.type for block in mesh.cells] == ["vertex"]
    np.testing.assert_array_equal(mesh.cells[0].data, [[0], [1], [2]])


@pytest.mark.parametrize(
    ("stress", "mean", "sqrt_j2"),
    [
        ((-3.0, -3.0, -3.0, 0.0), -3.0, 0.0),
        ((0.0, 0.0, 0.0, 5.0), 0.0, 5.0),
        ((6.0, 0.0, 0.0, 0.0), 2.0, 6 / 3**0.5),  # uniaxial: J2 = s^2 / 3
        ((4.0, -4.0, 0.0, 3.0), 0.0, 5.0),  # shear of 5 in turned axes
    ],
)
def test_invariants_of_known_stresses(stress: tuple[float], mean: float, sqrt_j2: float) -> None:
    data = to_mesh(made([(0.0, 0.0)], stress=np.array([stress]))).point_data
    assert data["mean_stress"] == pytest.approx(mean)
    assert data["sqrt_j2"] == pytest.approx(sqrt_j2)


def test_chosen_times_take_the_nearest_snapshot_once_in_order(run: Run, tmp_path: Path) -> None:
    path = write_vtu_series(run, tmp_path, times=[0.7, 0.3, 0.26])
    assert collection(path) == {"slope_0000.vtu": 0.25, "slope_0001.vtu": 0.75}


def test_a_directory_with_files_is_refused(run: Run, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(
        FileExistsError, match=r"^directory must be empty unless .* \['notes\.txt'\]"
    ):
        write_vtu_series(run, tmp_path)
    assert names(tmp_path) == ["notes.txt"]


def test_overwrite_replaces_the_earlier_series_and_nothing_else(run: Run, tmp_path: Path) -> None:
    write_vtu_series(run, tmp_path)
    others = ["notes.txt", "other_0000.vtu", "slope.vtu", "slope_0000.vtu.bak"]
    for other in others:
        (tmp_path / other).write_text("mine")
    path = write_vtu_series(run, tmp_path, times=[0.5], overwrite=True)
    assert names(tmp_path) == sorted([*others, "slope.pvd", "slope_0000.vtu"])
    assert {(tmp_path / other).read_text() for other in others} == {"mine"}
    assert collection(path) == {"slope_0000.vtu": 0.5}


def test_what_fails_half_way_leaves_whole_files_and_no_collection(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Full(meshio.Mesh):
        def write(self, path: Path, file_format: str) -> None:
            path.write_text("half")
            raise OSError("no space left")

    def fails_at_the_third(snapshot: Snapshot) -> meshio.Mesh:
        mesh = to_mesh(snapshot)
        return Full(mesh.points, mesh.cells) if snapshot.time == 0.5 else mesh

    monkeypatch.setattr(vtk, "to_mesh", fails_at_the_third)
    with pytest.raises(OSError, match="no space left"):
        write_vtu_series(run, tmp_path)
    assert names(tmp_path) == ["slope_0000.vtu", "slope_0001.vtu"]
    assert len(meshio.read(tmp_path / "slope_0001.vtu").points) == len(synthetic.POINTS)


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"times": []}, ValueError, "^times must hold a time, got none"),
        ({"times": [0.0, 2.0]}, ValueError, r"^time must be a number in \[0, 1\], .* got 2\.0"),
        ({"times": ["late"]}, TypeError, "^time must be a finite number, got 'late'"),
        ({"overwrite": 1}, TypeError, "^overwrite must be True or False, got 1"),
    ],
)
def test_refusals_write_nothing(run: Run, tmp_path: Path, arguments, error, text) -> None:
    with pytest.raises(error, match=text):
        write_vtu_series(run, tmp_path / "series", **arguments)
    assert not (tmp_path / "series").exists()


def test_a_run_without_snapshots_is_refused(tmp_path: Path) -> None:
    run = Run(synthetic.new_writer(tmp_path / "new.h5").path)
    with pytest.raises(ValueError, match="the run must have snapshots, got none"):
        write_vtu_series(run, tmp_path / "series")
    assert not (tmp_path / "series").exists()
