"""Checks of parameters: each returns the accepted value in its plain Python form, or refuses it.

A value of the wrong type raises `TypeError`, one of the right type out of its range `ValueError`;
both say the parameter's name, its value and what is allowed. Numpy scalars count as numbers,
booleans do not, and neither NaN nor infinity is ever let through.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Sequence
from numbers import Integral, Real
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
T = TypeVar("T")


def finite(name: str, value: object, allowed: str = "a finite number") -> float:
    """Any finite number; `allowed` is how the message describes a narrower range."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise TypeError(_refusal(name, value, allowed))
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ValueError(_refusal(name, value, allowed))
    return number


def positive(name: str, value: object) -> float:
    """A finite number above zero."""
    allowed = "a finite number > 0"
    number = finite(name, value, allowed)
    if number <= 0:
        raise ValueError(_refusal(name, value, allowed))
    return number


def not_negative(name: str, value: object) -> float:
    """A finite number, zero or above."""
    allowed = "a finite number >= 0"
    number = finite(name, value, allowed)
    if number < 0:
        raise ValueError(_refusal(name, value, allowed))
    return number


def in_range(name: str, value: object, low: float, high: float, ends: str = "[]") -> float:
    """A number between `low` and `high`; `ends` such as "[)" says which of the two are included."""
    allowed = f"a number in {ends[0]}{low:.12g}, {high:.12g}{ends[1]}"
    number = finite(name, value, allowed)
    above = number > low or (ends[0] == "[" and number == low)
    below = number < high or (ends[1] == "]" and number == high)
    if not (above and below):
        raise ValueError(_refusal(name, value, allowed))
    return number


def whole(name: str, value: object, least: int) -> int:
    """A whole number, `least` or above."""
    allowed = f"a whole number >= {least}"
    if not isinstance(value, Integral) or isinstance(value, bool):
        raise TypeError(_refusal(name, value, allowed))
    if value < least:
        raise ValueError(_refusal(name, value, allowed))
    return int(value)


def flag(name: str, value: object) -> bool:
    """True or False, nothing that merely counts as such."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(_refusal(name, value, "True or False"))
    return bool(value)


def one_of(name: str, value: T, names: Sequence[str]) -> T:
    """One of the `names`."""
    allowed = "one of " + ", ".join(map(repr, names))
    if not isinstance(value, str):
        raise TypeError(_refusal(name, value, allowed))
    if value not in names:
        raise ValueError(_refusal(name, value, allowed))
    return cast(T, value)


def instance(name: str, value: T, kind: Any, allowed: str) -> T:
    """An object of the class, or of one of the union of classes, `kind`."""
    if not isinstance(value, kind):
        raise TypeError(_refusal(name, value, allowed))
    return value


def array(name: str, value: object, shape: tuple[int | str, ...]) -> FloatArray:
    """A read-only float64 copy of finite numbers; a length in `shape` given as a letter is free."""
    allowed = f"an array of finite numbers of shape ({', '.join(map(str, shape))})"
    try:
        given = np.asarray(value)
    except ValueError:
        raise ValueError(_refusal(name, value, allowed)) from None
    if given.dtype.kind not in "iuf":
        raise TypeError(_refusal(name, value, allowed))
    if given.ndim != len(shape) or any(
        isinstance(wanted, int) and wanted != length
        for length, wanted in zip(given.shape, shape, strict=True)
    ):
        raise ValueError(f"{_refusal(name, value, allowed)} of shape {given.shape}")
    if not np.isfinite(given).all():
        raise ValueError(_refusal(name, given[~np.isfinite(given)][0], allowed))
    copy = np.array(given, dtype=np.float64, order="C")
    copy.setflags(write=False)
    return copy


def numbers(name: str, value: object, n: int, low: int, high: int) -> npt.NDArray[np.int32]:
    """A read-only copy of `n` whole numbers between `low` and `high`, both included."""
    given = np.asarray(value)
    if given.shape != (n,) or given.dtype.kind not in "iu":
        raise TypeError(
            f"{name} must be an array of whole numbers of shape ({n},), "
            f"got {given.dtype} of shape {given.shape}"
        )
    if n and not low <= given.min() <= given.max() <= high:
        raise ValueError(
            f"{name} must be numbers in [{low}, {high}], got {given.min()} to {given.max()}"
        )
    copy = np.array(given, dtype=np.int32)
    copy.setflags(write=False)
    return copy


def _refusal(name: str, value: object, allowed: str) -> str:
    plain = value.item() if isinstance(value, np.generic) else value
    shown = str(plain) if isinstance(plain, int | float) else reprlib.repr(plain)
    return f"{name} must be {allowed}, got {shown}"
