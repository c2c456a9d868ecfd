"""Reading a run file, also while it is being written."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import wraps
from os import PathLike
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from .layout import (
    ENERGY,
    FIELDS,
    FORMAT,
    FORMAT_VERSION,
    JSON_ATTRIBUTES,
    LEDGER,
    POINTS,
    RIGID_STONES,
    Arrays,
    Quantity,
)

Parameters = ParamSpec("Parameters")
Found = TypeVar("Found")

_NO_TIMES = np.empty(0)
_TRIES = 20
_PAUSE = 0.01  # s


def _patient(read: Callable[Parameters, Found]) -> Callable[Parameters, Found]:
    """A reading that meets a write of the run is tried again; a file that HDF5 cannot read even
    then is refused as damaged."""

    @wraps(read)
    def reading(*arguments: Parameters.args, **names: Parameters.kwargs) -> Found:
        for _ in range(_TRIES):
            try:
                return read(*arguments, **names)
            except FileNotFoundError:
                raise
            except OSError:
                time.sleep(_PAUSE)
        with _damage_named(arguments[0]):
            return read(*arguments, **names)

    return reading


@contextmanager
def _damage_named(path: object) -> Iterator[None]:
    """An error of HDF5, which has no number as those of the system have, names the file."""
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            raise
        raise ValueError(
            f"path must name a whole run file, got {str(path)!r}, which is damaged: {error}"
        ) from error


@_patient
def read_attributes(path: str | PathLike[str]) -> dict[str, Any]:
    """The root attributes; JSON text is decoded.

    Raises `FileNotFoundError`, or `ValueError` for a file that is damaged or not a run file of this
    format.
    """
    with _opened(path) as file:
        attributes = {name: _plain(value) for name, value in file.attrs.items()}
    for name in JSON_ATTRIBUTES & attributes.keys():
        attributes[name] = json.loads(attributes[name])
    return attributes


@_patient
def read_points(path: str | PathLike[str]) -> Arrays:
    """The points at the start of the slide, by the names in `POINTS`; none yet: empty mapping."""
    with _opened(path) as file:
        return _read_all(file, "points", POINTS)


@_patient
def read_energy(path: str | PathLike[str]) -> Arrays:
    """The energy rows of all stages, one array (k,) for every name in `ENERGY`."""
    with _opened(path) as file:
        columns = _read_all(file, "energy", ENERGY)
    length = min(len(column) for column in columns.values())
    return {name: column[:length] for name, column in columns.items()}


@_patient
def read_ledger(path: str | PathLike[str]) -> Arrays:
    """The ledger of all stages, one array (k,) for every name in `LEDGER`; none kept: empty."""
    with _opened(path) as file:
        kept = "plastic" in file["energy"]
        columns = _read_all(file, "energy", LEDGER) if kept else {}
    length = min((len(column) for column in columns.values()), default=0)
    return {name: column[:length] for name, column in columns.items()}


@_patient
def read_rigid_stones(path: str | PathLike[str]) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Numbers of the rigid stones (m,) and, in all stages, their states (k, m, 9), as `RIGID_STATE`
    says; none: empty arrays."""
    with _opened(path) as file:
        energy = file["energy"]
        if RIGID_STONES not in energy:
            return np.empty(0, dtype=np.int32), np.empty((len(energy["time"]), 0, 9))
        number: NDArray[np.int32] = energy[RIGID_STONES].attrs["number"]
        return number, energy[RIGID_STONES][...]


@_patient
def read_snapshot_times(path: str | PathLike[str]) -> NDArray[np.float64]:
    """Times of the complete snapshots, s, shape (k,)."""
    with _opened(path) as file:
        snapshots = file.get("snapshots", {"time": _NO_TIMES})
        complete = min(len(dataset) for dataset in snapshots.values())
        times: NDArray[np.float64] = snapshots["time"][:complete]
        return times


@_patient
def read_snapshot(path: str | PathLike[str], number: int) -> Arrays:
    """The snapshot of that number, an array for every name in `FIELDS`, in 64 bits."""
    with _opened(path) as file:
        return {name: file["snapshots"][name][number].astype(np.float64) for name in FIELDS}


@_patient
def read_final(path: str | PathLike[str]) -> tuple[float, Arrays] | None:
    """Time (s) and fields, by the names in `FIELDS`, of the final state; None if there is none."""
    with _opened(path) as file:
        if "final" not in file:
            return None
        return float(file["final"].attrs["time"]), _read_all(file, "final", FIELDS)


@_patient
def read_trigger(path: str | PathLike[str]) -> dict[str, float]:
    """energy_released (J/m), settling_time (s), settling_ratio and settling_unbalanced; none yet:
    empty mapping."""
    with _opened(path) as file:
        trigger = file["trigger"].attrs if "trigger" in file else {}
        return {name: float(trigger[name]) for name in trigger if name != "description"}


@contextmanager
def _opened(path: str | PathLike[str]) -> Iterator[h5py.File]:
    if not Path(path).is_file():
        raise FileNotFoundError(f"path must name a run file, got {str(path)!r}, which is no file")
    if not h5py.is_hdf5(path):
        raise ValueError(f"path must name a run file, got {str(path)!r}, which is not HDF5")
    with h5py.File(path, "r") as file:
        kind, version = file.attrs.get("format"), file.attrs.get("format_version")
        if kind != FORMAT or version != FORMAT_VERSION:
            raise ValueError(
                f"path must name a {FORMAT!r} of format {FORMAT_VERSION}, got {str(path)!r}, "
                f"which is {kind!r} of format {version}"
            )
        yield file


def _read_all(file: h5py.File, group: str, quantities: Mapping[str, Quantity]) -> Arrays:
    return {name: file[group][name][...] for name in quantities} if group in file else {}


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
