"""Ctrl-C and SIGTERM, by which a process is to end in good order."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Any

BOTH = (signal.SIGINT, signal.SIGTERM)

_MOMENT = 0.05  # s


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM do what Ctrl-C does, and lose neither, for as long as the block lasts."""
    with _answered([signal.SIGTERM], signal.default_int_handler), heard():
        yield


@contextmanager
def heard() -> Iterator[None]:
    """In the main thread, where SIGTERM raises `KeyboardInterrupt`: let it come again after Python
    has ignored one, as it does every exception in a callback, such as those of weak references and
    of HDF5; a moment later, or where the block ends before."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before, lost = sys.unraisablehook, False

    def answer(ignored: sys.UnraisableHookArgs) -> None:
        nonlocal lost
        if issubclass(ignored.exc_type, KeyboardInterrupt):
            lost = True
            signal.setitimer(signal.ITIMER_REAL, _MOMENT)
        else:
            before(ignored)

    def come_again(*_: object) -> None:
        nonlocal lost
        lost = False
        signal.raise_signal(signal.SIGTERM)

    with _answered([signal.SIGALRM], come_again):
        sys.unraisablehook = answer
        try:
            yield
        finally:
            sys.unraisablehook = before
            if lost:
                signal.setitimer(signal.ITIMER_REAL, 0.0)
        if lost:
            raise KeyboardInterrupt


@contextmanager
def uninterrupted() -> Iterator[list[int]]:
    """Hold both back until the block has ended, by an error too, then let them act as before; those
    that came so far."""
    came: list[int] = []
    try:
        with caught() as came:
            yield came
    finally:
        for number in came:
            signal.raise_signal(number)


@contextmanager
def caught() -> Iterator[list[int]]:
    """Those that came since the block began, to be looked at in good time: as an exception one is
    lost where Python ignores those, as in a callback of HDF5."""
    came: list[int] = []
    with _answered(BOTH, lambda number, _: came.append(number)):
        yield came


@contextmanager
def _answered(
    numbers: Sequence[signal.Signals], answer: Callable[[int, FrameType | None], object]
) -> Iterator[None]:
    """Python lets the main thread alone answer signals; in any other one nothing is changed."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before: dict[signal.Signals, Any] = {}
    try:
        with _waiting():
            for number in numbers:
                before[number] = signal.signal(number, answer)
        yield
    finally:
        with _waiting():
            for number, old in before.items():
                signal.signal(number, old or signal.SIG_DFL)


@contextmanager
def _waiting() -> Iterator[None]:
    """Ctrl-C and SIGTERM wait until the block ends, or else one that comes between two answers is
    given by the wrong one of them."""
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    try:
        signal.pthread_sigmask(signal.SIG_BLOCK, BOTH)  # what came before is answered here
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
