"""Slope A on finer and finer grids: what converges, at which order, and to what.

Everything else scales with the cell: the time step by the Courant number, the points by four a
cell; the viscosity of the velocity blend stays the same, which alpha a step would not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from os import PathLike
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from .. import _check
from ..recording import Recording
from ..run import Run
from . import plain_data, planned, reference
from .planned import Planned
from .richardson import Extrapolation, check_cells, extrapolate

CELLS = (0.4, 0.2, 0.1, 0.05)
DURATION = 10.0  # s
_NEAR_PEAK = 0.05  # s
_DPI = 72
_LEGEND = (
    "*Orders* are those of each three grids in a row, a dash where their two changes differ in "
    "sign. What the last three grids do is said at the end of a row: *converges* with an order "
    "between 0.5 and 2.1, and then the limit by Richardson's extrapolation with its uncertainty "
    "(1.25 times the extrapolated difference); *order not settled* outside of that (three times "
    "the spread); *oscillates*; or *diverges*, the last change being the larger one. Shares are "
    "parts of the drop in potential energy."
)


@dataclass(frozen=True)
class Quantity:
    """A result of the slide: what it is, its unit, its values from coarse to fine, its limit."""

    title: str
    unit: str
    values: tuple[float, ...]
    extrapolation: Extrapolation


@dataclass(frozen=True)
class Convergence:
    """The results of slope A on several grids.

    Attributes
    ----------
    reading : of the paper, see `reference.READINGS`
    cells : m, coarse to fine
    points : number of material points of each
    seconds : wall time spent stepping each, s
    quantities : what was looked at
    """

    reading: str
    cells: tuple[float, ...]
    points: tuple[int, ...]
    seconds: tuple[float, ...]
    quantities: tuple[Quantity, ...]


def plan(
    directory: str | PathLike[str],
    *,
    reading: str = "identified",
    cells: Sequence[float] = CELLS,
    duration: float = DURATION,
    threads: int = 1,
    overwrite: bool = False,
) -> list[Planned]:
    """The runs that a study needs, and those that are there already; writes nothing.

    Parameters
    ----------
    directory : for the run files. A finished run of the same scene, method, duration and version
        that is there already is taken as it is
    reading : "identified" or "literal"
    cells : m, each half of the one before, at least three
    duration : of the slide, s
    threads : of the solver
    overwrite : replace files of those names that hold other runs

    Raises
    ------
    TypeError, ValueError
        If a parameter is refused, or there are too few cells, or one is not half of the one before.
    FileExistsError
        If a file of those names holds something else and may not be replaced.
    """
    duration = _check.positive("duration", duration)
    grids = []
    for cell in check_cells(cells):
        setup = reference.setup(reading=reading, cell=cell, duration=duration, threads=threads)
        setup = replace(setup, recording=Recording(snapshot_interval=duration))
        path = Path(directory) / f"soil_{reading}_{cell:g}.h5"
        grids.append(planned.plan(path, setup, overwrite=overwrite))
    return grids


def converge(grids: Sequence[Planned], *, progress: bool = True) -> Convergence:
    """Run what was planned, and extrapolate. Directories are made if need be; raises as `simulate`
    does."""
    runs = [grid.run(progress=progress) for grid in grids]
    measured = [_measure(run) for run in runs]
    return Convergence(
        reading=reference.reading_of(runs[0].scene),
        cells=tuple(run.scene.cell for run in runs),
        points=tuple(len(run.points) for run in runs),
        seconds=tuple(float(run.attributes["timing"]["wall_seconds"]) for run in runs),
        quantities=tuple(
            Quantity(title, unit, values, extrapolate(values))
            for title, unit in measured[0]
            for values in [tuple(one[title, unit] for one in measured)]
        ),
    )


def _measure(run: Run) -> dict[tuple[str, str], float]:
    """Results by title and unit."""
    ledger, end = run.ledger, run.max_displacement()
    peak_time, peak = _peak(run)
    shares = ledger.shares()
    return {
        ("peak kinetic energy", "kJ/m"): peak / 1e3,
        ("time of the peak", "s"): peak_time,
        ("fastest point at the peak", "m/s"): run.energy.speed_at_peak,
        ("largest displacement", "m"): end.total,
        ("largest horizontal displacement", "m"): end.horizontal,
        ("largest vertical displacement", "m"): end.vertical,
        ("drop of the potential energy", "kJ/m"): ledger.turned_over / 1e3,
        ("share of plastic work", "1"): shares["plastic"],
        ("share of the transfer loss", "1"): shares["transfer"],
        ("residue of the time step, share", "1"): shares["integration"],
        ("plastic zone, share of the soil", "1"): float(run.plastic_zone().mean()),
        ("mean plastic strain", "1"): float(run.final.plastic_strain.mean()),
        ("largest plastic strain", "1"): float(run.final.plastic_strain.max()),
    }


def _peak(run: Run) -> tuple[float, float]:
    """Time (s) and height (J/m) of the kinetic energy's peak: a parabola through the rows near it,
    for a row every 5 ms is coarser than the differences between fine grids."""
    time, kinetic = run.energy.time, run.energy.kinetic
    near = np.abs(time - run.energy.peak.time) <= _NEAR_PEAK
    middle = run.energy.peak.time
    a, b, c = np.polyfit(time[near] - middle, kinetic[near], 2)
    return float(middle - b / (2 * a)), float(c - b**2 / (4 * a))


def markdown(study: Convergence) -> str:
    """The results as a table."""
    points = ", ".join(f"{n:,}" for n in study.points)
    head = ["quantity", *(f"h = {cell:g} m" for cell in study.cells), "orders", "limit", ""]
    lines = [
        f"## Slope A, reading `{study.reading}`",
        "",
        f"{points} points.",
        "",
        "| " + " | ".join(head) + " |",
        "|" + "---|" * len(head),
    ]
    for quantity in study.quantities:
        found = quantity.extrapolation
        unit = "" if quantity.unit == "1" else f", {quantity.unit}"
        limit = (
            "none" if math.isnan(found.limit) else f"{found.limit:.4g} ± {found.uncertainty:.2g}"
        )
        orders = ", ".join("-" if math.isnan(p) else f"{p:.1f}" for p in found.orders)
        values = [f"{value:.4g}" for value in quantity.values]
        cells = [quantity.title + unit, *values, orders, limit, found.behaviour]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def figure(study: Convergence) -> Figure:
    """Each result against the cell, with its limit where it has one."""
    columns = 4
    rows = math.ceil(len(study.quantities) / columns)
    made = Figure(figsize=(3.0 * columns, 2.4 * rows), layout="constrained")
    for place, quantity in enumerate(study.quantities, start=1):
        ax = made.add_subplot(rows, columns, place)
        found = quantity.extrapolation
        ax.plot(study.cells, quantity.values, "o-", color="C0", markersize=4)
        if not math.isnan(found.limit):
            ax.errorbar(0.0, found.limit, found.uncertainty, fmt="s", color="C3", capsize=3)
        ax.set_title(f"{quantity.title}\n{found.behaviour}", fontsize="small")
        ax.set_xlabel("cell (m)", fontsize="small")
        ax.set_ylabel("" if quantity.unit == "1" else quantity.unit, fontsize="small")
        ax.set_xlim(left=-0.05 * study.cells[0])
        ax.tick_params(labelsize="small")
        ax.grid(alpha=0.3)
    return made


def write(studies: Sequence[Convergence], directory: str | PathLike[str]) -> None:
    """Write convergence.md, convergence.json and a picture a reading into a directory."""
    folder = Path(directory)
    sections = [markdown(study) for study in studies]
    pictures = [f"![{study.reading}](convergence_{study.reading}.png)\n" for study in studies]
    parts = [part for pair in zip(sections, pictures, strict=True) for part in pair]
    head = (
        f"# Convergence of slope A\n\ngimpslope {version('gimpslope')}, `gimpslope converge`.\n\n"
    )
    (folder / "convergence.md").write_text(head + "\n".join(parts))
    for study in studies:
        figure(study).savefig(folder / f"convergence_{study.reading}.png", dpi=_DPI)
    plain = plain_data.dumps([asdict(study) for study in studies])
    (folder / "convergence.json").write_text(plain)
