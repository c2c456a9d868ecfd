"""The figures of the reference study, Front. Earth Sci. 2022, 10:968250, for runs of its slopes.

Each takes one to four runs, or more, by names such as "A soil", whose first word names the panels.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from ..analysis import first_outlines
from ..run import Run
from ..scene import Scene
from .bars import displacement_bars_by_run
from .canvas import draw_outline, draw_points
from .curves import kinetic_energies
from .maps import draw_outlines, kinds
from .panels import WIDTH, Column, panels
from .paper import Paper
from .quantity import DISPLACEMENT, KIND, PLASTIC, SPEED, stone_shade
from .single import PLASTIC_TIMES, SPEED_TIMES

_CLOSE_UP = 5.0  # s


def initial_slopes(runs: Mapping[str, Run]) -> Figure:
    """Figure 3: the slopes at the start as the points that are simulated, two a row."""
    _refuse_none(runs)
    columns = min(2, len(runs))
    rows = -(-len(runs) // columns)
    sides = [np.ptp(run.scene.outline.vertices, axis=0) for run in runs.values()]
    width, height = np.max(sides, axis=0)
    panel = 0.85 * WIDTH / 2 * height / width + 0.5
    figure = Figure(figsize=(columns * WIDTH / 2, rows * panel), layout="constrained")
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    for ax, (name, run) in zip(axes, runs.items(), strict=False):
        points = run.scene.points
        shade = stone_shade(points.stone)
        norm = KIND.norm(1.0)
        draw_points(ax, points.position, points.half_length, shade, norm, KIND.cmap)
        draw_outlines(ax, first_outlines(run.scene), KIND)
        draw_outline(ax, run.scene.outline.vertices)
        ax.set_title(f"{name}: {_counted(run.scene)}", fontsize="medium")
    axes[0].legend(handles=kinds(runs.values()), loc="upper right")
    for unused in axes[len(runs) :]:
        unused.set_axis_off()
    return figure


def kinetic_energy(runs: Mapping[str, Run], paper: Paper | None = None) -> Figure:
    """Figure 4: kinetic energies, (a) over the whole time and (b) over the first five seconds."""
    _refuse_none(runs)
    energies = {name: run.energy for name, run in runs.items()}
    figure = Figure(figsize=(WIDTH, 0.45 * WIDTH), layout="constrained")
    whole, close = figure.subplots(1, 2, sharey=True)
    kinetic_energies(energies, whole, reference=paper)
    kinetic_energies(energies, close, until=_CLOSE_UP, reference=paper)
    whole.set_title("(a)", loc="left", fontsize="medium")
    close.set_title("(b)", loc="left", fontsize="medium")
    legend = whole.get_legend()
    texts = [text.get_text() for text in legend.texts]
    figure.legend(legend.legend_handles, texts, loc="outside lower center", ncols=len(texts))
    for ax in (whole, close):
        ax.get_legend().remove()
    close.label_outer()
    return figure


def speed(runs: Mapping[str, Run]) -> Figure:
    """Figure 5: speed at 0.5 s, at each slope's largest kinetic energy, and at 3.5 s."""
    _refuse_none(runs)
    return panels(runs, [Column(SPEED, moment) for moment in SPEED_TIMES])


def plastic_zone(runs: Mapping[str, Run]) -> Figure:
    """Figure 6: plastic strain of the soil at 1 s, at the largest kinetic energy, and at 5 s."""
    _refuse_none(runs)
    return panels(runs, [Column(PLASTIC, moment) for moment in PLASTIC_TIMES])


def displacement(runs: Mapping[str, Run]) -> Figure:
    """Figure 7: displacement and shape in the end."""
    _refuse_none(runs)
    return panels(runs, [Column(DISPLACEMENT, None), Column(KIND, None)])


def displacement_bars(runs: Mapping[str, Run], paper: Paper | None = None) -> Figure:
    """Figure 8: the largest total, horizontal and vertical displacement of each slope in the end.

    Raises `ValueError` for a run without snapshots.
    """
    _refuse_none(runs)
    figure = Figure(figsize=(WIDTH, 0.42 * WIDTH), layout="constrained")
    displacement_bars_by_run(runs, paper, figure.add_subplot())
    return figure


def figures(runs: Mapping[str, Run], paper: Paper | None = None) -> dict[int, Figure]:
    """All of them, by the number of the paper's figure, 3 to 8.

    Raises `ValueError` without runs, for a run without snapshots, and for values of the paper by a
    name that no run has.
    """
    return {
        3: initial_slopes(runs),
        4: kinetic_energy(runs, paper),
        5: speed(runs),
        6: plastic_zone(runs),
        7: displacement(runs),
        8: displacement_bars(runs, paper),
    }


def _counted(scene: Scene) -> str:
    stones = len(scene.stones)
    kinds = ["", ", 1 stone", f", {stones:,} stones"]
    return f"{scene.n_points:,} points{kinds[min(stones, 2)]}"


def _refuse_none(runs: Mapping[str, Run]) -> None:
    if not runs:
        raise ValueError("runs must hold at least one run, got none")
