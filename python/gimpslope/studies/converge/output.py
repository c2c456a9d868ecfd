"""A study of convergence, written down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from itertools import combinations
from os import PathLike
from pathlib import Path
from typing import Any

from .. import plain_data
from . import figures
from .limits import meet
from .quantities import QUANTITIES
from .study import Convergence
from .tables import EXPLANATION, markdown

_DPI = 90
_PICTURES = {"values": figures.values, "costs": figures.costs}


def write(studies: Sequence[Convergence], directory: str | PathLike[str]) -> None:
    """Write convergence.md, which refers to the pictures of `draw`, and convergence.json."""
    folder = Path(directory)
    head = f"# Convergence\n\ngimpslope {version('gimpslope')}, `gimpslope converge`.\n"
    parts = [head, EXPLANATION]
    for study in studies:
        parts.append(markdown(study))
        parts += [f"![{kind}]({_picture(study, kind)})\n" for kind in _PICTURES]
    (folder / "convergence.md").write_text("\n".join(parts))
    (folder / "convergence.json").write_text(plain_data.dumps(list(map(_plain, studies))))


def draw(studies: Sequence[Convergence], directory: str | PathLike[str]) -> None:
    """Write two pictures a study: figures against the cell, errors against core-seconds."""
    for study in studies:
        for kind, figure in _PICTURES.items():
            figure(study).savefig(Path(directory) / _picture(study, kind), dpi=_DPI)


def _picture(study: Convergence, kind: str) -> str:
    return f"{study.slope}_{study.reading}_{kind}.png"


def _plain(study: Convergence) -> dict[str, Any]:
    """As numbers: by model and figure each draw on each grid, the limit of the means, errors as
    parts of it; distances of surfaces; costs."""
    return {
        "slope": study.slope,
        "reading": study.reading,
        "cells": study.cells,
        "seeds": study.seeds,
        "missing": study.missing,
        "models": {model: _plain_series(study, model) for model in study.series},
        "limits_agree": {
            quantity.figure: {
                f"{one}, {other}": meet(found[one], found[other])
                for one, other in combinations(found, 2)
            }
            for quantity in QUANTITIES
            for found in [study.limits(quantity.figure)]
        },
        "surfaces_apart": {
            f"{one}, {other}": study.series[one].apart(study.series[other]).tolist()
            for one, other in combinations(study.series, 2)
        },
    }


def _plain_series(study: Convergence, model: str) -> dict[str, Any]:
    series, quantities = study.series[model], {}
    for quantity in QUANTITIES:
        limit, errors = series.limit(quantity.figure), study.errors(quantity.figure, model)
        quantities[quantity.figure] = {
            "title": quantity.title,
            "unit": quantity.unit,
            "values": series.values(quantity.figure).tolist(),
            "limit": None if limit is None else asdict(limit),
            "errors": None if errors is None else errors.values.tolist(),
            "errors_against": None if errors is None else errors.against._asdict(),
        }
    return {
        "quantities": quantities,
        "surface_off_finest": series.off_finest().tolist(),
        "core_seconds": series.core_seconds.tolist(),
        "points": [[one and one.points for one in draws] for draws in series.grids],
        "point_steps": [[one and one.point_steps for one in draws] for draws in series.grids],
        "smallest_gap_in_cells": [[one and one.gap for one in draws] for draws in series.grids],
    }
