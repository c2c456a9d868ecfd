"""Label images: which label each pixel has, and what the labels may be called."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from PIL import Image

Label: TypeAlias = int | str | tuple[int, ...]
"""A whole number, or a colour: "#8b5a2b", a name such as "white", or (139, 90, 43)."""

_NUMBERED = ("1", "L", "I", "I;16", "I;16B")
_MOST_SHOWN = 12


@dataclass(frozen=True, eq=False)
class LabelImage:
    """An image of labels.

    Attributes
    ----------
    codes : number of each pixel's label, rows from the top, shape (rows, columns)
    names : of each label, as messages show it
    called : the number of the label that a whole number or a colour "#rrggbbaa" calls
    drawn : whether it is of a picture, where colours can be many by accident
    """

    codes: npt.NDArray[np.intp]
    names: tuple[str, ...]
    called: Mapping[int | str, int]
    drawn: bool

    def code(self, parameter: str, label: Label) -> int:
        """The number of a label, given as `parameter`.

        Raises `TypeError` or `ValueError` if it is no label, or none of this image.
        """
        found = self.called.get(_key(parameter, label))
        if found is None:
            raise ValueError(
                f"{parameter} must be a label of the image, {self.shown()}; got {label!r}"
            )
        return found

    @property
    def broad(self) -> npt.NDArray[np.bool_]:
        """Whether most of each label's pixels are in squares of 2 by 2 of them, shape (labels,)."""
        low, high = self.codes[:-1], self.codes[1:]
        alike = (low == high)[:, 1:] & (low[:, 1:] == low[:, :-1]) & (high[:, 1:] == high[:, :-1])
        around = np.pad(alike, 1)
        within = around[1:, 1:] | around[1:, :-1] | around[:-1, 1:] | around[:-1, :-1]
        pixels, in_squares = (
            np.bincount(codes.ravel(), minlength=len(self.names))
            for codes in (self.codes, self.codes[within])
        )
        broad: npt.NDArray[np.bool_] = 2 * in_squares > pixels
        return broad

    def shown(self, codes: Iterable[int] | None = None) -> str:
        """The labels of these numbers, or all, in words: with their shares, the largest first."""
        shares = np.bincount(self.codes.ravel(), minlength=len(self.names)) / self.codes.size
        order = sorted(range(len(self.names)) if codes is None else codes, key=lambda n: -shares[n])
        words = [f"{self.names[n]} ({shares[n]:.2%})" for n in order]
        more = f" and {len(words) - _MOST_SHOWN} more" if len(words) > _MOST_SHOWN else ""
        return ", ".join(words[:_MOST_SHOWN]) + more


def read_labels(image: str | PathLike[str] | npt.ArrayLike) -> LabelImage:
    """The labels of a picture file, or of an array (rows, columns) of whole numbers.

    Grey pictures have numbers as labels, those of colours have colours, and those with a palette
    have both. Rows are counted from the top.

    Raises
    ------
    FileNotFoundError, TypeError, ValueError
        If there is no such file, it is no picture, or an array is of the wrong type or shape.
    """
    if isinstance(image, str | PathLike):
        return _of_file(image)
    numbers = np.asarray(image)
    if numbers.dtype.kind not in "iub" or numbers.ndim != 2 or numbers.size == 0:
        raise TypeError(
            "image must be the path of a picture or an array of whole numbers of shape "
            f"(rows, columns), got {numbers.dtype} of shape {numbers.shape}"
        )
    return _of_numbers(numbers, drawn=False)


def _of_numbers(numbers: npt.NDArray[np.generic], *, drawn: bool) -> LabelImage:
    values, codes = np.unique(numbers, return_inverse=True)
    called: dict[int | str, int] = {int(value): code for code, value in enumerate(values.tolist())}
    return LabelImage(codes.reshape(numbers.shape), tuple(map(str, called)), called, drawn)


def _of_file(path: str | PathLike[str]) -> LabelImage:
    from PIL import Image

    if not Path(path).is_file():
        raise FileNotFoundError(f"image must be an existing file, got {str(path)!r}")
    try:
        with Image.open(path) as picture:
            return _of_picture(picture)
    except (OSError, ValueError) as error:
        raise ValueError(
            f"image must be a picture of whole numbers or colours, got {str(path)!r}: {error}"
        ) from None


def _of_picture(picture: Image.Image) -> LabelImage:
    from PIL import ImageFile

    if isinstance(picture, ImageFile.StubImageFile):
        raise ValueError("it is no picture")
    if picture.mode in _NUMBERED:
        return _of_numbers(np.asarray(picture), drawn=True)
    if picture.mode == "F":
        raise ValueError("its numbers are not whole")
    rgba = np.ascontiguousarray(picture.convert("RGBA"))
    packed = rgba.view(">u4")[..., 0].astype(np.int64)
    numbers = np.asarray(picture) if picture.mode == "P" else packed
    values, first, codes = np.unique(numbers, return_index=True, return_inverse=True)
    colours = [f"#{colour:08x}" for colour in packed.ravel()[first].tolist()]
    uses = Counter(colours)
    called: dict[int | str, int] = {
        colour: code for code, colour in enumerate(colours) if uses[colour] == 1
    }
    names = [repr(re.sub("^(#.{6})ff$", r"\1", colour)) for colour in colours]
    if picture.mode == "P":
        names = [
            f"{value} or {name}" if uses[colour] == 1 else str(value)
            for value, name, colour in zip(values.tolist(), names, colours, strict=True)
        ]
        called |= {value: code for code, value in enumerate(values.tolist())}
    return LabelImage(codes.reshape(numbers.shape), tuple(names), called, drawn=True)


def _key(parameter: str, label: Label) -> int | str:
    """A label as `LabelImage.called` has it."""
    from PIL import ImageColor

    if isinstance(label, int | np.integer) and not isinstance(label, bool):
        return int(label)
    allowed = "a whole number, a colour such as '#8b5a2b', or its (r, g, b) from 0 to 255"
    refusal = f"{parameter} must be {allowed}, got {label!r}"
    if isinstance(label, str):
        try:
            return "#" + bytes(ImageColor.getcolor(label, "RGBA")).hex()
        except ValueError:
            raise ValueError(refusal) from None
    if not isinstance(label, tuple) or not all(isinstance(channel, int) for channel in label):
        raise TypeError(refusal)
    if len(label) not in (3, 4) or not all(0 <= channel <= 255 for channel in label):
        raise ValueError(refusal)
    return "#" + bytes([*label, 255][:4]).hex()
