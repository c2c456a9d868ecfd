"""How far the points have moved: the largest displacement, or a percentile of it."""

from __future__ import annotations

from ..snapshot import MaxDisplacement, Snapshot
from .percentile import mass_percentile


def max_displacement(state: Snapshot, percentile: float = 100.0) -> MaxDisplacement:
    """Displacement since the trigger that `percentile` % of the mass does not exceed, m.

    In all, sideways (|u_x|) and up or down (|u_y|), each for itself; 100 % is the largest of any
    point. Raises `TypeError` or `ValueError` for a percentile that is no number in (0, 100].
    """
    mass = state.points.mass
    return MaxDisplacement(
        *(mass_percentile(sizes, mass, percentile) for sizes in state.displacement_sizes.T)
    )
