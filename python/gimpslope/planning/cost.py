"""How long a run on a finer grid takes, by the runs that there are."""

from __future__ import annotations

from collections.abc import Sequence

from .pilot import Pilot


def seconds(pilots: Sequence[Pilot], points: int, levels: int, slide: float = 1.0) -> float:
    """Wall time of a run, s.

    A step takes some time for itself and some a point, which the last two pilots tell apart; what a
    run takes beside its steps, most of it output, goes by the points and the length of the slide.
    The number of steps follows from the cell, as the step does, and grows from grid to grid as it
    did last (loose soil at the front has fast waves, and finer grids have looser points).

    Parameters
    ----------
    pilots : coarse to fine
    points : of the run
    levels : how often the cell of the finest pilot is halved
    slide : how long the slide lasts, as a share of that of the pilots
    """
    last = pilots[-1]
    growth = 2.0
    a_step = last.stepping / last.steps
    constant, a_point = 0.0, a_step / last.points
    if len(pilots) > 1:
        before = pilots[-2]
        growth = max(last.steps / last.reached / (before.steps / before.reached), growth)
        slope = (a_step - before.stepping / before.steps) / (last.points - before.points)
        if 0 < slope < a_point:
            constant, a_point = a_step - slope * last.points, slope
    steps = last.loading_steps + slide * (last.steps - last.loading_steps)
    beside = (last.seconds - last.stepping) * slide * points / last.points
    return float(steps * growth**levels * (constant + a_point * points) + beside)
