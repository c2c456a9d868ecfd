"""A plan and its answer in words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from . import stones
from .estimate import Estimate
from .quantities import QUANTITIES

if TYPE_CHECKING:
    from .plan import Answer, Plan
    from .search import Search


def plan(made: Plan) -> str:
    """A plan: what is run, why, and what is to be expected of it."""
    setup, levels = made.setup, made.levels
    verdict = (
        f"The plan holds {made.error:.3g} by its estimate."
        if made.holds
        else f"The plan cannot promise {made.error:.3g}."
    )
    cost = (
        f"about {made.seconds:.0f} s of wall time after {made.pilot_seconds:.0f} s of pilots"
        if levels
        else f"which is the finest pilot; the pilots took {made.pilot_seconds:.0f} s"
    )
    lines = [
        verdict,
        f"Run: cell {setup.scene.cell:g} m, {setup.scene.n_points:,} points, Courant number "
        f"{setup.method.courant:.2g}, slide of {setup.stages.slide.duration:g} s at most, {cost}.",
        *(f"- {reason[0].upper()}{reason[1:]}." for reason in made.reasons),
        "",
        f"{'by the pilots':26}{'value':>22}{'error':>9}{'after the run':>16}{'at worst':>10}",
    ]
    lines += [
        f"{_title(one)}{one.shown:>22}{_share(one.error):>9}{_share(one.predicted(levels)):>16}"
        f"{_share(one.at_worst(levels)):>10}  {one.stands}"
        for one in made.estimates.values()
    ]
    return "\n".join(lines)


def answer(found: Answer) -> str:
    """An answer: each quantity as extrapolated, with the raw values beside it."""
    reached = "is reached" if found.reached else "is not reached"
    cells = [grid.cell for grid in found.grids]
    lines = [
        f"The error of {found.error:.3g} {reached} by the estimate, after {found.seconds:.1f} s.",
        f"{'':26}{'value':>22}{'error':>9}" + "".join(f"{f'{cell:g} m':>9}" for cell in cells),
    ]
    for one in found.estimates.values():
        scale = QUANTITIES[one.name].scale
        raw = "".join(f"{value / scale:9.4g}" for value in one.raw).ljust(9 * len(cells))
        lines.append(f"{_title(one)}{one.shown:>22}{_share(one.error):>9}{raw}  {one.stands}")
    return "\n".join(lines)


def limits(found: Search, levels: int) -> tuple[str, ...]:
    """Why this grid: what sets it, and what an error would need that it cannot promise."""
    reasons = []
    needed, target = found.levels, found.target
    cell = found.pilots[-1].cell
    if needed is None:
        lost = [one for one in found.estimates if one.levels(target.error) is None]
        reasons += [
            f"{QUANTITIES[one.name].title}: {one.behaviour} from {one.cells[-3:][0]:g} to {cell:g} "
            f"m, which tells no cell that would do for {target.error:.3g}"
            for one in lost
        ]
    elif needed > levels:
        whole = sum(found.seconds(n) for n in range(1, needed + 1))
        reasons.append(
            f"{target.error:.3g} needs a cell of about {cell / 2**needed:.3g} m, some "
            f"{whole:,.0f} s, which the budget of {target.budget:g} s does not allow"
        )
    elif needed == 0:
        reasons.append("the finest pilot's grid will do")
    else:
        worst = max(found.estimates, key=lambda one: one.predicted(needed - 1))
        reasons.append(
            f"{QUANTITIES[worst.name].title} sets the cell: its error is estimated as "
            f"{worst.predicted(needed - 1):.2g} at {cell / 2 ** (needed - 1):g} m"
        )
    end = found.tail
    if levels and len(found.wanted) < len(target.quantities):
        reasons.append(
            "the slide ends when its kinetic energy has passed its peak, for the pilots know all "
            "that comes later well enough"
        )
    elif levels and end.growth:
        most = max(abs(factor - 1) for factor in end.growth.values())
        reasons.append(
            f"the slide ends at {end.time:.3g} s: what creeps on after it, {most:.2g} at most, is "
            "taken from the finest pilot"
        )
    return (*reasons, *_of_stones(found, levels))


def _of_stones(found: Search, levels: int) -> tuple[str, ...]:
    seen = stones.sampling(found.problem.on(len(found.pilots) - 1 + levels).scene)
    if seen is None:
        return ()
    gaps = (
        f"the grid of the run has {seen.area:.3f} of the stones' area, and {seen.gap:.2f} cells in "
        "the narrowest gap"
    )
    apart = found.levels_apart
    if apart is not None and apart <= levels:
        return (gaps,)
    coarse = stones.sampling(found.pilots[-1].run.scene)
    close = 0.0 if coarse is None else coarse.close
    cell = stones.cell_apart(found.saved.setup.scene)
    need = (
        "some touch, so that no grid will tell them apart"
        if apart is None
        else f"three grids that tell them apart begin at {cell:.3g} m and end at {cell / 4:.3g} m"
    )
    if close == 0:
        return gaps, need
    return (
        gaps,
        "stones closer than two cells act as one, for the soil between them has no nodes of its "
        f"own, which no order covers: {100 * close:.0f} % of them at {found.pilots[-1].cell:g} m; "
        f"{need}",
    )


def _title(one: Estimate) -> str:
    return f"{QUANTITIES[one.name].title:26}"


def _share(error: float) -> str:
    return f"{100 * error:.1f} %" if math.isfinite(error) else "-"
