"""The atlas of where methods fail: one module a mode, each measured against theory."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module

from ...method_warning import MethodWarning
from .mode import Findings, Mode, Table

NAMES = (
    "step_limit",
    "cell_crossing",
    "fracture",
    "stretched_domains",
    "null_space",
    "small_masses",
    "spin",
    "cones",
    "apex",
    "locking",
    "blend",
    "energy_drift",
    "single_precision",
    "near_stones",
    "localisation",
)
"""All modes of failure: of shape functions and schemes first, then of the soil, then of a run."""

__all__ = ["NAMES", "Findings", "Mode", "Surveyed", "Table", "mode", "survey"]


@dataclass(frozen=True)
class Surveyed:
    """A mode, what it came to, and the wall time it took, s."""

    mode: Mode
    findings: Findings
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether all of its checks hold."""
        return all(check.holds for check in self.findings.checks)


def mode(name: str) -> Mode:
    """The mode of that name. Raises `ValueError` for a name not in `NAMES`."""
    if name not in NAMES:
        raise ValueError(f"mode must be one of {', '.join(NAMES)}, got {name!r}")
    found: Mode = import_module(f".{name}", __name__).MODE
    return found


def survey(names: Sequence[str] = NAMES, *, full: bool = True) -> Iterator[Surveyed]:
    """Measure modes, by name, one after the other; each is given as soon as it is done.

    Parameters
    ----------
    names : of the modes, each in `NAMES`
    full : at all places and on the finest grids, in minutes; otherwise quickly, in seconds

    Raises
    ------
    ValueError
        If there is no mode of a name; none is measured then.
    """
    chosen = [mode(name) for name in dict.fromkeys(names)]
    return (_survey(one, full) for one in chosen)


def _survey(one: Mode, full: bool) -> Surveyed:
    start = time.perf_counter()
    with warnings.catch_warnings():  # it goes where they warn of on purpose
        warnings.simplefilter("ignore", MethodWarning)
        findings = one.run(full)
    return Surveyed(one, findings, time.perf_counter() - start)
