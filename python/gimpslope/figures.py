"""Pictures of runs. Functions draw into the Axes they are given, or a new one, and return it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon

from . import _check
from ._check import FloatArray
from .energy import Energy
from .ledger import LedgerRows
from .run import PLASTIC_THRESHOLD, Run
from .snapshot import Snapshot

Moment = float | Literal["peak"]

SPEED_TIMES: tuple[Moment, ...] = (0.5, "peak", 3.5)
PLASTIC_TIMES: tuple[Moment, ...] = (1.0, "peak", 5.0)

_REST = "0.85"
_STONE = "#56657a"
_SOIL = "#dcb98a"
_PAPER = "#c44e52"
_WIDTH = 8.0
_DPI = 150
_GAP_FILLING = 3.0
_CORNERS = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])


class _Quantity(NamedTuple):
    """What a map shows: the values of a state, and how they become colours, given the largest."""

    values: Callable[[Snapshot], FloatArray]
    norm: Callable[[float], Normalize]
    cmap: Colormap
    label: str


def _soil_plastic_strain(state: Snapshot) -> FloatArray:
    visible_when_zero = np.maximum(state.plastic_strain, 0.1 * PLASTIC_THRESHOLD)
    return np.where(state.points.material == 0, visible_when_zero, np.nan)


def _from_zero(largest: float) -> Normalize:
    return Normalize(0.0, largest if largest > 0 else 1.0)


_SPEED = _Quantity(lambda state: state.speed, _from_zero, colormaps["viridis"], "speed (m/s)")
_DISPLACEMENT = _Quantity(
    lambda state: np.linalg.norm(state.displacement, axis=1),
    _from_zero,
    colormaps["cividis"],
    "displacement (m)",
)
_PLASTIC = _Quantity(
    _soil_plastic_strain,
    lambda largest: LogNorm(PLASTIC_THRESHOLD, max(largest, 100 * PLASTIC_THRESHOLD)),
    colormaps["inferno_r"].with_extremes(under=_REST, bad=_STONE),
    f"plastic strain (grey: below {PLASTIC_THRESHOLD:g})",
)


def kinetic_energy(
    energy: Energy, ax: Axes | None = None, *, reference: Mapping[str, float] | None = None
) -> Axes:
    """Kinetic energy (kJ/m) against time (s), with its peak and the time of the paper's.

    `reference` holds values of the paper by the keys of a run's summary; time_of_peak is used here.
    """
    ax = ax or _new_axes()
    ax.plot(energy.time, energy.kinetic / 1e3, color="C0", linewidth=1.8)
    if len(energy):
        time, value = energy.peak
        label = f"peak: {value / 1e3:.4g} kJ/m at {time:.2f} s"
        ax.plot([time], [value / 1e3], "o", color="C0", markersize=7, label=label)
    if reference and "time_of_peak" in reference:
        time = reference["time_of_peak"]
        label = f"time of the paper's peak: {time:g} s"
        ax.axvline(time, color=_PAPER, linestyle="--", linewidth=1.2, label=label)
    ax.set(xlabel="time since the trigger (s)", ylabel="kinetic energy (kJ/m)")
    ax.set_xlim(left=0)
    ax.margins(y=0.25)
    ax.set_ylim(bottom=0)
    ax.grid(alpha=0.3)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper right")
    return ax


_AREAS = (
    ("plastic", "plastic work", "#8c2d04"),
    ("friction", "friction at walls", "#d94801"),
    ("impact", "impact at walls", "#f7a35c"),
    ("damping", "damping", "#7f7f7f"),
    ("transfer", "transfer between points and grid", "#6a51a3"),
    ("kinetic", "kinetic", "#2171b5"),
    ("elastic", "elastic", "#41ab5d"),
    ("potential", "potential, above its least", "#d9d9d9"),
)
_VISIBLE = 1e-3


def ledger(rows: LedgerRows, ax: Axes | None = None) -> Axes:
    """Stacked areas of all energies (kJ/m) against time (s): what there is, and where it went.

    Parts below a thousandth of the whole are left out, and so are negative parts; the two entries
    that may have either sign, the residue of the time step and that of the rate law, are one line.
    """
    ax = ax or _new_axes()
    parts = {name: getattr(rows, name) / 1e3 for name, _, _ in _AREAS}
    parts["potential"] = parts["potential"] - parts["potential"].min(initial=np.inf)
    whole = float(np.sum(list(parts.values()), axis=0).max(initial=0.0))
    shown = [area for area in _AREAS if np.max(parts[area[0]], initial=0.0) > _VISIBLE * whole]
    ax.stackplot(
        rows.time,
        [np.maximum(parts[name], 0.0) for name, _, _ in shown],
        labels=[label for _, label, _ in shown],
        colors=[colour for _, _, colour in shown],
    )
    residue = (rows.integration + rows.hypoelastic) / 1e3
    ax.plot(rows.time, residue, "k--", linewidth=1.0, label="residues of step and rate law")
    ax.set(xlabel="time since the trigger (s)", ylabel="energy (kJ/m)")
    ax.set_xlim(np.min(rows.time, initial=0.0), np.max(rows.time, initial=0.0) or 1.0)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)
    return ax


def speed(run: Run, time: float, ax: Axes | None = None, *, largest: float | None = None) -> Axes:
    """Map of the speed (m/s) at `time` (s).

    The colours of this map and the next two end at the largest value shown, or at `largest`, by
    which several maps share a scale.
    """
    return _map(run, run.snapshot(time), _SPEED, ax, largest)


def plastic_zone(
    run: Run, time: float, ax: Axes | None = None, *, largest: float | None = None
) -> Axes:
    """Map of the equivalent plastic strain of the soil at `time` (s), on a logarithmic scale.

    Points below the threshold of the plastic zone are light grey, stones dark.
    """
    return _map(run, run.snapshot(time), _PLASTIC, ax, largest)


def displacement(
    run: Run, time: float | None = None, ax: Axes | None = None, *, largest: float | None = None
) -> Axes:
    """Map of the displacement since the trigger (m) at `time` (s), or in the end."""
    return _map(run, run.state(time), _DISPLACEMENT, ax, largest)


def shape(run: Run, time: float | None = None, ax: Axes | None = None) -> Axes:
    """Soil and stones at `time` (s), or in the end, and the outline they started from."""
    ax = ax or _new_axes()
    state = run.state(time)
    cmap = ListedColormap([_SOIL, _STONE])
    _draw(ax, state, state.points.material.astype(np.float64), Normalize(0, 1), cmap)
    _draw_outline(ax, run.scene.outline.vertices)
    kinds = [Patch(color=_SOIL, label="soil"), Patch(color=_STONE, label="stone")]
    kinds = kinds[: len(run.scene.materials)]
    start = Patch(facecolor="none", edgecolor="black", linewidth=0.8, label="outline at the start")
    ax.legend(handles=[*kinds, start], loc="upper right")
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
    ax = ax or _new_axes()
    norm = norm or Normalize(float(np.nanmin(values)), float(np.nanmax(values)))
    _draw(ax, state, values, norm, colormaps[cmap])
    _draw_outline(ax, outline)
    _colour_bar([ax], norm, colormaps[cmap], label)
    return ax


def displacement_bars(
    runs: Mapping[str, Run],
    reference: Mapping[str, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Bars of the largest displacement in the end (m): total, horizontal and vertical.

    `runs` are named as in the legend; `reference` holds values of the paper by the keys of a run's
    summary: max_displacement_total, max_displacement_horizontal and max_displacement_vertical.
    """
    ax = ax or _new_axes()
    names = ("total", "horizontal", "vertical")
    bars: list[tuple[str, str, Sequence[float]]] = [
        (name, f"C{number}", tuple(run.max_displacement()))
        for number, (name, run) in enumerate(runs.items())
    ]
    if reference:
        paper = [reference.get(f"max_displacement_{name}", np.nan) for name in names]
        bars.append(("the paper", _PAPER, paper))
    width = 0.8 / len(bars)
    for number, (name, colour, heights) in enumerate(bars):
        places = np.arange(len(names)) + (number - (len(bars) - 1) / 2) * width
        drawn = ax.bar(places, heights, 0.92 * width, color=colour, label=name)
        ax.bar_label(drawn, fmt="%.2f", padding=2, fontsize="small")
    ax.set_xticks(range(len(names)), names)
    ax.set_ylabel("largest displacement (m)")
    ax.margins(y=0.25)
    ax.legend(loc="upper right")
    return ax


def write_figures(
    run: Run, directory: str | PathLike[str], reference: Mapping[str, float] | None = None
) -> list[Path]:
    """Write the figures of the study for one run as PNG, and return their paths.

    kinetic_energy.png, ledger.png where the run kept one, speed.png, plastic_zone.png,
    displacement.png and displacement_bars.png.
    A panel of a time after the run's end is left out, and says so.

    Parameters
    ----------
    run : a run that has reached the slide
    directory : made if it does not exist
    reference : values of the paper by the keys of a run's summary: time_of_peak,
        max_displacement_total, max_displacement_horizontal, max_displacement_vertical

    Raises
    ------
    ValueError
        If the run has no points, energy or snapshots of the slide.
    """
    made = {
        "kinetic_energy": _figure(lambda ax: kinetic_energy(run.energy, ax, reference=reference)),
        **({"ledger": _figure(lambda ax: ledger(run.ledger, ax))} if run.method.ledger else {}),
        "speed": _panels(run, _SPEED, SPEED_TIMES),
        "plastic_zone": _panels(run, _PLASTIC, PLASTIC_TIMES),
        "displacement": _end_figure(run),
        "displacement_bars": _figure(
            lambda ax: displacement_bars({run.path.stem: run}, reference, ax)
        ),
    }
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{name}.png" for name in made]
    for path, figure in zip(paths, made.values(), strict=True):
        figure.savefig(path, dpi=_DPI, bbox_inches="tight")
    return paths


def _figure(draw: Callable[[Axes], Axes]) -> Figure:
    figure = Figure(figsize=(_WIDTH, 0.55 * _WIDTH), layout="constrained")
    draw(figure.add_subplot())
    return figure


def _panels(run: Run, quantity: _Quantity, moments: Sequence[Moment]) -> Figure:
    """One map below the other, at the same scales."""
    times = [run.energy.peak.time if moment == "peak" else moment for moment in moments]
    states = [_reached(run, time) for time in times]
    shown = [state for state in states if state is not None]
    norm = quantity.norm(max((_largest(quantity, state) for state in shown), default=0.0))
    figure, axes = _stacked(run, len(moments), shown)
    for ax, moment, time, state in zip(axes, moments, times, states, strict=True):
        _draw_outline(ax, run.scene.outline.vertices)
        if state is None:
            last = np.max(run.times, initial=0.0)
            ax.set_title(f"{time:.2f} s: not reached, the last snapshot is at {last:.2f} s")
            continue
        _draw(ax, state, quantity.values(state), norm, quantity.cmap)
        peak = f" (kinetic energy peaks at {time:.2f} s)" if moment == "peak" else ""
        ax.set_title(f"{state.time:.2f} s{peak}")
    _colour_bar(axes, norm, quantity.cmap, quantity.label)
    return figure


def _reached(run: Run, time: float) -> Snapshot | None:
    try:
        return run.snapshot(time)
    except ValueError:
        return None


def _end_figure(run: Run) -> Figure:
    """Displacement in the end above the shape in the end."""
    state = run.final
    figure, (above, below) = _stacked(run, 2, [state])
    norm = _DISPLACEMENT.norm(_largest(_DISPLACEMENT, state))
    _draw(above, state, _DISPLACEMENT.values(state), norm, _DISPLACEMENT.cmap)
    _draw_outline(above, run.scene.outline.vertices)
    _colour_bar([above, below], norm, _DISPLACEMENT.cmap, _DISPLACEMENT.label)
    above.set_title(f"displacement at {state.time:.2f} s")
    shape(run, ax=below)
    below.set_title(f"shape at {state.time:.2f} s")
    return figure


def _stacked(run: Run, count: int, states: Sequence[Snapshot]) -> tuple[Figure, list[Axes]]:
    """A figure of maps one below the other, as high as their common frame makes it."""
    corners = np.concatenate([run.scene.outline.vertices, *(state.position for state in states)])
    width, height = np.ptp(corners, axis=0)
    panel = min(0.8 * _WIDTH * height / width, _WIDTH) + 0.45
    figure = Figure(figsize=(_WIDTH, count * panel + 0.4), layout="constrained")
    axes = figure.subplots(count, sharex=True, sharey=True, squeeze=False)[:, 0].tolist()
    return figure, axes


def _map(
    run: Run, state: Snapshot, quantity: _Quantity, ax: Axes | None, largest: float | None
) -> Axes:
    ax = ax or _new_axes()
    shown = _largest(quantity, state) if largest is None else _check.positive("largest", largest)
    norm = quantity.norm(shown)
    _draw(ax, state, quantity.values(state), norm, quantity.cmap)
    _draw_outline(ax, run.scene.outline.vertices)
    _colour_bar([ax], norm, quantity.cmap, quantity.label)
    ax.set_title(f"{state.time:.2f} s")
    return ax


def _largest(quantity: _Quantity, state: Snapshot) -> float:
    return float(np.nanmax(quantity.values(state), initial=0.0))


def _draw(ax: Axes, state: Snapshot, values: FloatArray, norm: Normalize, cmap: Colormap) -> None:
    """Each point as a square of its own volume, over a larger one that fills opening gaps.

    The larger ones stay in the bounding box of the points, so that none reaches beyond a wall.
    """
    growth = np.sqrt(state.volume / state.points.volume)
    half = state.points.half_length * growth[:, np.newaxis]
    squares = state.position[:, np.newaxis] + _CORNERS * half[:, np.newaxis]
    larger = state.position[:, np.newaxis] + _GAP_FILLING * _CORNERS * half[:, np.newaxis]
    box = squares.min(axis=(0, 1)), squares.max(axis=(0, 1))
    for drawn in (np.clip(larger, *box), squares):
        points = PolyCollection(
            list(drawn),
            array=np.ma.masked_invalid(values),
            norm=norm,
            cmap=cmap,
            edgecolors="none",
            antialiaseds=False,
            rasterized=True,
        )
        ax.add_collection(points)
    _set_frame(ax)


def _draw_outline(ax: Axes, vertices: FloatArray | None) -> None:
    if vertices is not None:
        ax.add_patch(Polygon(vertices, fill=False, edgecolor="black", linewidth=0.8, zorder=3))
    _set_frame(ax)


def _set_frame(ax: Axes) -> None:
    ax.set_aspect("equal")
    ax.margins(0.02)
    ax.autoscale_view()
    ax.set_ylabel("y (m)")
    ax.set_xlabel("x (m)")
    ax.label_outer()


def _colour_bar(axes: Sequence[Axes], norm: Normalize, cmap: Colormap, label: str) -> None:
    extend = "min" if isinstance(norm, LogNorm) else "neither"
    mappable = ScalarMappable(norm, cmap)
    axes[0].figure.colorbar(mappable, ax=axes, label=label, extend=extend, aspect=18 * len(axes))


def _new_axes() -> Axes:
    from matplotlib import pyplot

    return pyplot.subplots(layout="constrained")[1]
