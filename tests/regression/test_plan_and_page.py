"""A plan for slope A does what the page of `gimpslope tradeoff` says is to be chosen."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import pytest

import gimpslope as gs
from gimpslope.studies import reference
from gimpslope.studies.tradeoff import problems, slopes, words

PAGE = Path(__file__).parents[2] / "notebooks" / "tradeoff"
QUANTITIES = ("peak_kinetic_energy", "time_of_peak", "max_displacement_vertical")
"""Those that the page judges slope A by."""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not PAGE.exists(), reason="no source tree"),
]


def recommended(error: float) -> str:
    """The method that the page puts first for an error in all problems."""
    overall = (PAGE / "summary.md").read_text().split("## Overall")[1].split("##")[0]
    found = re.search(rf"\*\*{100 * error:g} %\*\*: (.*?) reaches it", overall)
    assert found is not None
    return found[1]


def error_that_holds(changed: dict[str, Any], cell: float) -> float:
    """Of slope A by a method on a grid, as the page has it."""
    with (PAGE / "slope_a.csv").open() as file:
        (row,) = (
            row
            for row in csv.DictReader(file)
            if json.loads(row["changes"]) == changed and float(row["cell_m"]) == cell
        )
    return float(row["error_that_holds"])


@pytest.mark.parametrize("error", [0.1, 0.02])
def test_a_plan_agrees_with_the_page(error: float, tmp_path: Path) -> None:
    """The method that the page puts first, on a grid on which that has no more than the error by
    itself too; the answer, without grid, has no more beside the limits that the page is held to."""
    scene = reference.slope("soil")
    method = reference.method(ledger=False, volumetric_strain=None)
    answer = gs.plan(scene, error, QUANTITIES, method=method, progress=False).run(
        tmp_path / "run.h5"
    )
    assert answer.reached
    chosen, default = answer.run.setup.method.to_dict(), method.of(scene.materials).to_dict()
    changed = {name: value for name, value in chosen.items() if value != default[name]}
    assert words.changes(changed) == recommended(error)
    assert error_that_holds(changed, answer.run.setup.scene.cell) <= error
    found = slopes.Figures(*(answer.estimates[name].value for name in QUANTITIES))
    assert slopes.off(found, problems.SLOPE_A) <= error
