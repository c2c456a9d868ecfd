"""What a page of the atlas is made of."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Self

from matplotlib.figure import Figure

from ...method_warning import MethodWarning
from ..check import Check
from ..checked import Case, Checked


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
class Mode(Case[Findings]):
    """A way in which methods fail; its name is also that of the warnings.

    Attributes
    ----------
    mechanism : why it happens, in three sentences
    source : who found it
    advice : what to do
    """

    mechanism: str
    source: str
    advice: str

    def check(self, full: bool) -> Checked[Self, Findings]:
        """Measure it and time that."""
        with warnings.catch_warnings():  # it goes where they warn of on purpose
            warnings.simplefilter("ignore", MethodWarning)
            return super().check(full)
