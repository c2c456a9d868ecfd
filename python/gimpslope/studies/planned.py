"""Runs that a study needs: those that are there already are taken as they are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

from ..io import hdf5
from ..run import Run
from ..setup import Setup


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
    process is writing the file, or if it holds anything else and may not be replaced.
    """
    if not path.exists() or path.stat().st_size == 0:
        return Planned(path, setup)
    if writer := hdf5.still_writing(path):
        raise FileExistsError(
            f"output must be a directory in which nothing else runs, got {str(path)!r}, which "
            f"process {writer} is writing"
        )
    if _same(path, setup):
        run = Run(path)
        return Planned(path, setup, run if run.status == "finished" else None)
    if not overwrite:
        raise FileExistsError(
            f"output must be a directory without other runs unless overwrite is set, got "
            f"{str(path)!r}, which holds something else or is of another version"
        )
    return Planned(path, setup)


def _same(path: Path, setup: Setup) -> bool:
    try:
        run = Run(path)
        there = run.setup
    except (OSError, KeyError, ValueError, TypeError):
        return False
    same_threads = replace(there.method, threads=setup.method.threads)
    return replace(there, method=same_threads) == setup and run.attributes[
        "gimpslope_version"
    ] == version("gimpslope")
