"""The figures of the reference study for one run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..run import Run
from ..run_file import Moment
from ..snapshot import Snapshot
from .bars import displacement_bars
from .canvas import colour_bar, draw_outline
from .curves import kinetic_energy, ledger
from .maps import draw_state, shape
from .panels import last_snapshot, reached
from .quantity import DISPLACEMENT, PLASTIC, SPEED, Quantity

SPEED_TIMES: tuple[Moment, ...] = (0.5, "peak", 3.5)
PLASTIC_TIMES: tuple[Moment, ...] = (1.0, "peak", 5.0)

_WIDTH = 8.0
_DPI = 150


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
        "speed": moments(run, SPEED, SPEED_TIMES),
        "plastic_zone": moments(run, PLASTIC, PLASTIC_TIMES),
        "displacement": _end(run),
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


def moments(run: Run, quantity: Quantity, wanted: Sequence[Moment]) -> Figure:
    """Maps of several moments, one below the other, at the same scales."""
    states = [reached(run, moment) for moment in wanted]
    shown = [state for state in states if state is not None]
    norm = quantity.norm(quantity.largest(shown))
    figure, axes = _stacked(run, len(wanted), shown)
    for ax, moment, state in zip(axes, wanted, states, strict=True):
        time = run.energy.peak.time if moment == "peak" else moment
        if state is None:
            draw_outline(ax, run.scene.outline.vertices)
            ax.set_title(f"{time:.2f} s: not reached, {last_snapshot(run)}")
            continue
        draw_state(ax, run, state, quantity, norm)
        peak = f" (kinetic energy peaks at {time:.2f} s)" if moment == "peak" else ""
        ax.set_title(f"{state.time:.2f} s{peak}")
    colour_bar(axes, norm, quantity.cmap, quantity.label)
    return figure


def _figure(draw: Callable[[Axes], Axes]) -> Figure:
    figure = Figure(figsize=(_WIDTH, 0.55 * _WIDTH), layout="constrained")
    draw(figure.add_subplot())
    return figure


def _end(run: Run) -> Figure:
    """Displacement in the end above the shape in the end."""
    state = run.final
    figure, (above, below) = _stacked(run, 2, [state])
    norm = DISPLACEMENT.norm(DISPLACEMENT.largest([state]))
    draw_state(above, run, state, DISPLACEMENT, norm)
    colour_bar([above, below], norm, DISPLACEMENT.cmap, DISPLACEMENT.label)
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
