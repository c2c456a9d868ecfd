"""Stones in a notebook: a table of facts beside a small picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .collection import Stones


def in_words(stones: Stones) -> str:
    """Number, area and sizes, in a line."""
    if not len(stones):
        return "none"
    return f"{len(stones)}, {stones.area:.4g} m2, mean size {stones.mean_size:.3g} m"


def html(stones: Stones) -> str:
    """The picture and the table."""
    return in_words(stones)
