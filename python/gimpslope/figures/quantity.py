"""What maps show, and in which colours."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib import colormaps
from matplotlib.colors import Colormap, LinearSegmentedColormap, LogNorm, Normalize

from .._check import FloatArray
from ..analysis import PLASTIC_THRESHOLD
from ..snapshot import Snapshot

SOIL_COLOUR = "#dcb98a"
STONE_COLOUR = "#56657a"
PAPER_COLOUR = "#c44e52"
_REST = "0.85"
_GOLDEN = 0.618034  # neighbours in number are far from each other in shade
_STONE_SHADES = ("#3d4a5c", "#97a5b8")


@dataclass(frozen=True, eq=False)
class Quantity:
    """What a map shows: the values of a state, and how they become colours, given the largest.

    Stones have an edge of a colour, with a dark halo where it is light.
    """

    values: Callable[[Snapshot], FloatArray]
    norm: Callable[[float], Normalize]
    cmap: Colormap
    label: str
    edge: str
    halo: bool = False

    def largest(self, states: Iterable[Snapshot]) -> float:
        """Largest value of the states; 0 without any."""
        each = (float(np.nanmax(self.values(state), initial=0.0)) for state in states)
        return max(each, default=0.0)


def _soil_plastic_strain(state: Snapshot) -> FloatArray:
    visible_when_zero = np.maximum(state.plastic_strain, 0.1 * PLASTIC_THRESHOLD)
    return np.where(state.points.stone < 0, visible_when_zero, np.nan)


def _from_zero(largest: float) -> Normalize:
    return Normalize(0.0, largest if largest > 0 else 1.0)


SPEED = Quantity(
    lambda state: state.speed,
    _from_zero,
    colormaps["viridis"],
    "speed (m/s)",
    edge="0.9",
    halo=True,
)
DISPLACEMENT = Quantity(
    lambda state: state.displacement_sizes[:, 0],
    _from_zero,
    colormaps["cividis"],
    "displacement (m)",
    edge="0.9",
    halo=True,
)
PLASTIC = Quantity(
    _soil_plastic_strain,
    lambda largest: LogNorm(PLASTIC_THRESHOLD, max(largest, 100 * PLASTIC_THRESHOLD)),
    colormaps["inferno_r"].with_extremes(under=_REST, bad=STONE_COLOUR),
    f"plastic strain (grey: below {PLASTIC_THRESHOLD:g})",
    edge=STONE_COLOUR,
)


def stone_shade(stone: npt.NDArray[np.int32]) -> FloatArray:
    """A shade in [0, 1) for the number of each stone, NaN for soil (-1)."""
    return np.where(stone >= 0, _GOLDEN * stone % 1.0, np.nan)


KIND = Quantity(
    lambda state: stone_shade(state.points.stone),
    lambda _: Normalize(0.0, 1.0),
    LinearSegmentedColormap.from_list("stones", _STONE_SHADES).with_extremes(bad=SOIL_COLOUR),
    "soil and stones",
    edge="#26303d",
)
"""Soil, and each stone in a shade of its own."""
