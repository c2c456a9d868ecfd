"""What a page of the atlas is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from ..verify.problem import Check


@dataclass(frozen=True)
class Table:
    """A boundary as it was measured beside what theory says of it, by rows."""

    columns: tuple[str, ...]
    rows: list[tuple[str | float, ...]]


@dataclass(frozen=True)
class Findings:
    """What a mode came to.

    Attributes
    ----------
    fails : checks that what is known to fail does, and where theory has it fail
    stands : checks that another method, the default unless its row says otherwise, does not
    figure : of measured against theory
    table : all that was measured
    """

    fails: list[Check]
    stands: list[Check]
    figure: Figure
    table: Table | None = None

    @property
    def checks(self) -> list[Check]:
        """All of them."""
        return [*self.fails, *self.stands]


@dataclass(frozen=True)
class Mode:
    """A way in which methods fail.

    Attributes
    ----------
    name : for the command line, the files and the warnings
    title : a few words
    mechanism : why it happens, in three sentences
    source : who found it
    advice : what to do
    run : measures it, quickly or in full
    """

    name: str
    title: str
    mechanism: str
    source: str
    advice: str
    run: Callable[[bool], Findings]
