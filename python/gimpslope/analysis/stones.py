"""How each stone moves: translation and rotation, and what is left of its motion after these."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._check import FloatArray
from ..snapshot import Snapshot
from ..stones import Stones
from .rigid import rigid_motion

if TYPE_CHECKING:
    from ..scene import Scene


@dataclass(frozen=True, eq=False)
class StoneMotion:
    """The motion of s stones over k snapshots since the trigger.

    Attributes
    ----------
    time : s, shape (k,)
    centroid : centre of mass of the points of a stone, m, shape (k, s, 2)
    rotation : counterclockwise, degrees, shape (k, s); counts whole turns, as long as a stone turns
        by less than half of one between two snapshots; NaN for a stone of one point
    deformation : distance of the points from where translation and rotation take them, root mean
        square by mass, as a share of the diameter of a circle of the stone's area, shape (k, s)
    """

    time: FloatArray
    centroid: FloatArray
    rotation: FloatArray
    deformation: FloatArray

    @property
    def translation(self) -> FloatArray:
        """Displacement of the centre of mass since the first snapshot, m, shape (k, s, 2)."""
        moved: FloatArray = self.centroid - self.centroid[0]
        return moved


def stone_motion(states: Iterable[Snapshot], count: int) -> StoneMotion:
    """The motion of the `count` stones over snapshots, from the trigger on.

    Raises `ValueError` if there are no snapshots.
    """
    states = list(states)
    if not states:
        raise ValueError("states must be at least one snapshot, got none")
    points = states[0].points
    area = np.bincount(points.stone[points.stone >= 0], points.volume[points.stone >= 0], count)
    size = np.sqrt(4 * area / np.pi)
    found = [
        rigid_motion(points.stone, points.mass, points.position, state.position, count)
        for state in states
    ]
    return StoneMotion(
        time=np.array([state.time for state in states]),
        centroid=np.array([motion.after for motion in found]),
        rotation=np.unwrap([motion.rotation for motion in found], axis=0, period=360.0),
        deformation=np.array([motion.misfit for motion in found]) / size,
    )


def stone_outlines(scene: Scene, state: Snapshot) -> list[FloatArray]:
    """Where the outline of each stone is, moved rigidly with its points: corners (k, 2), m.

    A stone of one point, whose rotation cannot be told, is not turned.
    """
    outlines, start = first_outlines(scene), scene.points.position
    stone, mass = state.points.stone, state.points.mass
    motion = rigid_motion(stone, mass, start, state.position, len(outlines))
    angles = np.nan_to_num(motion.rotation)
    return [
        after + _turned(outline - before, angle)
        for outline, before, after, angle in zip(
            outlines, motion.before, motion.after, angles, strict=True
        )
    ]


def first_outlines(scene: Scene) -> list[FloatArray]:
    """The outline of each stone of the unloaded slope, that of an ellipse as a polygon: corners
    (k, 2), the first again at the end, m."""
    shapes = Stones(scene.stones).shapes
    return [np.asarray(shape.polygon.exterior.coords, dtype=np.float64) for shape in shapes]


def _turned(arms: FloatArray, angle: float) -> FloatArray:
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turned: FloatArray = arms @ np.array([(cos, sin), (-sin, cos)])
    return turned
