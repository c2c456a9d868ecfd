"""The scene: what is simulated, from outlines and materials to material points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from typing import cast

import numpy as np
import numpy.typing as npt
import shapely

from . import _check
from ._check import FloatArray
from ._record import Record
from .materials import Deformable, Material
from .outline import Outline
from .stones import Stone, Stones
from .stones.stone import Shape
from .walls import Free, Walls

_GRID_LINE = 1e-6
_MOST_MATERIALS = 65_535
_MOST_STONES = 2**31 - 1
_NO_STONES = np.empty(0, dtype=np.int32)


@dataclass(frozen=True, eq=False)
class Points:
    """Material points, one read-only array a property.

    Attributes
    ----------
    position : m, shape (n, 2)
    half_length : half the sides of the point's square, m, shape (n, 2)
    volume : area in the plane, m2 (m3 a metre of width), shape (n,)
    mass : kg/m, shape (n,)
    material : index into the scene's materials, shape (n,), whole numbers
    stone : number of the stone that the point is part of, -1 for none, shape (n,), whole numbers;
        all -1 where left out

    Raises
    ------
    TypeError, ValueError
        If an array is of the wrong type or shape, or holds a number that is not finite.
    """

    position: FloatArray
    half_length: FloatArray
    volume: FloatArray
    mass: FloatArray
    material: npt.NDArray[np.int32]
    stone: npt.NDArray[np.int32] = field(default_factory=lambda: _NO_STONES)

    def __post_init__(self) -> None:
        n = len(_check.array("position", self.position, ("n", 2)))
        shapes = {"position": (n, 2), "half_length": (n, 2), "volume": (n,), "mass": (n,)}
        for name, shape in shapes.items():
            object.__setattr__(self, name, _check.array(name, getattr(self, name), shape))
        stone = np.full(n, -1) if self.stone is _NO_STONES else self.stone
        numbers = {
            "material": _check.numbers("material", self.material, n, 0, _MOST_MATERIALS),
            "stone": _check.numbers("stone", stone, n, -1, _MOST_STONES),
        }
        for name, values in numbers.items():
            object.__setattr__(self, name, values)

    def __len__(self) -> int:
        return len(self.position)


@dataclass(frozen=True)
class Scene(Record):
    """A slope of soil, with or without stones, on a background grid between walls.

    Parameters
    ----------
    outline : outline of the slope
    soil : material of the slope, not a rigid one
    stones : the stones (`Stones`, or a sequence of Stone, Outline and Ellipse), inside the slope;
        they may touch but not overlap
    stone : material of the stones that have none of their own; needed with such, and only then
    cell : side of a grid cell, m, > 0. The grid starts at the lower left corner of the outline's
        bounding box
    points_per_cell : points a cell, the square of a whole number; the points lie on a lattice
        of spacing cell / sqrt(points_per_cell)
    walls : conditions on the sides of the outline's bounding box. A right or top wall needs its
        side on a grid line, within 1e-6 cell
    gravity : m/s2, > 0, downwards

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type or out of its range, if a stone overlaps another, leaves
        the slope or holds no point, if the slope holds none, or if a right or top wall is off the
        grid lines.
    """

    outline: Outline
    soil: Material
    _: KW_ONLY
    stones: Stones | Sequence[Stone | Shape] = Stones()  # noqa: RUF009 (frozen)
    stone: Material | None = None
    cell: float = 0.1
    points_per_cell: int = 4
    walls: Walls = Walls()  # noqa: RUF009 (frozen)
    gravity: float = 9.81

    def __post_init__(self) -> None:
        _check.instance("outline", self.outline, Outline, "an Outline")
        _check.instance("soil", self.soil, Deformable, "a deformable material")
        _check.instance("walls", self.walls, Walls, "a Walls")
        self._store(
            cell=_check.positive("cell", self.cell),
            points_per_cell=_check.whole("points_per_cell", self.points_per_cell, 1),
            gravity=_check.positive("gravity", self.gravity),
        )
        if math.isqrt(self.points_per_cell) ** 2 != self.points_per_cell:
            raise ValueError(
                "points_per_cell must be the square of a whole number (1, 4, 9, ...), "
                f"got {self.points_per_cell}"
            )
        self._check_stones()
        self._check_walls()
        self._check_points()

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials that `points.material` counts: soil, that of the stones that have none of
        their own, then theirs, each kind once."""
        own = (stone.material for stone in self._stones)
        return tuple(dict.fromkeys(k for k in (self.soil, self.stone, *own) if k is not None))

    @property
    def material_names(self) -> tuple[str, ...]:
        """Names of the materials: soil and stone, or soil, stone 1, stone 2 and so on."""
        kinds = len(self.materials) - 1
        return ("soil", *(f"stone {k}" if kinds > 1 else "stone" for k in range(1, kinds + 1)))

    @property
    def spacing(self) -> float:
        """Distance between neighbouring points, m."""
        return self.cell / math.isqrt(self.points_per_cell)

    @property
    def origin(self) -> tuple[float, float]:
        """A node of the grid: the lower left corner of the outline's bounding box, m."""
        return self.outline.bounds[:2]

    @property
    def wall_positions(self) -> tuple[float, float, float, float]:
        """x of the left and right, y of the bottom and top side, m; of a wall, its grid line."""
        left, bottom, right, top = self.outline.bounds
        if not isinstance(self.walls.right, Free):
            right = left + round((right - left) / self.cell) * self.cell
        if not isinstance(self.walls.top, Free):
            top = bottom + round((top - bottom) / self.cell) * self.cell
        return left, right, bottom, top

    @property
    def n_points(self) -> int:
        """Number of material points."""
        return len(self.points)

    @cached_property
    def points(self) -> Points:
        """The material points at the start, row by row from the bottom, each row from the left."""
        position = self.outline.lattice(self.spacing)
        numbers = self._stones.numbers(position)
        counts = np.bincount(numbers[numbers >= 0], minlength=len(self._stones))
        for number in np.flatnonzero(counts == 0).tolist():
            raise ValueError(
                f"cell must be small enough for a point in stones[{number}], got {self.cell:.6g} m "
                f"with a stone of {self._stones[number].area:.3g} m2; {self._sure_cell():.2g} m or "
                "less is sure to do for every stone"
            )
        kinds = [self.materials.index(stone.material or self.stone) for stone in self._stones]
        material = np.array([*kinds, 0], dtype=np.int32)[numbers]
        volume = np.full(len(position), self.spacing**2)
        return Points(
            position=position,
            half_length=np.full_like(position, self.spacing / 2),
            volume=volume,
            mass=volume * np.array([kind.density for kind in self.materials])[material],
            material=material,
            stone=numbers,
        )

    @property
    def _stones(self) -> Stones:
        return cast(Stones, self.stones)

    def _sure_cell(self) -> float:
        """Side of a cell that puts a point into every stone, wherever the grid begins, m.

        A square lattice has a point in every circle whose radius is its spacing over root two or
        more; 5 % less leaves room for rounding.
        """
        shapes = [shape.polygon for shape in self._stones.shapes]
        radius = float(shapely.length(shapely.maximum_inscribed_circle(shapes)).min())
        return 0.95 * math.sqrt(2 * self.points_per_cell) * radius

    def _check_stones(self) -> None:
        self._store(stones=Stones(self.stones) if type(self.stones) is not Stones else self.stones)
        if self.stone is not None:
            _check.instance("stone", self.stone, Material, "a material or None")
        bare = sum(stone.material is None for stone in self._stones)
        if bool(bare) != (self.stone is not None):
            raise ValueError(
                "stone must be given with stones that have no material of their own and only then, "
                f"got {self.stone!r} with {bare} such stones"
            )
        if len(outside := self._stones.outside(self.outline)):
            raise ValueError(
                f"stones[{outside[0]}] must lie inside the outline, got {len(outside)} of "
                f"{len(self._stones)} stones that do not: {outside.tolist()}"
            )
        if len(overlaps := self._stones.overlaps()):
            first, second = overlaps[0]
            raise ValueError(
                f"stones[{first}] must not overlap stones[{second}], got {len(overlaps)} pairs "
                f"that overlap: {overlaps.tolist()}"
            )

    def _check_walls(self) -> None:
        left, bottom, right, top = self.outline.bounds
        for side, length in (("right", right - left), ("top", top - bottom)):
            cells = length / self.cell
            off_line = abs(cells - round(cells)) > _GRID_LINE
            if off_line and not isinstance(getattr(self.walls, side), Free):
                raise ValueError(
                    f"walls.{side} must be Free() or lie on a grid line, got {length:.9g} m from "
                    f"the opposite side, which is {cells:.9g} cells of {self.cell:.9g} m"
                )

    def _check_points(self) -> None:
        if self.n_points == 0:
            raise ValueError(
                f"cell must be small enough for a point inside the outline, got {self.cell} m "
                f"with an outline of {self.outline.area:.6g} m2"
            )
