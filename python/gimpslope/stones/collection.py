"""Stones as a collection: made from arrays, tested against each other, counted and weighed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast, overload

import numpy as np
import numpy.typing as npt
import shapely

from .. import _check
from .._check import FloatArray
from .._record import Record
from ..materials import Material
from ..outline import Outline
from . import contact, neighbours, picture
from .ellipse import Ellipse
from .rows import all_rows, for_each, one_or_all, refuse_not_positive
from .stone import Shape, Stone

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SLACK = 1e-6


@dataclass(frozen=True, repr=False)
class Stones(Record, Sequence[Stone]):
    """Stones, numbered from 0.

    Slices and sums of them are stones again, and so are those of an index array or a mask:
    `stones[stones.sizes > 0.5]`.

    Parameters
    ----------
    stones : stones, or shapes (Outline, Ellipse) of stones without a material of their own

    Raises
    ------
    TypeError
        If one of them is anything else.
    """

    stones: Sequence[Stone | Shape] = ()

    def __post_init__(self) -> None:
        allowed = "a sequence of Stone, Outline or Ellipse"
        _check.instance("stones", self.stones, Iterable, allowed)
        made = (_stone(f"stones[{number}]", item) for number, item in enumerate(self.stones))
        self._store(stones=tuple(made))

    @classmethod
    def of_ellipses(
        cls,
        centres: npt.ArrayLike,
        axes: npt.ArrayLike,
        angles: npt.ArrayLike = 0.0,
        material: Material | None = None,
    ) -> Stones:
        """Ellipses.

        Parameters
        ----------
        centres : m, shape (n, 2)
        axes : full lengths of both axes, m, shape (2,) for all or (n, 2)
        angles : from the x axis counterclockwise to the first axis, degrees, for all or (n,)
        material : of all; None: what the scene names for stones that do not say
        """
        centres = all_rows("centres", centres, (2,))
        refuse_not_positive("axes", one_or_all("axes", axes, (2,), len(centres)))
        axes = for_each("axes", axes, len(centres), (2,))
        angles = for_each("angles", angles, len(centres), ())
        rows = zip(centres.tolist(), axes.tolist(), angles.tolist(), strict=True)
        return cls([Stone(Ellipse(*row), material) for row in rows])

    @classmethod
    def of_polygons(
        cls, polygons: Iterable[npt.ArrayLike], material: Material | None = None
    ) -> Stones:
        """Polygons of corners (k, 2), m, with k >= 3 that may differ between them; `material` as in
        `of_ellipses`."""
        _check.instance("polygons", polygons, Iterable, "a sequence of polygons of corners (k, 2)")
        outlines = (_outline(f"polygons[{n}]", corners) for n, corners in enumerate(polygons))
        return cls([Stone(outline, material) for outline in outlines])

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes, without materials."""
        return tuple(stone.shape for stone in self)

    @property
    def areas(self) -> FloatArray:
        """Area of each, m2, shape (n,)."""
        return np.array([stone.area for stone in self])

    @property
    def sizes(self) -> FloatArray:
        """Diameter of the circle of equal area of each, m, shape (n,)."""
        return np.array([stone.size for stone in self])

    @property
    def centroids(self) -> FloatArray:
        """Centre of gravity of each, m, shape (n, 2)."""
        return np.array([stone.centroid for stone in self]).reshape(-1, 2)

    @property
    def area(self) -> float:
        """Area of all, m2."""
        return float(self.areas.sum())

    @property
    def mean_size(self) -> float:
        """Mean of the sizes, m. Raises `ValueError` without stones."""
        if not len(self):
            raise ValueError("stones must not be empty for a mean size, got none")
        return float(self.sizes.mean())

    def mass(self, material: Material | None = None) -> float:
        """Mass of all, kg/m, where those without a material of their own are of `material`.

        Raises `ValueError` if one of them has none and none is given.
        """
        if material is not None:
            _check.instance("material", material, Material, "a material or None")
        found = [stone.material or material for stone in self]
        if None in found:
            raise ValueError(
                f"material must be given, for stones[{found.index(None)}] has none, got None"
            )
        return float(np.dot(self.areas, [kind.density for kind in found if kind is not None]))

    def with_material(self, material: Material | None) -> Stones:
        """The same shapes, all of this material."""
        return Stones([replace(stone, material=material) for stone in self])

    def content(self, outline: Outline) -> float:
        """Share of an outline's area that is in stones, as `point_content` has it of points.

        Where they overlap it counts once, outside of the outline not at all. Ellipses that do so
        count as their polygons, whose areas are 1e-4 smaller.
        """
        _slope(outline)
        crossing = np.union1d(self.overlaps(), self.outside(outline))
        clear = np.delete(self.areas, crossing).sum()
        union = shapely.union_all([self[n].shape.polygon for n in crossing.tolist()])
        return float((clear + union.intersection(outline.polygon).area) / outline.area)

    def numbers(self, points: npt.ArrayLike) -> npt.NDArray[np.int32]:
        """Number of the stone that holds each of the points (n, 2), m, or -1 for none, shape (n,).

        A point on an edge is inside; one on the edges of two stones is of the later.
        """
        points = all_rows("points", points, (2,))
        order = np.argsort(points[:, 1], kind="stable")
        rising = points[order]
        numbers = np.full(len(points), -1, dtype=np.int32)
        for number, shape in enumerate(self.shapes):
            left, low, right, high = shape.bounds
            slack = _SLACK * max(right - left, high - low)
            start, end = np.searchsorted(rising[:, 1], (low - slack, high + slack))
            numbers[order[start:end][shape.contains(rising[start:end])]] = number
        return numbers

    def point_counts(self, outline: Outline, spacing: float) -> npt.NDArray[np.int64]:
        """Number of points of each stone in an outline's lattice of a spacing (m), shape (n,)."""
        numbers = self.numbers(_slope(outline).lattice(spacing))
        return np.bincount(numbers[numbers >= 0], minlength=len(self))

    def point_content(self, outline: Outline, spacing: float) -> float:
        """Share of the points of an outline's lattice of a spacing (m) that are in stones.

        Raises `ValueError` if the lattice has no points.
        """
        lattice = _slope(outline).lattice(spacing)
        if len(lattice) == 0:
            raise ValueError(f"spacing must put points into the outline, got {spacing}, none")
        return float(np.mean(self.numbers(lattice) >= 0))

    def overlaps(self) -> npt.NDArray[np.int64]:
        """Pairs of numbers of stones that overlap, shape (k, 2), in order; they may touch."""
        return neighbours.overlaps(self.shapes)

    def outside(self, outline: Outline) -> npt.NDArray[np.int64]:
        """Numbers of the stones that do not lie within an outline, shape (k,)."""
        return np.flatnonzero(~contact.within(self.shapes, _slope(outline)))

    def gaps(self) -> FloatArray:
        """Distance of each stone from the nearest other, m, shape (n,).

        0 where they touch or overlap, infinite for a single stone.
        """
        return neighbours.gaps(self.shapes)

    def margins(self, outline: Outline) -> FloatArray:
        """Distance of each stone from the edge of an outline, m, shape (n,).

        0 where it crosses the edge. Raises `ValueError` if a stone is not within the outline.
        """
        outside = self.outside(outline)
        if len(outside):
            raise ValueError(f"stones must lie within the outline, got {outside.tolist()} outside")
        return contact.edge_distances(self.shapes, outline)

    def plot(self, ax: Axes | None = None, outline: Outline | None = None) -> Axes:
        """The stones to scale, and the outline of a slope where it is given.

        Drawn into the axes, or into new ones; returns these.
        """
        if outline is not None:
            _slope(outline)
        return picture.plot(self, ax, outline)

    @overload
    def __getitem__(self, index: int) -> Stone: ...
    @overload
    def __getitem__(self, index: slice | Sequence[int] | npt.NDArray[Any]) -> Stones: ...
    def __getitem__(self, index: int | slice | Sequence[int] | npt.NDArray[Any]) -> Stone | Stones:
        if isinstance(index, slice):
            return Stones(self._all[index])
        if np.ndim(index) == 0:
            return self._all[cast(int, index)]
        chosen = np.arange(len(self))[_several(index)]
        return Stones([self._all[number] for number in chosen.tolist()])

    def __len__(self) -> int:
        return len(self.stones)

    def __add__(self, other: Sequence[Stone | Shape]) -> Stones:
        return Stones([*self, *Stones(other)])

    def __radd__(self, other: Sequence[Stone | Shape]) -> Stones:
        return Stones(other) + self

    def __repr__(self) -> str:
        return f"<Stones: {picture.in_words(self)}>"

    def _repr_html_(self) -> str:
        return picture.html(self)

    @property
    def _all(self) -> tuple[Stone, ...]:
        return cast(tuple[Stone, ...], self.stones)


def _stone(name: str, item: Stone | Shape) -> Stone:
    _check.instance(name, item, Stone | Shape, "a Stone, an Outline or an Ellipse")
    return item if isinstance(item, Stone) else Stone(item)


def _outline(name: str, corners: npt.ArrayLike) -> Outline:
    vertices = _check.array(name, corners, ("k", 2))
    try:
        return Outline(vertices)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None


def _slope(outline: Outline) -> Outline:
    return _check.instance("outline", outline, Outline, "an Outline")


def _several(index: npt.ArrayLike) -> npt.NDArray[Any]:
    given = np.asarray(index)
    if given.ndim != 1 or (given.size and given.dtype.kind not in "bui"):
        raise TypeError(
            "index must be a whole number, a slice, some whole numbers or a mask, "
            f"got {given.dtype} of shape {given.shape}"
        )
    return given if given.size else given.astype(np.intp)
