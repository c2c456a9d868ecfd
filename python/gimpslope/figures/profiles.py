"""Profiles of surfaces."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.axes import Axes

from .._check import FloatArray
from ..analysis import ROUGHNESS_LENGTH, Surface
from .canvas import draw_outline, new_axes


def surfaces(
    profiles: Mapping[str, Surface],
    ax: Axes | None = None,
    *,
    length: float = ROUGHNESS_LENGTH,
    outline: FloatArray | None = None,
) -> Axes:
    """Surfaces of several runs, at equal scales, with their roughness in the legend.

    Parameters
    ----------
    profiles : by the names in the legend
    length : of the moving fit from which roughness is measured, m
    outline : drawn as a thin line, m, shape (k, 2)

    Raises
    ------
    TypeError, ValueError
        If the length is refused by `Surface.roughness`.
    """
    ax = ax or new_axes()
    for name, profile in profiles.items():
        rough = f"roughness {100 * profile.roughness(length):.2g} cm"
        ax.plot(profile.x, profile.y, linewidth=1.4, label=f"{name}: {rough}" if name else rough)
    draw_outline(ax, outline)
    ax.legend(loc="upper right")
    return ax
