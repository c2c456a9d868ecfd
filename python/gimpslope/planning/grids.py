"""Grids of a scene, each with half the cell of the one before: where they begin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..scene import Scene
from ..stones import Stones

_ACROSS = 10
"""Cells across the smaller side of the outline that the coarsest grid has at least."""


def coarsest(scene: Scene) -> Scene:
    """The scene on the coarsest grid that still says something of it: cells are doubled as long as
    ten lie across the outline, half of the stones are a cell or more apart, every stone has a
    point, and walls are on grid lines."""
    while (coarser := _coarser(scene)) is not None:
        scene = coarser
    return scene


def finer(scene: Scene, levels: int) -> Scene:
    """The scene with its cell halved so many times."""
    return replace(scene, cell=scene.cell / 2**levels)


def n_points(scene: Scene, levels: int) -> int:
    """About the number of points of `finer(scene, levels)`, without making them."""
    return round(scene.outline.area / (scene.spacing * 0.5**levels) ** 2)


def _coarser(scene: Scene) -> Scene | None:
    cell = 2 * scene.cell
    left, bottom, right, top = scene.outline.bounds
    if min(right - left, top - bottom) < _ACROSS * cell:
        return None
    stones = Stones(scene.stones)
    if len(stones) > 1 and np.median(stones.gaps()) < cell:
        return None
    try:
        return replace(scene, cell=cell)
    except ValueError:
        return None
