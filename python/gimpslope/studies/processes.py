"""Work in processes of their own, a given number at a time, which end in good order."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Generic, NamedTuple, TypeVar

from ..interrupts import BOTH, caught, heard

Given = TypeVar("Given")

_PAUSE = 0.2  # s
_PATIENCE = 1.0  # s


class Outcome(NamedTuple, Generic[Given]):
    """What a piece of work gave, nothing or one thing, and the error that it raised if any."""

    given: tuple[Given, ...]
    error: BaseException | None = None

    def value(self) -> Given:
        """What it gave; raises the error."""
        if self.error is not None:
            raise self.error
        return self.given[0]


def run_all(
    works: Sequence[Callable[[], Given]],
    *,
    jobs: int,
    watch: Callable[[int], None] = lambda begun: None,
) -> list[Outcome[Given]]:
    """Do each piece of work in a process of its own, at most `jobs` at a time; what came of all, in
    order, `ChildProcessError` where the process was killed.

    Work and what it gives must be such that they can be pickled. Ctrl-C or SIGTERM interrupts the
    work that is going, and waits for its end; so does the end of this process. `watch` is told,
    again and again, how many have begun. A script that calls this needs
    `if __name__ == "__main__":`, for the processes import it.
    """
    begun: list[_Worker[Given]] = []
    try:
        with caught() as came:
            going: list[_Worker[Given]] = []
            while going or len(begun) < len(works):
                while len(going) < jobs and len(begun) < len(works):
                    begun.append(_Worker(works[len(begun)]))
                    going.append(begun[-1])
                time.sleep(_PAUSE)
                going = [worker for worker in going if not worker.ended()]
                watch(len(begun))
                if came:
                    raise KeyboardInterrupt
    except BaseException:
        _stop(begun)
        raise
    return [worker.outcome for worker in begun]


@contextmanager
def signals_blocked() -> Iterator[None]:
    """Ctrl-C and SIGTERM wait, also in the processes that are started in the block, there until
    they are unblocked."""
    resource_tracker.ensure_running()  # to start it on the way would unblock them
    before = signal.pthread_sigmask(signal.SIG_BLOCK, BOTH)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _Worker(Generic[Given]):
    """A process in which signals wait until it can answer them."""

    def __init__(self, work: Callable[[], Given]) -> None:
        spawn = multiprocessing.get_context("spawn")
        self.outcome = Outcome[Given]((), ChildProcessError("a process was killed at its work"))
        self.answer, answer = spawn.Pipe(duplex=False)
        self.process: BaseProcess = spawn.Process(target=_run, args=(work, answer))
        with signals_blocked():
            self.process.start()
        answer.close()

    def ended(self) -> bool:
        """Whether it has; the outcome is there then."""
        if not self.answer.poll():
            return False
        with suppress(EOFError):
            self.outcome = self.answer.recv()
        self.process.join()
        return True


def _stop(workers: Sequence[_Worker[Given]]) -> None:
    """Ctrl-C for all, again and again until they have heard it; none waits to be asked what it
    gave."""
    for worker in workers:
        worker.answer.close()
    while alive := [worker.process for worker in workers if worker.process.is_alive()]:
        for process in alive:
            if process.pid is not None:
                os.kill(process.pid, signal.SIGINT)
        alive[0].join(_PATIENCE)


def _run(work: Callable[[], Given], answer: Connection) -> None:
    """What the process does."""
    for number in BOTH:
        signal.signal(number, signal.default_int_handler)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        with heard():
            signal.pthread_sigmask(signal.SIG_UNBLOCK, BOTH)
            outcome = Outcome((work(),))
    except (Exception, KeyboardInterrupt) as error:
        outcome = Outcome((), error)
    finally:
        for number in BOTH:
            signal.signal(number, signal.SIG_IGN)
    with suppress(BrokenPipeError):
        answer.send(outcome)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGINT)
