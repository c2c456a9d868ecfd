"""What maps are made of: points as squares, outlines, the frame and the colour bar."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap, LogNorm, Normalize
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke

from .._check import FloatArray

_GAP_FILLING = 3.0
_CORNERS = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])


def new_axes() -> Axes:
    """Axes in a new figure of pyplot."""
    from matplotlib import pyplot

    return pyplot.subplots(layout="constrained")[1]


def draw_points(
    ax: Axes,
    position: FloatArray,
    half_length: FloatArray,
    values: FloatArray,
    norm: Normalize,
    cmap: Colormap,
) -> None:
    """Each point as its square, over a larger one that fills opening gaps.

    The larger ones stay in the bounding box of the points, so that none reaches beyond a wall.
    """
    arms = _CORNERS * half_length[:, np.newaxis]
    squares = position[:, np.newaxis] + arms
    box = squares.min(axis=(0, 1)), squares.max(axis=(0, 1))
    larger = np.clip(position[:, np.newaxis] + _GAP_FILLING * arms, *box)
    for drawn in (larger, squares):
        points = PolyCollection(
            drawn,  # type: ignore[arg-type]  # an array is read much faster than a list
            array=np.ma.masked_invalid(values),
            norm=norm,
            cmap=cmap,
            edgecolors="none",
            antialiaseds=False,
            rasterized=True,
        )
        ax.add_collection(points, autolim=False)
    ax.update_datalim(box)
    set_frame(ax)


def draw_outline(ax: Axes, vertices: FloatArray | None) -> None:
    """The outline of the slope at the start, as a thin line."""
    if vertices is not None:
        ax.add_patch(Polygon(vertices, fill=False, edgecolor="black", linewidth=0.8, zorder=3))
    set_frame(ax)


def draw_stones(
    ax: Axes, outlines: Sequence[FloatArray], edge: str, *, halo: bool, faces: Any = "none"
) -> None:
    """Stones as their outlines; a dark halo makes light edges visible on light ground."""
    stones = PolyCollection(outlines, facecolors=faces, edgecolors=edge, linewidths=0.6, zorder=2.5)
    if halo:
        stones.set_path_effects([withStroke(linewidth=1.4, foreground="black", alpha=0.5)])
    ax.add_collection(stones, autolim=False)


def set_frame(ax: Axes) -> None:
    """Equal scales, a narrow margin, and labels at the outer panels."""
    ax.set_aspect("equal")
    ax.margins(0.02)
    ax.autoscale_view()
    ax.set_ylabel("y (m)")
    ax.set_xlabel("x (m)")
    ax.label_outer()


def colour_bar(
    axes: Sequence[Axes], norm: Normalize, cmap: Colormap, label: str, **more: Any
) -> None:
    """A colour bar for all the axes, beside them unless `more`, which goes to matplotlib, tells."""
    extend = "min" if isinstance(norm, LogNorm) else "neither"
    mappable = ScalarMappable(norm, cmap)
    shape = {"aspect": 18 * len(axes)} | more
    axes[0].figure.colorbar(mappable, ax=axes, label=label, extend=extend, **shape)
