"""Methods and cases in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...method import Method
from .plan import Case

_SHAPES = {"linear": "linear MPM", "ugimp": "uGIMP", "cpgimp": "cpGIMP"}
_CHOICES = {
    "single": "single precision",
    "exponential": "exponential volumes",
    "cell_average": "cell average",
    "point": "strains of points",
}
_CAPITALS = ("scheme", "transfer")


def shape(name: str) -> str:
    """A shape function as it is usually called."""
    return _SHAPES.get(name, name.replace("_", " ").replace("bspline", "B-spline"))


def changes(changed: Mapping[str, Any]) -> str:
    """A method, by what it has in place of the default's."""
    found = shape(changed.get("shape", Method.shape))
    if "domain_update" in changed:
        found += f" ({changed['domain_update'].replace('_', ' ')})"
    parts = [found]
    for name, value in changed.items():
        if name in _CAPITALS:
            parts.append(value.upper())
        elif name == "alpha":
            parts.append(f"alpha = {value:g}")
        elif name == "courant":
            parts.append(f"C = {value:g}")
        elif value is not None and name not in ("shape", "domain_update"):
            parts.append(_CHOICES.get(value, str(value).replace("_", " ")))
    return ", ".join(parts) if changed else f"{found} (default)"


def case(one: Case) -> str:
    """A case, with its grid."""
    stones = "" if one.model is None else f", {one.model} stone"
    return f"{changes(dict(one.changes))}{stones}, h = {one.cell:.3g} m"


def percent(error: float, digits: int = 2) -> str:
    """An error to so many digits."""
    return f"{float(f'{100 * error:.{digits}g}'):g} %"


def seconds(value: float) -> str:
    """A time to two digits."""
    return f"{float(f'{value:.2g}'):g} s"
