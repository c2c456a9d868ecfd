"""Planned runs in processes of their own, a given number at a time."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from functools import partial

from tqdm import tqdm

from ..io import hdf5
from ..run import Run
from . import processes
from .planned import Planned

_BAR = "{desc} {percentage:3.0f}%|{bar}| {n:.1f} of {total:.0f} s [{elapsed}<{remaining}]"


class RunFailed(RuntimeError):
    """A run of a study did not reach its end."""


def run_all(planned: Sequence[Planned], *, jobs: int, progress: bool = True) -> list[Run]:
    """Make the runs that are not there yet, at most `jobs` at a time; all of them, in order.

    Ctrl-C or SIGTERM stops those that are going, each of which keeps what it has computed; so does
    the end of this process. A script that calls this needs `if __name__ == "__main__":`, for the
    processes import it.

    Raises
    ------
    RunFailed
        If a run did not reach its end; the others are finished first.
    """
    waiting = [one for one in planned if one.found is None]
    total = sum(one.setup.stages.slide.duration for one in waiting)
    with tqdm(total=total, desc="slides", bar_format=_BAR, disable=not progress) as bar:

        def watch(begun: int) -> None:
            bar.update(max(sum(map(_time_reached, waiting[:begun])) - bar.n, 0.0))

        processes.run_all([partial(_run, one) for one in waiting], jobs=jobs, watch=watch)
    return [_finished(one) for one in planned]


def _run(planned: Planned) -> None:
    try:
        with warnings.catch_warnings(record=True) as told:
            planned.run(progress=False)
    except Exception as error:
        _tell(planned, error)
    else:
        for warning in told:
            _tell(planned, warning.message)


def _tell(planned: Planned, what: object) -> None:
    print(f"gimpslope: {planned.path}: {what}", file=sys.stderr)


def _time_reached(planned: Planned) -> float:
    """Time of the slide that the run file shows, s."""
    if not planned.path.exists():
        return 0.0
    try:
        columns = hdf5.read_energy(planned.path)
    except (OSError, ValueError, KeyError):
        return 0.0
    slide = columns["stage"] == hdf5.STAGES.index("slide")
    return float(columns["time"][slide].max(initial=0.0))


def _finished(planned: Planned) -> Run:
    if planned.found is not None:
        return planned.found
    run = Run(planned.path) if planned.path.exists() else None
    if run is None or run.status != "finished":
        how = "it left no file" if run is None else f"{run.status}: {run.status_detail}"
        raise RunFailed(f"the run {planned.path} did not reach its end; {how}")
    return run
