"""Stones in a notebook: a small picture beside a table of facts, or drawn into axes."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._check import FloatArray
from .ellipse import Ellipse
from .stone import Shape

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..outline import Outline
    from .collection import Stones

_WIDTH, _HEIGHT = 320, 240
_FILL, _EDGE, _FRAME = "#b9b1a4", "#5c554b", "#c8c8c8"


def in_words(stones: Stones) -> str:
    """Number, area and mean size, in a line."""
    if not len(stones):
        return "none"
    return f"{len(stones)} of {stones.area:.4g} m2, mean size {stones.mean_size:.3g} m"


def html(stones: Stones) -> str:
    """The picture and the table."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{name}</th><td style='text-align:left'>{escape(value)}"
        "</td></tr>"
        for name, value in _facts(stones).items()
    )
    table = f"<table style='margin:0'>{rows}</table>"
    if not len(stones):
        return table
    return (
        "<div style='display:flex;flex-wrap:wrap;align-items:center;gap:1.5em'>"
        f"{svg(stones)}{table}</div>"
    )


def plot(stones: Stones, ax: Axes | None, outline: Outline | None) -> Axes:
    """The stones to scale in axes, or in new ones, and an outline around them."""
    from ..figures import canvas

    ax = canvas.new_axes() if ax is None else ax
    edges = [np.array(shape.polygon.exterior.coords) for shape in stones.shapes]
    canvas.draw_stones(ax, edges, _EDGE, halo=False, faces=_FILL)
    for edge in edges:
        ax.update_datalim(edge)
    canvas.draw_outline(ax, None if outline is None else outline.vertices)
    return ax


def svg(stones: Stones) -> str:
    """The stones, y upwards, in a frame around them of at most 320 by 240 pixels."""
    bounds = np.array([shape.bounds for shape in stones.shapes])
    low, high = bounds[:, :2].min(axis=0), bounds[:, 2:].max(axis=0)
    scale = float(np.min(np.divide((_WIDTH, _HEIGHT), high - low)))
    width, height = scale * (high - low)
    corner = np.array([low[0], high[1]])
    shapes = "".join(_element(stone.shape, corner, scale) for stone in stones)
    return (
        f"<svg width='{width + 2:.0f}' height='{height + 2:.0f}' "
        f"viewBox='-1 -1 {width + 2:.2f} {height + 2:.2f}'>"
        f"<rect width='{width:.2f}' height='{height:.2f}' fill='none' stroke='{_FRAME}'/>"
        f"<g fill='{_FILL}' stroke='{_EDGE}' stroke-width='0.75'>{shapes}</g></svg>"
    )


def _element(shape: Shape, corner: FloatArray, scale: float) -> str:
    """A shape in pixels from the upper left corner of the frame."""
    if isinstance(shape, Ellipse):
        (x, y), (a, b) = _pixels(shape.centre, corner, scale), np.multiply(shape.axes, scale / 2)
        turn = f" transform='rotate({-shape.angle:.2f} {x:.2f} {y:.2f})'" if a != b else ""
        return f"<ellipse cx='{x:.2f}' cy='{y:.2f}' rx='{a:.2f}' ry='{b:.2f}'{turn}/>"
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in _pixels(shape.vertices, corner, scale))
    return f"<polygon points='{points}'/>"


def _pixels(points: npt.ArrayLike, corner: FloatArray, scale: float) -> FloatArray:
    pixels: FloatArray = scale * np.multiply(np.subtract(points, corner), (1, -1))
    return pixels


def _facts(stones: Stones) -> dict[str, str]:
    facts = {"stones": str(len(stones)), "area": f"{stones.area:.4g} m2"}
    if len(stones):
        sizes = stones.sizes
        facts["size"] = f"{sizes.min():.3g} to {sizes.max():.3g} m, mean {sizes.mean():.3g} m"
    unnamed = sum(stone.material is None for stone in stones)
    if unnamed == 0 and len(stones):
        facts["mass"] = f"{stones.mass():,.0f} kg/m"
    elif 0 < unnamed < len(stones):
        facts["mass"] = f"unknown, {unnamed} without a material"
    return facts
