"""Runs that a study needs: those that are there already are taken as they are."""

from __future__ import annotations

import reprlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ..io import hdf5
from ..run import Run
from ..setup import Setup

_SHOWN = 3


@dataclass(frozen=True)
class Planned:
    """A run to be made, or found made already.

    Attributes
    ----------
    path : of the run file
    setup : what is run
    found : the finished run, None where it is to be made
    """

    path: Path
    setup: Setup
    found: Run | None = None

    def run(self, *, progress: bool = True) -> Run:
        """The run that was found, or a new one, with its directory; raises as `simulate` does."""
        if self.found is not None:
            return self.found
        self.path.parent.mkdir(parents=True, exist_ok=True)
        return self.setup.simulate(self.path, overwrite=True, progress=progress)


def plan(path: Path, setup: Setup, *, overwrite: bool = False) -> Planned:
    """What to do for a run in a file: nothing if it is there, finished, of the same setup but for
    the number of threads, and made by this version.

    A run of the same setup that was stopped is made anew. Raises `FileExistsError` if another
    process is writing the file, or if it holds anything else and may not be replaced; the
    error says what.
    """
    if not path.exists() or path.stat().st_size == 0:
        return Planned(path, setup)
    if writer := hdf5.still_writing(path):
        raise FileExistsError(
            f"output must be a directory in which nothing else runs, got {str(path)!r}, which "
            f"process {writer} is writing"
        )
    differences = _differences(path, setup)
    if not differences:
        run = Run(path)
        return Planned(path, setup, run if run.status == "finished" else None)
    if not overwrite:
        more = len(differences) - _SHOWN
        told = "; ".join(differences[:_SHOWN]) + (f"; and {more} more" if more > 0 else "")
        raise FileExistsError(
            f"output must be a directory without other runs unless overwrite is set, got "
            f"{str(path)!r}, which holds something else: {told}"
        )
    return Planned(path, setup)


def _differences(path: Path, setup: Setup) -> list[str]:
    """What a file holds in place of a run of this setup by this version, in words."""
    try:
        run = Run(path)
        same_threads = replace(run.setup.method, threads=setup.method.threads)
        there = replace(run.setup, method=same_threads).to_dict()
    except (OSError, KeyError, ValueError, TypeError) as error:
        return [str(error)]
    made, ours = run.attributes["gimpslope_version"], version("gimpslope")
    version_differs = [f"another version, {made} there, {ours} here"] if made != ours else []
    return [*version_differs, *_compared("", there, setup.to_dict())]


def _compared(name: str, there: Any, here: Any) -> Iterator[str]:
    """Where two records differ, as plain data."""
    if isinstance(there, dict) and isinstance(here, dict) and there.get("type") == here.get("type"):
        for key in there:
            yield from _compared(f"{name}.{key}".lstrip("."), there[key], here[key])
    elif isinstance(there, list) and isinstance(here, list) and len(there) == len(here):
        for number, pair in enumerate(zip(there, here, strict=True)):
            yield from _compared(f"{name}[{number}]", *pair)
    elif there != here:
        yield f"{name} {_brief(there)} there, {_brief(here)} here"


def _brief(value: Any) -> str:
    if isinstance(value, dict):
        return str(value.get("type"))
    return f"{len(value)} of them" if isinstance(value, list) else reprlib.repr(value)
