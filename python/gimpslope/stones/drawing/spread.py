"""Parameters of a draw that are a number, or spread evenly between two."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ... import _check
from ..._check import FloatArray

Spread = float | tuple[float, float]
"""A number, or the least and the largest of numbers that are all as likely."""


def numbers(
    name: str, value: Spread, low: float, high: float, rng: np.random.Generator, n: int
) -> FloatArray:
    """Numbers of a spread within [low, high], shape (n,)."""
    least, most = (_check.in_range(name, end, low, high) for end in _ends(name, value))
    _refuse_reversed(name, least, most)
    return least + rng.random(n) * (most - least)


def whole_numbers(
    name: str, value: int | tuple[int, int], low: int, rng: np.random.Generator, n: int
) -> npt.NDArray[np.int64]:
    """Whole numbers of a spread, both ends included, `low` or above, shape (n,)."""
    least, most = (_check.whole(name, end, low) for end in _ends(name, value))
    _refuse_reversed(name, least, most)
    return least + np.floor(rng.random(n) * (most + 1 - least)).astype(np.int64)


def _ends(name: str, value: object) -> tuple[Any, Any]:
    if not isinstance(value, tuple | list):
        return value, value
    if len(value) != 2:
        raise ValueError(f"{name} must be a number, or the least and the largest, got {value!r}")
    return value[0], value[1]


def _refuse_reversed(name: str, least: float, most: float) -> None:
    if least > most:
        raise ValueError(f"{name} must have the least before the largest, got {(least, most)}")
