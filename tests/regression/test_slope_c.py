"""Round stones against one draw of an independent plain code: 48 of 0.54 m, gaps of 0.1 m, 0.5 GPa,
cells of 0.1 m, reading `identified`. Its slope peaks at 1.50 s with 44.6 kJ/m and 2.19 m/s.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import gimpslope as gs
from gimpslope.studies import reference


@pytest.mark.slow
def test_draws_bracket_one_of_an_independent_code(tmp_path: Path) -> None:
    """Draws differ by chance: here 54.2, 55.7, 73.9 and 39.2 kJ/m at 1.50 to 1.70 s, 2.04 to
    2.45 m/s. Its draw lies among them in energy and speed, and at the end of them in time."""
    setup = reference.setup("round", stone_model="softened", duration=2.0)
    energies = []
    for seed in (1, 2, 3, 4):
        stones = gs.stones.rounds(gs.Outline.slope(), 0.54, count=48, gap=0.1, seed=seed)
        drawn = replace(setup, scene=replace(setup.scene, stones=stones))
        run = drawn.simulate(tmp_path / f"{seed}.h5", progress=False)
        energies.append(run.energy)
    for found, there in (
        ([energy.peak.value for energy in energies], 44.6e3),
        ([energy.speed_at_peak for energy in energies], 2.19),
    ):
        assert min(found) < there < max(found)
    times = [energy.peak.time for energy in energies]
    assert min(times) - 0.05 < 1.5 < max(times)
