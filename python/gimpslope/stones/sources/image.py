"""Slopes with stones out of label images: regions of pixels become outlines along their edges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike

import numpy as np
import numpy.typing as npt
import shapely

from ... import _check
from ..._check import FloatArray
from ...materials import Material
from .labels import Label, LabelImage, read_labels
from .regions import regions
from .section import Polygons, Section, materials_by_group, section

_MOST_COLOURS = 64
_MOST_SPECKS = 100
_OFF_THE_EDGE = 1e-4


def from_image(
    image: str | PathLike[str] | npt.ArrayLike,
    pixel: float,
    *,
    background: Label | None = 0,
    soil: Label = 1,
    stones: Label | Iterable[Label] | None = None,
    material: Material | Mapping[Label, Material] | None = None,
) -> Section:
    """The outline of a slope and its stones from an image of labels.

    Pixels of one label that touch along an edge are one stone; pixels of different labels are
    different stones. Outlines follow the edges of the pixels, so that areas are those of the
    pixels. Within the image they lie 1e-4 of a pixel to the left of these edges and below, so that
    a material point on the edge between two pixels belongs to one of them only.

    Parameters
    ----------
    image : path of a picture, such as a PNG, or array (rows, columns) of whole numbers; rows from
        the top. The labels are the numbers of an array or a grey picture, the colours of a
        coloured one ("#8b5a2b", "white" or (139, 90, 43)), either for one with a palette.
        The lower left corner of the image is (0, 0)
    pixel : side of a pixel, m, > 0
    background : label around the slope; None if there is nothing around it
    soil : label of the soil
    stones : label or labels of the stones; None: all others, of which a picture may have 64, and
        of which specks and lines one pixel wide may have 100 pixels
    material : of all stones, or by label; stones without one are of what the scene names

    Raises
    ------
    FileNotFoundError, TypeError, ValueError
        If the image cannot be read or a parameter is out of its range, if a label is not in the
        image or is in it without being named, if soil and stones together are not in one piece or
        have holes, or if there is anything inside a stone.
    """
    pixel = _check.positive("pixel", pixel)
    found = read_labels(image)
    empty = None if background is None else found.code("background", background)
    ground = found.code("soil", soil)
    if empty == ground:
        raise ValueError(f"soil must differ from background, got {soil!r} for both")
    kinds = _kinds_of_stones(found, stones, [empty, ground])
    materials = materials_by_group(material, kinds, lambda label: found.code("material", label))

    solid = np.array([code != empty for code in range(len(found.names))], dtype=np.intp)
    kind = np.zeros_like(solid)
    kind[kinds] = 1 + np.arange(len(kinds))
    slope, _ = regions(solid[found.codes])
    pieces, kind_of_piece = regions(kind[found.codes])
    limits = shapely.total_bounds(slope)
    pieces = _placed(pieces, pixel, limits)
    groups = [
        (f"label {found.names[code]}", pieces[kind_of_piece == kind[code]], made_of)
        for code, made_of in zip(kinds, materials, strict=True)
    ]
    return section("image", _placed(slope, pixel, limits), groups)


def _kinds_of_stones(
    image: LabelImage, stones: Label | Iterable[Label] | None, taken: list[int | None]
) -> list[int]:
    """Numbers of the labels of stones; `taken` are those of other things."""
    every = [code for code in range(len(image.names)) if code not in taken]
    if stones is None:
        if image.drawn and len(every) > _MOST_COLOURS:
            raise ValueError(
                f"image must have at most {_MOST_COLOURS} colours of stones unless `stones` names "
                f"them, got {len(every)}, {image.shown()}; was it saved with smooth edges or lossy?"
            )
        _refuse_specks(image, every)
        return every
    _check.instance("stones", stones, str | int | Iterable, "a label, some labels or None")
    kinds: list[int] = []
    for number, label in enumerate([stones] if isinstance(stones, str | int) else stones):
        code = image.code(f"stones[{number}]", label)
        if code in taken or code in kinds:
            raise ValueError(
                f"stones[{number}] must differ from background, soil and the stones before it, "
                f"got {label!r}"
            )
        kinds.append(code)
    if unnamed := set(every) - set(kinds):
        raise ValueError(f"stones must name all other labels, got none for {image.shown(unnamed)}")
    return kinds


def _refuse_specks(image: LabelImage, kinds: list[int]) -> None:
    """Refuse labels of stones, which nobody named, that come of noise or of smooth edges."""
    specks = np.array(kinds, dtype=np.intp)[~image.broad[kinds]]
    pixels = np.count_nonzero(np.isin(image.codes, specks))
    if pixels > _MOST_SPECKS:
        raise ValueError(
            "stones must be given where labels besides background and soil are mostly specks and "
            f"lines one pixel wide, in more than {_MOST_SPECKS} pixels, got {len(specks)} such "
            f"labels of {pixels:,} pixels, {image.shown(specks.tolist())}; name them if they are "
            "stones, else give their pixels the labels around them: was the image saved with "
            "smooth edges, lossy or with noise?"
        )


def _placed(pieces: Polygons, pixel: float, limits: FloatArray) -> Polygons:
    """Polygons in pixels as polygons in m, all but the sides of the slope off the pixels' edges."""
    low, high = limits[:2], limits[2:]

    def place(corners: FloatArray) -> FloatArray:
        inner = (corners > low) & (corners < high)
        return (corners - _OFF_THE_EDGE * inner) * pixel

    placed: Polygons = shapely.transform(pieces, place)
    return placed
