"""Cases with known answers: found by name, run, timed and checked."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import Any, Generic, Protocol, Self, TypeVar

from matplotlib.figure import Figure

from .check import Check

_DPI = 72


class Result(Protocol):
    """What a case comes to."""

    @property
    def checks(self) -> list[Check]:
        """Its quantities against what is known of them."""

    @property
    def figure(self) -> Figure:
        """The computed against the known."""


R = TypeVar("R", bound=Result)
C = TypeVar("C", bound="Case[Any]")


@dataclass(frozen=True)
class Case(Generic[R]):
    """Something to compute of which the answer is known.

    Attributes
    ----------
    name : for the command line and the files
    title : a few words
    run : solves it, quickly or in full, and checks it
    """

    name: str
    title: str
    run: Callable[[bool], R]

    def check(self, full: bool) -> Checked[Self, R]:
        """Run it and time that."""
        start = time.perf_counter()
        result = self.run(full)
        return Checked(self, result, time.perf_counter() - start)


@dataclass(frozen=True)
class Checked(Generic[C, R]):
    """A case, what it came to, and the wall time it took, s."""

    case: C
    result: R
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether all of its checks hold."""
        return all(check.holds for check in self.result.checks)

    @property
    def line(self) -> str:
        """What came of it, in one line."""
        return f"{self.case.title}: {_held([self])}, {self.seconds:.1f} s"

    @property
    def picture(self) -> str:
        """The name of its picture's file."""
        return f"{self.case.name}.png"

    def draw(self, directory: str | PathLike[str]) -> None:
        """Write its picture into a directory."""
        self.result.figure.savefig(Path(directory) / self.picture, dpi=_DPI)


@dataclass(frozen=True)
class Catalogue(Generic[C, R]):
    """Cases, each of them a constant in a module of its own.

    Attributes
    ----------
    package : which the modules are in
    kind : what a case is called, and the constant in capitals
    names : of the cases and their modules
    full : whether they are checked in full unless it is said
    """

    package: str
    kind: str
    names: tuple[str, ...]
    full: bool

    def named(self, name: str) -> C:
        """The case of that name. Raises `ValueError` for a name not in `names`."""
        if name not in self.names:
            raise ValueError(f"{self.kind} must be one of {', '.join(self.names)}, got {name!r}")
        module = import_module(f".{name}", self.package)
        case: C = getattr(module, self.kind.upper())
        return case

    def check(
        self, names: Sequence[str] | None = None, *, full: bool | None = None
    ) -> Iterator[Checked[C, R]]:
        """Check cases, by name, one after the other; each is given as soon as it is done.

        Parameters
        ----------
        names : of the cases (default: all)
        full : with the finest grids and at all places, in minutes, or quickly, in seconds; None: as
            `full` of the catalogue

        Raises
        ------
        ValueError
            If there is no case of a name; none is run then.
        """
        cases = [self.named(name) for name in dict.fromkeys(self.names if names is None else names)]
        return (case.check(self.full if full is None else full) for case in cases)


def verdict(checked: Sequence[Checked[Any, Any]]) -> str:
    """How many checks of all hold, and the time of all."""
    return f"{_held(checked)}; {sum(one.seconds for one in checked):.0f} s in all."


def _held(checked: Sequence[Checked[Any, Any]]) -> str:
    checks = [check for one in checked for check in one.result.checks]
    return f"{sum(check.holds for check in checks)} of {len(checks)} checks hold"
