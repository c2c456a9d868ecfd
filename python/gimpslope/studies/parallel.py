"""Planned runs in processes of their own, a given number at a time."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Iterable, Sequence
from multiprocessing.process import BaseProcess

from tqdm import tqdm

from ..interrupts import caught
from ..io import hdf5
from ..run import Run
from .planned import Planned

_PAUSE = 0.2  # s
_PATIENCE = 1.0  # s
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
    going: dict[str, BaseProcess] = {}
    total = sum(one.setup.stages.slide.duration for one in waiting)
    bar = tqdm(total=total, desc="slides", bar_format=_BAR, disable=not progress)
    try:
        queue = list(waiting)
        with caught() as came:
            while queue or going:
                while queue and len(going) < jobs:
                    one = queue.pop(0)
                    going[str(one.path)] = _start(one)
                time.sleep(_PAUSE)
                going = {path: process for path, process in going.items() if process.is_alive()}
                begun = [one for one in waiting if one not in queue]
                bar.update(max(sum(map(_time_reached, begun)) - bar.n, 0.0))
                if came:
                    raise KeyboardInterrupt
    except BaseException:
        _stop(going.values())
        raise
    finally:
        bar.close()
    return [_finished(one) for one in planned]


def _start(planned: Planned) -> BaseProcess:
    """A process in which Ctrl-C waits until it can answer it."""
    process = multiprocessing.get_context("spawn").Process(target=_run, args=(planned,))
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        process.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return process


def _stop(processes: Iterable[BaseProcess]) -> None:
    """Ctrl-C for all, again and again until they have heard it."""
    for process in processes:
        while process.pid is not None and process.is_alive():
            os.kill(process.pid, signal.SIGINT)
            process.join(_PATIENCE)


def _run(planned: Planned) -> None:
    """What the process of a run does."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        with warnings.catch_warnings(record=True) as told:
            planned.run(progress=False)
        for warning in told:
            _tell(planned, warning.message)
    except KeyboardInterrupt:
        return
    except Exception as error:
        _tell(planned, error)
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _tell(planned: Planned, what: object) -> None:
    print(f"gimpslope: {planned.path}: {what}", file=sys.stderr)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGINT)


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
