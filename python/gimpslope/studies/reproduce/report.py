"""The study on one page, in Markdown and HTML."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING

import markdown as to_html
import numpy as np

from ...materials import Deformable
from ...run import Run
from .. import reference
from .judging import SOIL, STONES
from .sample import KNOWN, has_own_spread
from .tables import claims, comparison, grids, table

if TYPE_CHECKING:
    from .study import Study

_FIGURES = {
    3: "the slopes at the start",
    4: "kinetic energy",
    5: "speed",
    6: "plastic zone",
    7: "displacement and shape in the end",
    8: "largest displacements",
}
_LIBRARIES = {"NumPy": "numpy", "shapely": "shapely", "h5py": "h5py"}
_STYLE = (
    "body{font-family:sans-serif;max-width:70em;margin:2em auto;padding:0 1em;line-height:1.4}"
    "table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .6em;"
    "text-align:left;vertical-align:top}img{max-width:100%}"
)


def markdown(studies: Sequence[Study]) -> str:
    """The page."""
    parts = [
        "# The reference study, reproduced\n",
        "Front. Earth Sci. 2022, 10:968250: soil (A) and soil with arbitrary (B), round (C) and "
        "oval (D) stones. The paper's labels of horizontal and vertical displacement, which are "
        "swapped, are put right.\n",
        "## Settings\n",
        _settings(studies),
        "## Figures of the paper and of these runs\n",
        comparison(studies),
        "## Claims of the paper\n",
        _verdicts(studies),
        "What decides must be larger than three times what chance brings about from draw to draw "
        "of the stones (±: one standard deviation of the mean, left out where it is below the last "
        "digit).\n",
        *(_chance(one) for one in studies),
        claims(studies),
    ]
    for one in studies:
        if one.refinement:
            parts += [
                f"## How the answer depends on the cell, reading `{one.reading}`\n",
                "In one velocity field stones closer than two cells share nodes, and each acts "
                "about a cell larger than it is. *Limit*: by Richardson's extrapolation of the "
                "three finest grids, where they converge; ±: between draws.\n",
                grids(one.refinement),
                f"![against the cell]({picture(one.reading, 'grids')})\n",
            ]
    for one in studies:
        parts.append(f"## Figures, reading `{one.reading}`\n")
        for number, title in _FIGURES.items():
            parts.append(f"Figure {number}: {title}\n")
            parts.append(f"![{title}]({picture(one.reading, number)})\n")
    return "\n".join(parts)


def picture(reading: str, name: int | str) -> str:
    """The file of a figure, by its number in the paper or its name, from the directory of the
    page."""
    return f"{reading}/figure_{name}.png"


def html(text: str) -> str:
    """The page as HTML that refers to the same pictures."""
    body = to_html.markdown(text, extensions=["tables"])
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f"<title>The reference study, reproduced</title><style>{_STYLE}</style></head>\n"
        f"<body>\n{body}\n</body></html>\n"
    )


def _settings(studies: Sequence[Study]) -> str:
    rows = []
    for one in studies:
        reading = reference.READINGS[one.reading]
        sides = ", ".join(
            f"{side} {getattr(reading.walls, side).kind}" for side in ("left", "bottom")
        )
        rows.append(
            (
                f"reading `{one.reading}`",
                f"cone {reading.cone}, viscosity {reading.viscosity:g} m2/s, {sides}",
            )
        )
    first = studies[0].runs[SOIL][0]
    runs = [run for one in studies for draws in one.runs.values() for run in draws]
    versions = sorted(
        {
            f"{run.attributes['gimpslope_version']} on {run.attributes['instruction_set']}"
            for run in runs
        }
    )
    kind, step = first.method.step
    seeds = studies[0].seeds[STONES[0]]
    rows += [
        ("cell", f"{first.scene.cell:g} m, {len(first.points):,} points"),
        ("time step", f"{step:g} of the Courant limit" if kind == "courant" else f"{step:g} s"),
        ("slide", f"{first.stages.slide.duration:g} s"),
        ("Young's modulus of the stones", _model(studies[0])),
        ("seeds of the stones", ", ".join(map(str, seeds))),
        *((f"{name} stones", _stones(studies[0].runs[name])) for name in STONES),
        ("gimpslope", "; ".join(versions)),
        ("libraries, of this page", _libraries()),
    ]
    return table(("setting", "value"), rows)


def _libraries() -> str:
    versions = [f"{name} {version(package)}" for name, package in _LIBRARIES.items()]
    return ", ".join([f"Python {platform.python_version()}", *versions])


def _stones(draws: Sequence[Run]) -> str:
    """Number, points, and the smallest gap of each draw's stones."""
    scenes = [run.scene for run in draws]
    counts = ", ".join(f"{np.count_nonzero(scene.points.stone >= 0):,}" for scene in scenes)
    gaps = ", ".join(f"{run.summary['smallest_gap_in_cells']:.2f}" for run in draws)
    return f"{len(scenes[0].stones)}; {counts} points; smallest gap {gaps} cells"


def settings_of(one: Study) -> str:
    """In words what the spread between draws depends on."""
    cell = one.runs[STONES[0]][0].scene.cell
    return f"reading {one.reading}, cell {cell:g} m, stones of {_model(one)}"


def _model(one: Study) -> str:
    stone = one.runs[STONES[0]][0].scene.stone
    return f"{stone.young:g} Pa" if isinstance(stone, Deformable) else "infinite"


def _chance(one: Study) -> str:
    draws = [one.measures[name] for name in STONES]
    if has_own_spread(draws):
        return f"Chance in `{one.reading}`: as these draws show it.\n"
    here, there = settings_of(one), KNOWN["from"]
    same = "as here" if here == there else f"while this is {here}"
    return f"Chance in `{one.reading}`: as known from five draws of each kind ({there}), {same}.\n"


def _verdicts(studies: Sequence[Study]) -> str:
    by_reading = [
        f"`{reading}`: " + ", ".join(f"{verdict} {count}" for verdict, count in verdicts.items())
        for reading, verdicts in counts(studies).items()
    ]
    return f"Of {len(studies[0].judgements)} claims, by verdict: {'; '.join(by_reading)}.\n"


def counts(studies: Sequence[Study]) -> Mapping[str, Mapping[str, int]]:
    """How many claims have which verdict, by reading."""
    return {
        one.reading: {
            verdict: sum(judgement.verdict == verdict for _, judgement in one.judgements)
            for verdict in dict.fromkeys(judgement.verdict for _, judgement in one.judgements)
        }
        for one in studies
    }
