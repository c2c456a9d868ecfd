"""How far a slope runs out."""

from __future__ import annotations

from ..snapshot import Snapshot
from .percentile import mass_percentile


def run_out(state: Snapshot, percentile: float = 100.0) -> float:
    """How far the front of the slope has moved to the right since the trigger, m.

    Parameters
    ----------
    state : at the time in question
    percentile : % of the mass, in (0, 100]: the front is where the mass to its left is that much;
        100 gives the point farthest to the right, the toe

    Raises
    ------
    TypeError, ValueError
        If the percentile is not a number in its range.
    """
    mass = state.points.mass
    now, start = (
        mass_percentile(position[:, 0], mass, percentile)
        for position in (state.position, state.points.position)
    )
    return now - start
