"""Writing a run file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from datetime import UTC, datetime
from os import PathLike
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...interrupts import uninterrupted
from ..atomic import change
from .layout import (
    ENERGY,
    FIELDS,
    FORMAT,
    FORMAT_VERSION,
    LEDGER,
    POINTS,
    RIGID_STATE,
    RIGID_STONES,
    SETUP,
    SNAPSHOT_FIELDS,
    STATUSES,
    Arrays,
    Quantity,
)
from .process import still_writing, this_process

_ENERGY_CHUNK = 1024
_STONES_CHUNK = 32
_TIME_CHUNK = 128


class RunWriter:
    """Writes one run file.

    Energy rows and snapshots stay in memory until `flush` or `flush_aside`; the trigger and the
    final state are written at once, with what came before them.

    Parameters
    ----------
    path : the file to make; an empty file may exist there
    setup : complete parameters, JSON text by the names in `SETUP`
    version : of gimpslope
    instruction_set, threads : what the solver runs on
    volumetric_strain : what the method is with these materials, where it is left to them too
    ledger : whether the energy rows have the columns of `LEDGER` too
    rigid_stones : numbers of the rigid stones; with any, rows have the column `RIGID_STONES` too
    overwrite : whether a file that is not empty may be replaced

    Raises
    ------
    FileExistsError
        If there is a file that is not empty, and it may not be replaced.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        *,
        setup: Mapping[str, str],
        version: str,
        instruction_set: str,
        threads: int,
        volumetric_strain: str,
        ledger: bool = False,
        rigid_stones: Sequence[int] = (),
        overwrite: bool = False,
    ) -> None:
        self.path = Path(path)
        self._columns = ENERGY | (LEDGER if ledger else {})
        if len(rigid_stones):
            shape = (len(rigid_stones), *RIGID_STATE.shape)
            self._columns |= {RIGID_STONES: RIGID_STATE._replace(shape=shape)}
        self._rows: list[Arrays] = []
        self._snapshots: list[tuple[float, Arrays]] = []
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._aside: Future[None] | None = None
        self._count = 0
        _make_room(self.path, overwrite)
        with change(self.path) as file:
            file.attrs["format"] = FORMAT
            file.attrs["format_version"] = FORMAT_VERSION
            file.attrs["gimpslope_version"] = version
            file.attrs["created"] = datetime.now(UTC).isoformat(timespec="seconds")
            file.attrs["status"] = "running"
            file.attrs["status_detail"] = ""
            for name in SETUP:
                file.attrs[name] = setup[name]
            file.attrs["instruction_set"] = instruction_set
            file.attrs["threads"] = threads
            file.attrs["volumetric_strain"] = volumetric_strain
            file.attrs["process"] = this_process()
            energy = file.create_group("energy")
            for name, quantity in self._columns.items():
                chunk = _STONES_CHUNK if name == RIGID_STONES else _ENERGY_CHUNK
                _create_growing(energy, name, quantity, chunk=chunk)
            if len(rigid_stones):
                energy[RIGID_STONES].attrs["number"] = rigid_stones

    def write_points(
        self,
        position: ArrayLike,
        mass: ArrayLike,
        volume: ArrayLike,
        half_length: ArrayLike,
        material: ArrayLike,
        stone: ArrayLike,
        material_names: Sequence[str],
    ) -> None:
        """Write the points; a second call, at the trigger, replaces the values of the first.

        `position` and `half_length` are (n, 2) in m, `mass` (n,) in kg/m, `volume` (n,)
        in m2, `material` (n,) indices into `material_names`, `stone` (n,) numbers or -1. Raises
        `ValueError` for any other shape.
        """
        values = {
            "position": position,
            "mass": mass,
            "volume": volume,
            "half_length": half_length,
            "material": material,
            "stone": stone,
        }
        count = len(np.asarray(position))
        points = _checked(values, POINTS, count)
        if self._count not in (0, count):
            raise ValueError(f"position must have the {self._count} points of before, got {count}")
        with self._flushed() as file:
            if self._count:
                for name, value in points.items():
                    file["points"][name][...] = value
            else:
                _create_fixed(file.create_group("points"), points, POINTS)
                file["points"].attrs["material_names"] = list(material_names)
                _create_snapshots(file.create_group("snapshots"), count)
        self._count = count

    def append_energy(self, rows: Mapping[str, ArrayLike]) -> None:
        """Keep rows of energy, one array (k,) for every column, for the next flush."""
        count = np.size(rows.get("time", ()))
        self._rows.append(_checked(rows, self._columns, count))

    def append_snapshot(self, time: float, fields: Mapping[str, ArrayLike]) -> None:
        """Keep one snapshot of the slide at `time` (s) for the next flush: an array for every name
        in `SNAPSHOT_FIELDS`, which is not copied where it has the type of the file."""
        self._snapshots.append((time, _checked(fields, SNAPSHOT_FIELDS, self._count, copy=False)))

    def write_trigger(
        self,
        *,
        energy_released: float,
        settling_time: float,
        settling_ratio: float,
        settling_unbalanced: float,
    ) -> None:
        """Write the energy released at the return, J/m, and how the settling ended, s, 1 and 1."""
        with self._flushed() as file:
            trigger = file.require_group("trigger")
            trigger.attrs["energy_released"] = energy_released
            trigger.attrs["settling_time"] = settling_time
            trigger.attrs["settling_ratio"] = settling_ratio
            trigger.attrs["settling_unbalanced"] = settling_unbalanced
            trigger.attrs["description"] = (
                "energy_released in J/m, settling_time in s, settling_ratio kinetic over "
                "potential, settling_unbalanced unbalanced forces over weight"
            )

    def write_final(self, time: float, fields: Mapping[str, ArrayLike]) -> None:
        """Write the last state of the slide at `time` (s): an array for every name in `FIELDS`."""
        values = _checked(fields, FIELDS, self._count)
        with self._flushed() as file:
            final = file.create_group("final")
            final.attrs["time"] = time
            _create_fixed(final, values, FIELDS)

    def write_timing(self, wall_seconds: float, processor_seconds: float, point_steps: int) -> None:
        """Write the time spent stepping, by the clock and of all threads together (s), and the
        points times the steps taken in it."""
        with self._flushed() as file:
            file.attrs["timing"] = json.dumps(
                {
                    "wall_seconds": wall_seconds,
                    "processor_seconds": processor_seconds,
                    "point_steps": point_steps,
                }
            )

    def finish(self, status: str, detail: str, summary: Mapping[str, Any] | None = None) -> None:
        """Write how the run ended: `status` one of `STATUSES`, in words, and its summary."""
        if status not in STATUSES:
            raise ValueError(f"status must be one of {', '.join(STATUSES)}, got {status!r}")
        with self._flushed() as file:
            file.attrs["status"] = status
            file.attrs["status_detail"] = detail
            if summary is not None:
                file.attrs["summary"] = json.dumps(dict(summary))
        self._thread.shutdown()

    def flush(self) -> None:
        """Write the energy rows and snapshots kept in memory."""
        with self._flushed():
            pass

    def flush_aside(self) -> None:
        """Write them in a thread of its own, unless that is still at it.

        An error of that thread is raised by the next call of a method that writes; what it was to
        write is still kept then.
        """
        with uninterrupted():
            if self._aside is None or self._aside.done():
                self._wait()
                self._aside = self._thread.submit(self._write_kept)

    def _wait(self) -> None:
        aside, self._aside = self._aside, None
        if aside is not None:
            aside.result()

    @contextmanager
    def _flushed(self) -> Iterator[h5py.File]:
        """The file opened for a change, with all that is kept in memory written first."""
        with uninterrupted():
            self._wait()
            self._write_kept()
            with change(self.path) as file:
                yield file

    def _write_kept(self) -> None:
        rows, snapshots = self._rows.copy(), self._snapshots.copy()
        if not (rows or snapshots):
            return
        with change(self.path) as file:
            if rows:
                for name in self._columns:
                    column = np.concatenate([some[name] for some in rows])
                    _extend(file["energy"][name], column)
            if snapshots:
                for name in SNAPSHOT_FIELDS:
                    moments = [fields[name] for _, fields in snapshots]
                    _extend_by_chunks(file["snapshots"][name], moments)
                times = np.array([time for time, _ in snapshots])
                _extend(file["snapshots"]["time"], times)
        del self._rows[: len(rows)], self._snapshots[: len(snapshots)]


def _make_room(path: Path, overwrite: bool) -> None:
    if path.is_dir() or not path.absolute().parent.is_dir():
        raise ValueError(f"output must be a file in a directory that exists, got {str(path)!r}")
    if path.exists() and path.stat().st_size > 0 and not overwrite:
        raise FileExistsError(
            f"output must be a new or empty file unless overwrite is set, got {str(path)!r}, "
            "which exists and is not empty"
        )
    if writer := still_writing(path):
        raise FileExistsError(
            f"output must be a file that no run is writing, got {str(path)!r}, which process "
            f"{writer} is writing"
        )
    path.open("wb").close()


def _checked(
    values: Mapping[str, ArrayLike],
    quantities: Mapping[str, Quantity],
    count: int,
    *,
    copy: bool = True,
) -> Arrays:
    """The values as arrays, refused unless they have just these names and (count, ...) shapes."""
    if values.keys() != quantities.keys():
        raise ValueError(f"the names must be {', '.join(quantities)}, got {', '.join(values)}")
    convert = np.array if copy else np.ascontiguousarray
    arrays = {name: convert(values[name], dtype=q.dtype) for name, q in quantities.items()}
    for name, array in arrays.items():
        shape = (count, *quantities[name].shape)
        if array.shape != shape:
            raise ValueError(f"{name} must have shape {shape}, got {array.shape}")
    return arrays


def _create_fixed(group: h5py.Group, values: Arrays, quantities: Mapping[str, Quantity]) -> None:
    for name, value in values.items():
        _describe(group.create_dataset(name, data=value), quantities[name])


def _create_snapshots(group: h5py.Group, count: int) -> None:
    time = Quantity("f8", (), "s", "time from the trigger")
    _create_growing(group, "time", time, chunk=_TIME_CHUNK)
    for name, quantity in SNAPSHOT_FIELDS.items():
        shape = (count, *quantity.shape)
        _create_growing(group, name, quantity._replace(shape=shape), chunk=1)


def _create_growing(group: h5py.Group, name: str, quantity: Quantity, *, chunk: int) -> None:
    dataset = group.create_dataset(
        name,
        shape=(0, *quantity.shape),
        maxshape=(None, *quantity.shape),
        chunks=(chunk, *quantity.shape),
        dtype=quantity.dtype,
    )
    _describe(dataset, quantity)


def _describe(dataset: h5py.Dataset, quantity: Quantity) -> None:
    dataset.attrs["units"] = quantity.units
    dataset.attrs["description"] = quantity.description


def _extend(dataset: h5py.Dataset, values: NDArray[Any]) -> None:
    length = len(dataset)
    dataset.resize(length + len(values), axis=0)
    dataset[length:] = values


def _extend_by_chunks(dataset: h5py.Dataset, values: Sequence[NDArray[Any]]) -> None:
    """Append arrays that are a chunk each, without HDF5's copies on the way."""
    length = len(dataset)
    dataset.resize(length + len(values), axis=0)
    for number, value in enumerate(values, start=length):
        dataset.id.write_direct_chunk((number,) + (0,) * value.ndim, value)
