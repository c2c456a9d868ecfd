"""How far the final surfaces of two runs lie apart."""

from __future__ import annotations

import numpy as np

from ..._check import FloatArray
from ...run import Run


def heights(run: Run, width: float) -> FloatArray:
    """Height of the final surface over the foot of the slope, m, in columns of a width (m) from the
    left of the grid on; 0 in a column without points.

    To compare grids the width must be the same on all, and two cells of the coarsest or more.
    """
    surface = run.surface(width=width)
    before = round((surface.x[0] - run.scene.origin[0]) / width - 0.5)
    foot = run.scene.outline.vertices[:, 1].min()
    return np.pad(np.nan_to_num(surface.y - foot, nan=0.0), (before, 0))


def distance(first: FloatArray, second: FloatArray) -> float:
    """Root of the mean square of the vertical distance of two surfaces, m, over all columns in
    which one of them has points; each as `heights` gives it."""
    columns = max(len(first), len(second))
    one, other = (np.pad(each, (0, columns - len(each))) for each in (first, second))
    return float(np.sqrt(np.mean(np.square(one - other))))
