"""Stones in a plan: whether they may be rigid, and from which cell on the grid tells them apart."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..materials import Deformable, DruckerPrager, Material, Rigid
from ..method_warning import NEAR_STONES
from ..scene import Scene
from ..stones import Stones

_STRONG = 4.0


class Sampling(NamedTuple):
    """Stones as a grid has them.

    Attributes
    ----------
    gap : the smallest distance of two stones, in cells; infinite for one
    close : share of the stones that are closer than two cells to another
    area : of the stones' points over that of their outlines
    """

    gap: float
    close: float
    area: float

    @property
    def apart(self) -> bool:
        """Whether no two stones share nodes."""
        return self.gap >= NEAR_STONES


def sampling(scene: Scene) -> Sampling | None:
    """The stones of a scene as its grid has them; None without stones."""
    stones = Stones(scene.stones)
    if not len(stones):
        return None
    gaps = stones.gaps() / scene.cell
    points = scene.points
    return Sampling(
        gap=float(gaps.min()),
        close=float(np.mean(gaps < NEAR_STONES)),
        area=float(points.volume[points.stone >= 0].sum()) / stones.area,
    )


def cell_apart(scene: Scene) -> float:
    """The largest cell on which no two stones share nodes, m; 0 where two touch, infinite for fewer
    than two."""
    stones = Stones(scene.stones)
    return float(stones.gaps().min()) / NEAR_STONES if len(stones) > 1 else math.inf


def made_rigid(scene: Scene, share: float) -> tuple[Scene, str]:
    """The scene with those of its stones rigid that hardly deform and cannot yield, and why.

    A stone hardly deforms where stones hold less than `share` of the elastic compliance of the
    mixture, which is at most (Reuss 1929) the mean of the compliances by area; it cannot yield
    where its strength in compression is at least four times the weight of the slope's whole height.
    """
    stones = Stones(scene.stones)
    own = tuple(dict.fromkeys(stone.material or scene.stone for stone in stones))
    deformable = [kind for kind in own if isinstance(kind, Deformable)]
    if not deformable:
        return scene, ""
    content = stones.content(scene.outline)
    stiff = [kind for kind in deformable if _is_stiff(kind, scene, content, share)]
    if len(stiff) < len(deformable):
        return scene, "stones stay deformable: they are not stiff and strong enough beside the soil"
    changed = [
        replace(stone, material=None if stone.material is None else _rigid(stone.material))
        for stone in stones
    ]
    stone = None if scene.stone is None else _rigid(scene.stone)
    least = min(kind.young for kind in stiff)
    why = (
        f"stones are rigid: at {least / 1e9:.3g} GPa they hold "
        f"{_compliance(least, scene, content):.2g} of the compliance at most and cannot yield, and "
        "the step is that of the soil"
    )
    return replace(scene, stones=Stones(changed), stone=stone), why


def _is_stiff(kind: Deformable, scene: Scene, content: float, share: float) -> bool:
    weight = kind.density * scene.gravity * (scene.outline.bounds[3] - scene.outline.bounds[1])
    return _compliance(kind.young, scene, content) <= share and _strength(kind) >= _STRONG * weight


def _compliance(young: float, scene: Scene, content: float) -> float:
    """Share of the compliance of the mixture that is of stones, all under the same stress."""
    soil = scene.soil
    assert isinstance(soil, Deformable)
    of_stones = content / young
    return of_stones / (of_stones + (1 - content) / soil.young)


def _strength(kind: Deformable) -> float:
    """In uniaxial compression by Mohr-Coulomb, 2 c cos(phi) / (1 - sin(phi)), Pa."""
    if not isinstance(kind, DruckerPrager):
        return math.inf
    phi = math.radians(kind.friction)
    return 2 * kind.cohesion * math.cos(phi) / (1 - math.sin(phi))


def _rigid(material: Material) -> Rigid:
    return Rigid(material.density)
