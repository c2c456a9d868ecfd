"""Which process writes a run file: no two may."""

from __future__ import annotations

import os
import platform
from pathlib import Path

import h5py


def still_writing(path: Path) -> int | None:
    """The other process of this machine that is writing a run to the file, by its number.

    None where there is none; also for a file that another machine writes, of which nothing can be
    told.
    """
    try:
        with h5py.File(path, "r") as file:
            status, writer = file.attrs.get("status"), str(file.attrs.get("process", ""))
    except OSError:
        return None
    machine, _, number = writer.rpartition(" ")
    if status != "running" or machine != platform.node() or int(number) == os.getpid():
        return None
    try:
        os.kill(int(number), 0)
    except ProcessLookupError:
        return None
    except PermissionError:
        pass
    return int(number)


def this_process() -> str:
    """This machine and the number of this process."""
    return f"{platform.node()} {os.getpid()}"
