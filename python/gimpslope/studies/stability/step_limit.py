"""The longest stable step, by shape function, scheme, points a cell and place of the points.

A row of eight cells of points with free ends, and a free block of five by five, start with small
random velocities under FLIP; the step from which on these grow is found by bisection. For a row
theory is the eigenvalues of a step (`amplification`), at the same places; for both it is the
bound by the stiffest point (`point_bound`). Points at yield are of clay whose stress across the
plane is as large as it bears, so that the sides are free of forces.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, get_args

import numpy as np
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ...method import Scheme, Shape
from ..check import Check
from . import rows
from .amplification import FINENESS, first_unstable, limit
from .mode import Findings, Mode, Table
from .point_bound import bound

LENGTH, SIDE = 8, 5  # of row and block, cells
POISSON = 0.33  # of the block
SPEED, GROWN = 1e-9, 1e3  # of the first motion; times that it grows by when it is unstable
STEPS, LOOKS = 2000, 20
YIELD = 1e-3  # cohesion in stiffnesses, far above what a motion a thousand times SPEED takes
SCHEMES: tuple[Scheme, ...] = get_args(Scheme)
DEFAULT = ("ugimp", "usf")
COURANT_OF_DEFAULT = 0.4
Kind = tuple[Shape, Scheme, int]
PUBLISHED: dict[Kind, tuple[float, float]] = {  # range of the limit in a row, over all places
    ("ugimp", "usf", 1): (2.0, 2.5),
    ("ugimp", "usf", 2): (1.74, 1.97),
    ("ugimp", "usf", 4): (1.65, 1.78),
    ("linear", "usf", 2): (1.41, 1.74),
}


class Case(NamedTuple):
    """Shape functions, scheme, points a cell and direction, and 1 for a row or 2 for a block."""

    shape: Shape
    scheme: Scheme
    per_side: int
    dimensions: int


class Limits(NamedTuple):
    """Largest stable C by place: in the kernel, elastic and at yield, and by theory; none where it
    was not looked for."""

    elastic: FloatArray
    at_yield: FloatArray
    theory: FloatArray


def run(full: bool) -> Findings:
    """All schemes and shapes; in full at more places and with one to four points a cell."""
    offsets = np.arange(0.02, 1, 1 / 6 if full else 1 / 2)
    cases = [
        Case(shape, scheme, per_side, dimensions)
        for dimensions in (1, 2)
        for per_side in ((1, 2, 4) if full else (2,))
        for shape in gs.kernel.shapes()
        for scheme in SCHEMES
    ]
    found = {case: limits(case, offsets, _at_yield(case, full)) for case in cases}
    return Findings(_fails(found), _stands(found), draw(found, offsets), _table(found))


def limits(case: Case, offsets: FloatArray, at_yield: bool) -> Limits:
    """Those of one case with the points' corner at each offset, cells."""
    places = [rows.points(*_cells(case, offset)) for offset in offsets]
    elastic, clay = _laws(case)
    measured = [first_unstable(_trial(case, of, elastic)) for of in places]
    flowing = [first_unstable(_trial(case, of, clay)) for of in places] if at_yield else []
    theory = [_theory(case, of) for of in places] if case.dimensions == 1 else []
    return Limits(np.array(measured), np.array(flowing), np.array(theory))


def _at_yield(case: Case, full: bool) -> bool:
    """Whether to look for the limit at yield, too."""
    return case[:2] == DEFAULT or (full and case.scheme == "usf")


def _cells(case: Case, offset: float) -> tuple[tuple[int, int], int, tuple[float, float]]:
    if case.dimensions == 1:
        return (LENGTH, 1), case.per_side, (offset, 0.0)
    return (SIDE, SIDE), case.per_side, (offset, offset)


def _laws(case: Case) -> tuple[gs.Material, gs.Material]:
    elastic = rows.material(POISSON if case.dimensions == 2 else 0.0)
    constants = elastic.density, elastic.young, elastic.poisson
    return elastic, gs.DruckerPrager(*constants, friction=0.0, cohesion=YIELD)


def _theory(case: Case, of: gs.Points) -> float:
    row = of.position[:, 1] == of.position[0, 1]
    along = rows.along(case.shape, of.position[row, 0], of.half_length[row, 0])
    return limit(*along, case.scheme)


def _trial(case: Case, of: gs.Points, law: gs.Material) -> Callable[[float], bool]:
    """Whether a small motion grows under the step C."""
    velocity = SPEED * np.random.default_rng(1).uniform(-1, 1, of.position.shape)
    row = case.dimensions == 1
    if row:
        velocity[:, 1] = 0.0
    stress = np.zeros((len(of), 4))
    if isinstance(law, gs.DruckerPrager):
        stress[:, 2] = -np.sqrt(3.0) * YIELD

    def grows(courant: float) -> bool:
        method = gs.Method(
            shape=case.shape,
            scheme=case.scheme,
            alpha=0.0,
            time_step=courant,
            allow_unstable=True,
        )
        solver = rows.solver(of, law, method, row=row, velocity=velocity)
        solver.stress = stress
        try:
            for _ in range(LOOKS):
                solver.advance(STEPS // LOOKS)
                if solver.energies().max_speed > GROWN * SPEED:
                    return True
        except gs.Diverged:
            return True
        return False

    return grows


def _fails(found: dict[Case, Limits]) -> list[Check]:
    apart = {
        case: float(np.abs(of.elastic / of.theory - 1).max())
        for case, of in found.items()
        if case.dimensions == 1 and case.scheme != "usl"
    }
    checks = [
        Check.at_most(
            "limit of a row, kernel against theory, largest departure (USF, MUSL)",
            bound=3 * (FINENESS - 1),
            got=max(apart.values()),
            why="eigenvalues of the step; both are bisected to 1 %, and growth is slow at the "
            "limit",
        )
    ]
    for (shape, scheme, per_side), (low, high) in PUBLISHED.items():
        case = Case(shape, scheme, per_side, 1)
        if case not in found:
            continue
        for name, got in (
            ("smallest", found[case].elastic.min()),
            ("largest", found[case].elastic.max()),
        ):
            checks.append(
                Check(
                    f"{name} limit of a row, {shape}, {scheme}, {per_side} a cell",
                    expected=low if name == "smallest" else high,
                    got=float(got),
                    low=0.97 * low,
                    high=1.03 * high,
                    why="within the published range over all places: two digits, 1 % of bisection",
                )
            )
    one = [
        of.elastic.min()
        for case, of in found.items()
        if case.shape == "linear" and case.per_side == 1 and case.scheme != "usl"
    ]
    if one:
        checks.append(
            Check.at_most(
                "smallest limit, linear hats with one point a cell",
                bound=1.0,
                got=float(min(one)),
                why="a point near a node sees it alone: C = 1, which is taken, is too long",
            )
        )
    checks.append(
        Check.at_most(
            "smallest limit, USL",
            bound=0.71,
            got=float(min(of.elastic.min() for case, of in found.items() if case.scheme == "usl")),
            why="sqrt(2 l / h) = 0.707 at two a cell: `small_masses`; published 0.08 to 0.71 there",
        )
    )
    return checks


def _stands(found: dict[Case, Limits]) -> list[Check]:
    default = [of for case, of in found.items() if case[:2] == DEFAULT]
    sure = [
        of.elastic.min()
        / bound(case.shape, case.per_side, POISSON * (case.dimensions - 1), case.dimensions)
        for case, of in found.items()
        if case.shape != "linear" and case.scheme != "usl"
    ]
    return [
        Check.at_least(
            "smallest limit of the default, uGIMP and USF, in rows and blocks",
            bound=1.0,
            got=float(min(of.elastic.min() for of in default)),
            why=f"no step above C = 1 is taken, {COURANT_OF_DEFAULT} by default",
        ),
        Check.at_least(
            "the same at yield",
            bound=1.0,
            got=float(min(of.at_yield.min() for of in default)),
            why="flow makes soil softer: no frequency is higher than in the elastic range",
        ),
        Check.at_least(
            "smallest limit over the bound by the stiffest point (USF, MUSL, but for linear hats)",
            bound=1.0,
            got=float(min(sure)),
            why="the bound is sufficient: no place may be below it",
        ),
    ]


def _table(found: dict[Case, Limits]) -> Table:
    columns = (
        "shape",
        "scheme",
        "points a cell and direction",
        "in",
        "elastic",
        "theory",
        "at yield",
        "published",
        "bound by the stiffest point",
    )
    listed: list[tuple[str | float, ...]] = [
        (
            case.shape,
            case.scheme,
            case.per_side,
            f"{case.dimensions}D",
            _range(of.elastic),
            _range(of.theory),
            _range(of.at_yield),
            _range(np.array(PUBLISHED.get(case[:3], ()))) if case.dimensions == 1 else "",
            _bound(case),
        )
        for case, of in found.items()
    ]
    return Table(columns, listed)


def _range(values: FloatArray) -> str:
    return f"{values.min():.2f} to {values.max():.2f}" if len(values) else ""


def _bound(case: Case) -> str:
    if case.shape == "linear" or case.scheme == "usl":
        return "none" if case.shape == "linear" else ""
    poisson = POISSON if case.dimensions == 2 else 0.0
    return f"{bound(case.shape, case.per_side, poisson, case.dimensions):.3f}"


def draw(found: dict[Case, Limits], offsets: FloatArray) -> Figure:
    """Limit over the place of the points, two a cell and direction."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    for ax, dimensions in zip(figure.subplots(1, 2, sharey=True), (1, 2), strict=True):
        shown = {c: of for c, of in found.items() if c.per_side == 2 and c.dimensions == dimensions}
        shapes = list(dict.fromkeys(case.shape for case in shown))
        for case, of in shown.items():
            number = shapes.index(case.shape)
            colour = f"C{number}"
            mark = {"usf": "o", "usl": "v", "musl": "x"}[case.scheme]
            ax.plot(
                offsets,
                of.elastic,
                mark,
                color=colour,
                ms=10 - 2 * number,  # those of equal limits around each other
                mfc="none",
                label=f"{case.shape}, {case.scheme}",
            )
            if len(of.theory):
                ax.plot(offsets, of.theory, "-", color=colour, linewidth=0.6)
        ax.axhline(
            COURANT_OF_DEFAULT, color="k", linestyle=":", linewidth=0.8, label="default step"
        )
        ax.set(xlabel="place of the points (cells)", ylim=(0, None))
        ax.set_title("row; lines: theory" if dimensions == 1 else f"block, nu = {POISSON}")
    figure.axes[0].set_ylabel("largest stable c dt / h")
    figure.legend(
        *figure.axes[0].get_legend_handles_labels(), loc="outside right center", fontsize=8
    )
    return figure


MODE = Mode(
    name="step_limit",
    title="Steps that are too long",
    mechanism="A grid of springs and masses has a highest frequency omega, and an explicit step "
    "is stable up to 2 / omega. Points on their way through the cells change the frequencies, "
    "and where a node holds little mass beside its stiffness they are high. USF and MUSL average "
    "the velocities once more before they strain, which more than makes up for it; USL does not.",
    source="Bardenhagen 2002, J. Comput. Phys. 180, 383; Ni & Zhang 2020, IJNME 121, 4989; bound "
    "by the stiffest part: Hughes 1987, The Finite Element Method, section 9.1",
    advice="Keep `Method(courant=0.4)`, the default, and never above 1. At the worst place linear "
    "hats with one point a cell are stable to 0.83, USL to 0.46 and with linear hats to 0.16.",
    run=run,
)
