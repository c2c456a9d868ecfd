"""What this machine can do at most: fused multiply-adds, and reading of memory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ... import _core, kernel
from .in_turn import Work, rates

_KIB = 1024
BUFFERS = {"L2": 256 * _KIB, "L3": 4096 * _KIB}
"""Bytes a thread that its second level of cache holds, and that only the third one does."""

MEMORY = 512 * _KIB * _KIB
"""Bytes of all threads together that hardly any cache holds."""

_SHARE = 0.3  # of a repeat


@dataclass(frozen=True)
class Limits:
    """What some threads can do together.

    Attributes
    ----------
    threads : how many
    instruction_set : what they run on
    multiply_add : floating-point operations a second in double precision, in fused multiply-adds
        that do not wait for each other
    reading : bytes a second out of buffers of the sizes of L2, L3 and DRAM
    """

    threads: int
    instruction_set: str
    multiply_add: float
    reading: dict[str, float]


def measure(threads: int) -> Limits:
    """The limits of so many threads, >= 1."""
    buffers = BUFFERS | {"DRAM": MEMORY // threads}
    machines = {name: _core.Machine(threads=threads, bytes=size) for name, size in buffers.items()}
    works = {name: Work(machine.read, _SHARE) for name, machine in machines.items()}
    speeds = rates(works | {"": Work(machines["L2"].multiply_add, _SHARE)})
    return Limits(
        threads=threads,
        instruction_set=kernel.instruction_sets()[-1],
        multiply_add=machines["L2"].multiply_add(1) * float(np.median(speeds[""])),
        reading={
            name: machine.read(1) * float(np.median(speeds[name]))
            for name, machine in machines.items()
        },
    )
