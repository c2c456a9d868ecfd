"""What several models of stones have in common as the cell shrinks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from ..richardson import Extrapolation


class Reference(NamedTuple):
    """A limit that errors are told against.

    Attributes
    ----------
    model : whose limit it is
    limit, uncertainty : in the unit of the quantity
    """

    model: str
    limit: float
    uncertainty: float


def meet(first: Extrapolation, second: Extrapolation) -> bool:
    """Whether two limits agree within their uncertainties."""
    return abs(first.limit - second.limit) <= allowed(first, second)


def allowed(first: Extrapolation, second: Extrapolation) -> float:
    """How far two limits that meet may lie apart: the root of the sum of the squares of their
    uncertainties, as of independent ones (ASME V&V 20-2009, section 1)."""
    return math.hypot(first.uncertainty, second.uncertainty)


def reference(model: str, limits: Mapping[str, Extrapolation]) -> Reference | None:
    """What errors of a model are told against: of its own limit and those that meet it the surest;
    where it has none, the surest of the other models; None without any.

    Parameters
    ----------
    model : of the stones
    limits : by model, of those that have one
    """
    own = limits.get(model)
    candidates = [
        Reference(name, found.limit, found.uncertainty)
        for name, found in limits.items()
        if own is None or meet(own, found)
    ]
    return min(candidates, key=lambda one: one.uncertainty, default=None)
