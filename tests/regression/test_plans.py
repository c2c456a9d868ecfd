"""Plans hold what they promise: their answers beside those of a grid at least twice as fine, and
their time beside the clock.

Stones here are few and large, with gaps that coarse grids tell apart: of the study's own stones, no
two grids that fit into minutes do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gimpslope as gs
from gimpslope.planning import search
from gimpslope.planning.pilot import fly
from gimpslope.planning.problem import pose
from gimpslope.studies import reference

pytestmark = pytest.mark.study

PEAK = ("peak_kinetic_energy", "time_of_peak", "speed_at_peak")
METHOD = reference.method(ledger=False, volumetric_strain=None)
SLOPE = gs.Outline.slope()
STONES = {
    "soil": (),
    "round": gs.stones.rounds(SLOPE, 1.6, count=5, gap=0.8, seed=1),
    "oval": gs.stones.ellipses(SLOPE, axes=(2.2, 1.16), count=5, gap=0.8, seed=1),
}
FINEST = 0.05  # m


def scene(kind: str) -> gs.Scene:
    walls = reference.READINGS["identified"].walls
    stones = STONES[kind]
    rock = reference.rock() if stones else None
    return gs.Scene(SLOPE, reference.soil(), stones=stones, stone=rock, cell=FINEST, walls=walls)


@pytest.fixture(scope="module")
def finest(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, float]]:
    """What a grid of 0.05 m gives, by the steps that a run takes without a plan."""
    path = tmp_path_factory.mktemp("finest") / "run.h5"
    found = {}
    for kind in STONES:
        problem = pose(scene(kind), 0.05, METHOD, gs.Stages(), until_rest=False)
        levels = round(np.log2(problem.setup.scene.cell / FINEST))
        found[kind] = fly(problem.on(levels), path, PEAK).values
    return found


def test_errors_are_below_those_asked_for(
    finest: dict[str, dict[str, float]], tmp_path: Path
) -> None:
    """All of them, beside raw values of a grid at least twice as fine: nothing is extrapolated on
    that side, so that what those are off the limit themselves counts as an error of the plan."""
    errors = {}
    for kind, raw in finest.items():
        for error in (0.25, 0.2, 0.1, 0.05):
            plan = gs.plan(scene(kind), error, PEAK, method=METHOD, budget=1000, progress=False)
            if not plan.holds or plan.setup.scene.cell < 1.9 * FINEST:
                continue
            answer = plan.run(tmp_path / "run.h5", overwrite=True)
            for name, value in raw.items():
                errors[kind, error, name] = abs(answer.estimates[name].value / value - 1)
    assert len(errors) >= 9
    assert not {key: off for key, off in errors.items() if off > key[1]}


def test_time_is_predicted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A run of seconds, after pilots that are cheap; for a quiet machine."""
    monkeypatch.setattr(search, "_PILOT_SHARE", 0.0)
    plan = gs.plan(scene("soil"), 0.03, PEAK[:1], method=METHOD, progress=False)
    assert plan.levels == 1
    answer = plan.run(tmp_path / "run.h5")
    assert plan.seconds == pytest.approx(answer.seconds, rel=0.3)


def test_the_studys_own_stones_are_not_promised() -> None:
    plan = gs.plan(reference.slope("round"), 0.05, PEAK[:1], method=METHOD, budget=20)
    assert not plan.holds
    assert any("closer than two cells" in reason for reason in plan.reasons)
