"""What does and does not converge where soil slips in bands.

Soil that neither hardens nor dilates has no length of its own: a slip band is as wide as the grid
lets it be, and the strain in it is the slip over that width. Slope A on grids of halved cells under
one viscosity of the velocity blend: energies of the whole slope approach a limit, the largest
plastic strain does not.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from .. import reference
from ..check import Check
from .mode import Findings, Mode, Table

CELLS = {False: (0.8, 0.4, 0.2), True: (0.4, 0.2, 0.1)}  # m
DURATION = {False: 1.5, True: 2.5}  # s
BAND = 0.5  # share of the largest plastic strain (99.5 %) that counts as in a band


class Slide(NamedTuple):
    """Kinetic energy (J/m), mean and largest (99.5 %) plastic strain, in the end, and the area with
    half of that, m2."""

    kinetic: float
    mean: float
    largest: float
    band: float


def run(full: bool) -> Findings:
    """Slope A on three grids."""
    cells = CELLS[full]
    slides = {cell: slide(cell, DURATION[full]) for cell in cells}
    coarse, middle, fine = (slides[cell] for cell in cells)
    strains = [middle.largest / coarse.largest, fine.largest / middle.largest]
    fails = [
        Check.at_least(
            "largest plastic strain (99.5 %): smaller of the ratios from grid to halved grid",
            bound=1.1,
            got=min(strains),
            why="slip over the width of a band; 1 if it had a limit",
        ),
        Check.at_most(
            "area of the bands: larger of the ratios from grid to halved grid",
            bound=0.9,
            got=max(middle.band / coarse.band, fine.band / middle.band),
            why="some cells wide on any grid; 1 if it had a limit",
        ),
    ]
    stands = [
        Check.at_most(
            f"{label}: change in the last halving over that in the one before",
            bound=0.5**0.5,
            got=change(middle, fine, name) / change(coarse, middle, name),
            why="an order of a half and more; `gimpslope converge` finds 0.6 to 1.4",
        )
        for name, label in (("kinetic", "kinetic energy"), ("mean", "mean plastic strain"))
    ]
    listed: list[tuple[str | float, ...]] = [
        (cell, of.kinetic / 1e3, of.mean, of.largest, of.band) for cell, of in slides.items()
    ]
    columns = (
        "cell, m",
        f"kinetic energy at {DURATION[full]:g} s, kJ/m",
        "mean plastic strain",
        "largest (99.5 %)",
        "area above half of it, m2",
    )
    return Findings(fails, stands, draw(slides), Table(columns, listed))


def slide(cell: float, duration: float) -> Slide:
    """Slope A, as identified."""
    with tempfile.TemporaryDirectory() as folder:
        setup = reference.setup(cell=cell, duration=duration)
        run = setup.simulate(Path(folder) / "slope.h5", progress=False)
        strain, volume = run.plastic_strain(), run.state(None).volume
        largest = float(np.percentile(strain, 99.5))
        return Slide(
            float(run.energy.kinetic[-1]),
            float(strain @ volume / volume.sum()),
            largest,
            float(volume[strain > BAND * largest].sum()),
        )


def change(coarse: Slide, fine: Slide, name: str) -> float:
    """Size of the difference of a quantity on two grids."""
    return abs(float(getattr(fine, name) - getattr(coarse, name)))


def draw(slides: dict[float, Slide]) -> Figure:
    """Quantities over the cell, of those on the coarsest grid."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    ax = figure.add_subplot()
    first = next(iter(slides.values()))
    names = {
        "kinetic": "kinetic energy",
        "mean": "mean plastic strain",
        "largest": "largest plastic strain",
        "band": "area of the bands",
    }
    for name, label in names.items():
        values = [getattr(of, name) / getattr(first, name) for of in slides.values()]
        ax.semilogx(list(slides), values, "o-", label=label)
    ax.set(xlabel="cell (m)", ylabel="of that on the coarsest grid")
    ax.set_xticks(list(slides), [f"{cell:g}" for cell in slides])
    ax.minorticks_off()
    ax.legend()
    return figure


MODE = Mode(
    name="localisation",
    title="Slip bands without a width",
    mechanism="Perfectly plastic soil that does not dilate fails along surfaces: the equations "
    "lose ellipticity and contain no length that would set the width of a band. On a grid it "
    "becomes some cells wide, so that its strain grows without end as cells shrink, while slip, "
    "energy and displacement hang on the force it carries, which has a limit. What is read off a "
    "point inside a band says something of the grid.",
    source="Rudnicki & Rice 1975, J. Mech. Phys. Solids 23, 371; de Borst, Sluys, Muhlhaus & "
    "Pamin 1993, Eng. Comput. 10, 99",
    advice="Report energies, displacements and mean strains, each on two or three grids "
    "(`gimpslope converge`); do not report the largest plastic strain or the width of a band.",
    run=run,
)
