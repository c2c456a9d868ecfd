"""The study on one page, in Markdown and HTML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import markdown as to_html
import numpy as np

from ...run import Run
from .. import reference
from .judging import STONES
from .measures import Measures
from .sample import KNOWN, has_own_spread

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
_ROWS = (
    ("peak_time", "time_of_peak", "time of peak kinetic energy, s", 2),
    ("peak_energy", None, "peak kinetic energy, kJ/m", 1),
    ("peak_speed", "speed_at_peak", "fastest point at the peak, m/s", 2),
    ("rest_time", None, "at rest after, s", 2),
    ("total", "max_displacement_total", "largest displacement, m", 2),
    ("horizontal", "max_displacement_horizontal", "horizontal, m", 2),
    ("vertical", "max_displacement_vertical", "vertical, m", 2),
    ("run_out", None, "run-out of 99 % of the mass, m", 2),
    ("plastic_soil", None, "share of the soil that is plastic", 3),
    ("peak_bands", None, "plastic bands at the peak", 0),
    ("roughness", None, "roughness of the surface, mm", 0),
)
_LOWER_BOUNDS = {("soil", "speed_at_peak")}  # of this the paper says "exceeding"
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
        _comparison(studies),
        "## Claims of the paper\n",
        "What decides must be larger than three times what chance brings about from draw to draw "
        "of the stones (±: one standard deviation of the mean).\n",
        *(_chance(one) for one in studies),
        _claims(studies),
    ]
    for one in studies:
        parts.append(f"## Figures, reading `{one.reading}`\n")
        for number, title in _FIGURES.items():
            parts.append(f"Figure {number}: {title}\n")
            parts.append(f"![{title}]({picture(one.reading, number)})\n")
    return "\n".join(parts)


def picture(reading: str, number: int) -> str:
    """The file of a figure of the paper, from the directory of the page."""
    return f"{reading}/figure_{number}.png"


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
    first = next(iter(studies[0].runs.values()))[0]
    stones = [run for name, draws in studies[0].runs.items() if name != "soil" for run in draws]
    versions = {
        (run.attributes["gimpslope_version"], run.attributes["instruction_set"])
        for one in studies
        for draws in one.runs.values()
        for run in draws
    }
    kind, step = first.method.step
    rows += [
        ("cell", f"{first.scene.cell:g} m, {len(first.points):,} points"),
        ("time step", f"{step:g} of the Courant limit" if kind == "courant" else f"{step:g} s"),
        ("slide", f"{first.stages.slide.duration:g} s"),
    ]
    if stones:
        content = {f"{_seed(run)}" for run in stones}
        modulus = stones[0].scene.materials[-1].young
        counts = ", ".join(_counted(run) for run in stones)
        rows += [
            ("Young's modulus of the stones", f"{modulus:g} Pa"),
            ("seeds of the stones", ", ".join(sorted(content, key=int))),
            ("stones", counts),
            ("smallest gap between stones", _gaps(stones)),
        ]
    rows.append(
        ("gimpslope", "; ".join(f"{version} on {kind}" for version, kind in sorted(versions)))
    )
    return _table(("setting", "value"), rows)


def _gaps(runs: Sequence[Run]) -> str:
    gaps = [gap for run in runs if (gap := run.summary["smallest_gap_in_cells"]) is not None]
    return f"{min(gaps):.2f} cells; stones closer than two share nodes and act as one"


def settings_of(one: Study) -> str:
    """In words what the spread between draws depends on."""
    run = one.runs[STONES[0]][0]
    modulus = run.scene.materials[-1].young
    return f"reading {one.reading}, cell {run.scene.cell:g} m, stones of {modulus:g} Pa"


def _chance(one: Study) -> str:
    draws = [one.measures[name] for name in STONES]
    if has_own_spread(draws):
        return f"Chance in `{one.reading}`: as these draws show it.\n"
    here, there = settings_of(one), KNOWN["from"]
    same = "as here" if here == there else f"while this is {here}"
    return f"Chance in `{one.reading}`: as known from five draws of each kind ({there}), {same}.\n"


def _seed(run: Run) -> str:
    return run.path.stem.rpartition("_")[2]


def _counted(run: Run) -> str:
    name = run.path.stem.split("_")[1]
    in_stones = int(np.count_nonzero(run.points.stone >= 0))
    return f"{name} ({_seed(run)}) {len(run.scene.stones)} of {in_stones:,} points"


def _comparison(studies: Sequence[Study]) -> str:
    head = ["slope", "figure", "paper"]
    head += [cell for one in studies for cell in (f"`{one.reading}`", "difference")]
    rows = []
    for name, letter in reference.SLOPES.items():
        for figure, key, title, digits in _ROWS:
            paper = reference.PAPER[name].get(key) if key else None
            above = (name, key) in _LOWER_BOUNDS
            shown = "-" if paper is None else f"{'> ' if above else ''}{paper:g}"
            row = [f"{letter} {name}", title, shown]
            for one in studies:
                mean, spread = _mean(one.measures[name], figure)
                here = "not reached" if np.isnan(mean) else f"{mean:.{digits}f}"
                row.append(here if spread is None else f"{here} ± {spread:.{digits}f}")
                row.append(_difference(mean, paper, above, digits))
            rows.append(row)
    return _table(head, rows)


def _mean(draws: Sequence[Measures], figure: str) -> tuple[float, float | None]:
    """Mean over the draws, and their standard deviation where there are several."""
    values = np.array([getattr(one, figure) for one in draws])
    return float(values.mean()), float(values.std(ddof=1)) if len(values) > 1 else None


def _difference(here: float, paper: float | None, above: bool, digits: int) -> str:
    if paper is None or np.isnan(here):
        return "-"
    if above:
        return "above" if here > paper else f"{here - paper:+.{digits}f}"
    return f"{here - paper:+.{digits}f}"


def _claims(studies: Sequence[Study]) -> str:
    head = ["section", "the paper says", *(f"`{one.reading}`" for one in studies)]
    rows = []
    for found in zip(*(one.judgements for one in studies), strict=True):
        claim = found[0][0]
        cells = [f"**{judgement.verdict}**: {judgement.figures}" for _, judgement in found]
        rows.append([claim.section, claim.text, *cells])
    return _table(head, rows)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def counts(studies: Sequence[Study]) -> Mapping[str, Mapping[str, int]]:
    """How many claims have which verdict, by reading."""
    return {
        one.reading: {
            verdict: sum(judgement.verdict == verdict for _, judgement in one.judgements)
            for verdict in dict.fromkeys(judgement.verdict for _, judgement in one.judgements)
        }
        for one in studies
    }
