"""Snapshots for ParaView: a VTU file each, and a PVD file that gives them their times."""

from __future__ import annotations

import re
import reprlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from .. import _check

if TYPE_CHECKING:
    import meshio

    from ..run_file import Moment, RunFile
    from ..snapshot import Snapshot


def write_vtu_series(
    run: RunFile,
    directory: str | PathLike[str],
    *,
    times: Iterable[Moment] | None = None,
    overwrite: bool = False,
) -> Path:
    """Write the snapshots of a run for ParaView.

    For a run file slope.h5 these are slope_0000.vtu, slope_0001.vtu and so on, as `to_mesh` makes
    them, and slope.pvd, the one to open. Each file appears when it is complete, slope.pvd last.

    Parameters
    ----------
    run : an opened run
    directory : where to write; made when it does not exist
    times : s, or "peak"; of each the nearest snapshot is written, once where it is that of
        several. None: all snapshots
    overwrite : whether the directory may hold files already; those of an earlier series of a run
        of this name are removed

    Returns
    -------
    path of the PVD file

    Raises
    ------
    FileExistsError
        If the directory is not empty and may not be.
    TypeError, ValueError
        If there are no snapshots or no times, or a time is no number or outside of the run.
    """
    overwrite = _check.flag("overwrite", overwrite)
    snapshots = run.snapshots() if times is None else _nearest(run, times)
    directory = Path(directory)
    name = run.path.stem
    _make_ready(directory, name, overwrite=overwrite)
    times_of: dict[str, float] = {}
    for number, snapshot in enumerate(snapshots):
        path = directory / f"{name}_{number:04d}.vtu"
        with _whole(path) as new:
            to_mesh(snapshot).write(new, file_format="vtu")
        times_of[path.name] = snapshot.time
    collection = directory / f"{name}.pvd"
    with _whole(collection) as new:
        _collection(times_of).write(new, encoding="utf-8", xml_declaration=True)
    return collection


def to_mesh(snapshot: Snapshot) -> meshio.Mesh:
    """The points of a snapshot as vertices with their fields.

    velocity (m/s) and displacement (m) have a third component of zero; stress (Pa, tension
    positive) has the components of a symmetric tensor in the order of VTK: xx, yy, zz, xy, yz, xz,
    the last two zero; mean_stress is (xx + yy + zz) / 3 and sqrt_j2 the square root of half the
    sum of the squares of the deviatoric stress, both Pa; plastic_strain, density (kg/m3), material
    and stone are those of `Snapshot` and `PointsAtStart`.
    """
    import meshio

    n = len(snapshot.position)
    stress = snapshot.stress
    mean = stress[:, :3].mean(axis=1)
    deviatoric = stress - np.outer(mean, (1, 1, 1, 0))
    # J2 = s:s / 2, where xy counts twice.
    j2 = deviatoric**2 @ np.array([1, 1, 1, 2]) / 2
    return meshio.Mesh(
        _padded(snapshot.position, 3),
        [("vertex", np.arange(n)[:, np.newaxis])],
        point_data={
            "velocity": _padded(snapshot.velocity, 3),
            "displacement": _padded(snapshot.displacement, 3),
            "stress": _padded(stress, 6),
            "mean_stress": mean,
            "sqrt_j2": np.sqrt(j2),
            "plastic_strain": snapshot.plastic_strain,
            "density": snapshot.density,
            "material": snapshot.points.material,
            "stone": snapshot.points.stone,
        },
    )


def _nearest(run: RunFile, times: Iterable[Moment]) -> Iterator[Snapshot]:
    """The snapshots nearest to some times in order, each once."""
    found = sorted({run.snapshot(time).time for time in times})
    if not found:
        raise ValueError("times must hold a time, got none")
    return (run.snapshot(time) for time in found)


def _make_ready(directory: Path, name: str, *, overwrite: bool) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    there = sorted(path.name for path in directory.iterdir())
    if there and not overwrite:
        raise FileExistsError(
            f"directory must be empty unless overwrite is True, got {str(directory)!r} "
            f"with {reprlib.repr(there)}"
        )
    earlier = re.compile(rf"{re.escape(name)}(\.pvd|_\d{{4,}}\.vtu)")
    for found in filter(earlier.fullmatch, there):
        (directory / found).unlink()


@contextmanager
def _whole(path: Path) -> Iterator[Path]:
    """A path to write to; the file is renamed to `path` when the block has ended well."""
    new = path.with_name(f".{path.name}.part")
    try:
        yield new
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)


def _collection(times: Mapping[str, float]) -> ElementTree.ElementTree[ElementTree.Element]:
    """ParaView's list of files and their times, s."""
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for name, time in times.items():
        ElementTree.SubElement(
            collection, "DataSet", timestep=repr(time), group="", part="0", file=name
        )
    ElementTree.indent(root)
    return ElementTree.ElementTree(root)


def _padded(values: npt.NDArray[Any], components: int) -> npt.NDArray[Any]:
    """Values (n, k) with zeros for the components that plane strain leaves out."""
    return np.pad(values, [(0, 0), (0, components - values.shape[1])])
