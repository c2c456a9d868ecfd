"""What Ctrl-C and SIGTERM do: at once, later, or where Python ignores exceptions."""

from __future__ import annotations

import os
import signal
import sys
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


@pytest.mark.parametrize("number", BOTH)
def test_what_python_ignores_is_raised_again(
    number: signal.Signals, capfd: pytest.CaptureFixture[str]
) -> None:
    class Told:
        pass

    def end(_: object) -> None:
        signal.raise_signal(number)

    told = Told()
    reference = weakref.ref(told, end)
    hook = sys.unraisablehook
    with pytest.raises(KeyboardInterrupt), interrupts.terminable():
        del told
        assert reference() is None
        time.sleep(10)
    assert sys.unraisablehook is hook
    assert capfd.readouterr().err == ""


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
