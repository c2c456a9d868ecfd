"""Maps of one state of a run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.patches import Patch

from .. import _check
from .._check import FloatArray
from ..analysis import stone_outlines
from ..run import Run
from ..run_file import Moment
from ..snapshot import Snapshot
from .canvas import colour_bar, draw_outline, draw_points, draw_stones, new_axes
from .quantity import (
    DISPLACEMENT,
    KIND,
    PLASTIC,
    SOIL_COLOUR,
    SPEED,
    STONE_COLOUR,
    Quantity,
    stone_shade,
)


def speed(run: Run, time: Moment, ax: Axes | None = None, *, largest: float | None = None) -> Axes:
    """Map of the speed (m/s) at `time` (s, or "peak").

    The colours of this map and the next two end at the largest value shown, or at `largest`, by
    which several maps share a scale. Stones are drawn with their edges.
    """
    return _map(run, run.snapshot(time), SPEED, ax, largest)


def plastic_zone(
    run: Run, time: Moment, ax: Axes | None = None, *, largest: float | None = None
) -> Axes:
    """Map of the equivalent plastic strain of the soil at `time`, on a logarithmic scale.

    Points below the threshold of the plastic zone are light grey, stones dark.
    """
    return _map(run, run.snapshot(time), PLASTIC, ax, largest)


def displacement(
    run: Run,
    time: Moment | None = None,
    ax: Axes | None = None,
    *,
    largest: float | None = None,
) -> Axes:
    """Map of the displacement since the trigger (m) at `time`, or in the end."""
    return _map(run, run.state(time), DISPLACEMENT, ax, largest)


def shape(run: Run, time: Moment | None = None, ax: Axes | None = None) -> Axes:
    """Soil and stones at `time`, or in the end, and the outline they started from.

    Each stone has a shade of its own and is drawn as its outline, moved rigidly with its points.
    """
    ax = ax or new_axes()
    draw_state(ax, run, run.state(time), KIND, KIND.norm(1.0))
    ax.legend(handles=kinds([run]), loc="upper right")
    return ax


def map_of(
    values: FloatArray,
    state: Snapshot,
    ax: Axes | None = None,
    *,
    label: str,
    outline: FloatArray | None = None,
    cmap: str = "viridis",
    norm: Normalize | None = None,
) -> Axes:
    """Map of any values at the points of a snapshot, with a colour bar.

    Parameters
    ----------
    values : one a point, shape (n,)
    state : where the points are
    label : of the colour bar, with the unit
    outline : drawn as a thin line, m, shape (k, 2)
    cmap : name of a matplotlib colour map
    norm : from values to colours; None: linear from the least to the largest value
    """
    ax = ax or new_axes()
    norm = norm or Normalize(float(np.nanmin(values)), float(np.nanmax(values)))
    draw_points(ax, state.position, state.half_length, values, norm, colormaps[cmap])
    draw_outline(ax, outline)
    colour_bar([ax], norm, colormaps[cmap], label)
    return ax


def kinds(runs: Iterable[Run]) -> list[Patch]:
    """What a legend of shapes explains: soil, stones if there are any, the outline."""
    found = [Patch(color=SOIL_COLOUR, label="soil")]
    if any(run.scene.stones for run in runs):
        found.append(Patch(color=STONE_COLOUR, label="stone"))
    start = Patch(facecolor="none", edgecolor="black", linewidth=0.8, label="outline at the start")
    return [*found, start]


def draw_state(ax: Axes, run: Run, state: Snapshot, quantity: Quantity, norm: Normalize) -> None:
    """Values, edges of stones and the outline at the start, without a colour bar."""
    values = quantity.values(state)
    draw_points(ax, state.position, state.half_length, values, norm, quantity.cmap)
    draw_outlines(ax, stone_outlines(run.scene, state), quantity)
    draw_outline(ax, run.scene.outline.vertices)


def draw_outlines(ax: Axes, outlines: Sequence[FloatArray], quantity: Quantity) -> None:
    """The stones as they belong to a map of the quantity: filled where it is the kind."""
    shades = stone_shade(np.arange(len(outlines), dtype=np.int32))
    faces = KIND.cmap(shades) if quantity is KIND else "none"
    draw_stones(ax, outlines, quantity.edge, halo=quantity.halo, faces=faces)


def _map(
    run: Run, state: Snapshot, quantity: Quantity, ax: Axes | None, largest: float | None
) -> Axes:
    ax = ax or new_axes()
    shown = quantity.largest([state]) if largest is None else _check.positive("largest", largest)
    norm = quantity.norm(shown)
    draw_state(ax, run, state, quantity, norm)
    colour_bar([ax], norm, quantity.cmap, quantity.label)
    ax.set_title(f"{state.time:.2f} s")
    return ax
