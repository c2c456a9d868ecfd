"""What Ctrl-C and SIGTERM do: at once, later, or where Python ignores exceptions."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
import weakref
from collections.abc import Iterator

import pytest

from gimpslope import interrupts

BOTH = [signal.SIGINT, signal.SIGTERM]


@pytest.fixture(autouse=True)
def answered() -> Iterator[None]:
    """Both raise KeyboardInterrupt, also where the tests run in the background."""
    before = {number: signal.signal(number, signal.default_int_handler) for number in BOTH}
    yield
    for number, old in before.items():
        signal.signal(number, old)


@pytest.mark.parametrize("number", BOTH)
def test_signals_are_not_lost_where_python_ignores_exceptions(number: signal.Signals) -> None:
    """In a finaliser it would be an exception that nobody sees."""

    class Callback:
        def __del__(self) -> None:
            os.kill(os.getpid(), number)

    before = signal.getsignal(number)
    with interrupts.caught() as came:
        Callback()
        assert came == [number]
    assert signal.getsignal(number) is before


def lose(number: signal.Signals) -> None:
    """A signal whose exception Python ignores."""

    class Told:
        pass

    told = Told()
    reference = weakref.ref(told, lambda _: signal.raise_signal(number))
    del told
    assert reference() is None


@pytest.mark.parametrize("number", BOTH)
def test_what_python_ignores_is_raised_again(
    number: signal.Signals, capfd: pytest.CaptureFixture[str]
) -> None:
    hook, start = sys.unraisablehook, time.monotonic()
    with pytest.raises(KeyboardInterrupt), interrupts.terminable():
        lose(number)
        time.sleep(10)
    assert time.monotonic() < start + 5
    assert sys.unraisablehook is hook
    assert capfd.readouterr().err == ""


def test_what_python_ignores_at_the_end_is_raised_there() -> None:
    with pytest.raises(KeyboardInterrupt), interrupts.terminable():
        lose(signal.SIGTERM)
    time.sleep(0.1)  # nothing comes afterwards


def test_what_python_ignores_is_held_back_where_all_is() -> None:
    done = False
    with pytest.raises(KeyboardInterrupt), interrupts.terminable():
        lose(signal.SIGTERM)
        with interrupts.uninterrupted():
            time.sleep(0.2)
            done = True
    assert done


def test_other_threads_change_nothing() -> None:
    def enter() -> None:
        with interrupts.terminable():
            hooks.append(sys.unraisablehook)

    hooks: list[object] = []
    thread = threading.Thread(target=enter)
    thread.start()
    thread.join()
    assert hooks == [sys.unraisablehook]


def test_other_ignored_exceptions_are_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    class Broken:
        def __del__(self) -> None:
            raise OSError("lost")

    told: list[type[BaseException]] = []
    monkeypatch.setattr(sys, "unraisablehook", lambda ignored: told.append(ignored.exc_type))
    with interrupts.terminable():
        Broken()
    assert told == [OSError]


@pytest.mark.parametrize("number", BOTH)
def test_signals_wait_for_the_end_of_a_block(number: signal.Signals) -> None:
    done = False
    with pytest.raises(KeyboardInterrupt), interrupts.uninterrupted():
        signal.raise_signal(number)
        done = True
    assert done


@pytest.mark.parametrize("number", BOTH)
def test_signals_are_not_lost_where_the_block_fails(number: signal.Signals) -> None:
    with pytest.raises(KeyboardInterrupt) as caught, interrupts.uninterrupted():
        signal.raise_signal(number)
        raise OSError("disk full")
    assert isinstance(caught.value.__context__, OSError)


def test_sigterm_is_answered_for_as_long_as_the_block_lasts() -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    with pytest.raises(KeyboardInterrupt), interrupts.terminable():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
