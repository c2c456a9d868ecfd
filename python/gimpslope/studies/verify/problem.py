"""What a problem with a known answer is made of."""

from __future__ import annotations

from dataclasses import dataclass

from matplotlib.figure import Figure

from ..check import Check
from ..checked import Case


@dataclass(frozen=True)
class Outcome:
    """What a problem came to: its checks, and a figure of the computed against the known."""

    checks: list[Check]
    figure: Figure


class Problem(Case[Outcome]):
    """A problem with a known answer."""
