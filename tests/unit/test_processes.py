"""Work in processes: what comes of it, and that signals end it in good order from the start."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import weakref
from functools import partial
from pathlib import Path

import pytest

from gimpslope.studies import processes

INTERRUPTED_AT_ONCE = """
import os
import signal
import sys
import time
from gimpslope.studies import processes

if __name__ == "__main__":
    worker = processes._Worker(time.time)
    os.kill(worker.process.pid, signal.Signals[sys.argv[1]])
    while not worker.ended():
        time.sleep(0.05)
    print(type(worker.outcome.error).__name__)
"""


def lose_an_interrupt() -> None:
    """It comes in a callback, where Python ignores it."""

    class Told:
        pass

    told = Told()
    reference = weakref.ref(told, lambda _: signal.raise_signal(signal.SIGTERM))
    del told
    assert reference() is None
    time.sleep(20)


def test_an_interrupt_that_python_ignores_ends_the_work(capfd: pytest.CaptureFixture[str]) -> None:
    start = time.monotonic()
    (outcome,) = processes.run_all([lose_an_interrupt], jobs=1)
    assert isinstance(outcome.error, KeyboardInterrupt) and time.monotonic() < start + 15
    assert capfd.readouterr().err == ""


def kill_itself() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def test_outcomes_are_in_order_and_one_that_fails_stops_no_other() -> None:
    works = [partial(int, "1"), partial(int, "one"), kill_itself, partial(int, "4")]
    begun: list[int] = []
    first, second, third, fourth = processes.run_all(works, jobs=2, watch=begun.append)
    assert (first.value(), fourth.value()) == (1, 4)
    with pytest.raises(ValueError, match="'one'"):
        second.value()
    with pytest.raises(ChildProcessError, match="killed"):
        third.value()
    assert begun[0] == 2 and begun[-1] == 4 and begun == sorted(begun)


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_signal_waits_until_the_process_can_answer_it(name: str, tmp_path: Path) -> None:
    """In the first process of all, too, which starts another one of Python's own before it."""
    script = tmp_path / "script.py"
    script.write_text(INTERRUPTED_AT_ONCE)
    told = subprocess.run([sys.executable, script, name], capture_output=True, text=True)
    assert (told.stdout, told.stderr) == ("KeyboardInterrupt\n", "")


def test_answers_that_nobody_reads_hold_nothing_up() -> None:
    """More than a pipe takes, of work that ends when it is no longer wanted."""
    worker = processes._Worker(partial(bytes, 1_000_000))
    while not worker.answer.poll():
        time.sleep(0.05)
    processes._stop([worker])
    assert not worker.process.is_alive()
