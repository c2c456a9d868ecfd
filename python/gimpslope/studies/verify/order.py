"""The observed order of convergence."""

from __future__ import annotations

import math


def observed_order(before: float, error: float) -> float | None:
    """Order by the signed errors on a grid and on one of half its cell; None where one of them is
    zero or the second has the other sign, as where the exact value is met or crossed."""
    return math.log2(before / error) if before * error > 0 else None
