"""Slope A of the reference study against figures that come from elsewhere than from this code.

The bounds are those found by an independent plain code; each test says which. `slow` marks the runs
at the study's resolution, about a minute each.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import gimpslope as gs
from gimpslope.studies import reference

PEAKS = {0.2: 150.9e3, 0.1: 159.3e3, 0.05: 162.5e3}
"""Peak kinetic energy by cell, J/m, identified reading; the independent code's cell study."""


def slide(path: Path, reading: str, cell: float, duration: float) -> gs.Run:
    return gs.simulate(
        reference.slope("soil", reading, cell),
        duration,
        method=reference.method(reading),
        output=path / "run.h5",
        snapshot_times=reference.RECORDING.snapshot_times,
        progress=False,
    )


@pytest.fixture(scope="module")
def coarse(tmp_path_factory: pytest.TempPathFactory) -> dict[float, gs.Run]:
    return {
        cell: slide(tmp_path_factory.mktemp("coarse"), "identified", cell, 2.5)
        for cell in (0.4, 0.2)
    }


def test_peak_at_two_tenths(coarse: dict[float, gs.Run]) -> None:
    assert coarse[0.2].energy.peak.value == pytest.approx(PEAKS[0.2], rel=0.03)


def test_peak_at_four_tenths(coarse: dict[float, gs.Run]) -> None:
    """The study's differences shrink by a constant factor; one step back gives 128.9 kJ/m. So
    coarse a grid need not follow the rule to better than 5 %."""
    last, before = PEAKS[0.05] - PEAKS[0.1], PEAKS[0.1] - PEAKS[0.2]
    expected = PEAKS[0.2] - before**2 / last
    assert coarse[0.4].energy.peak.value == pytest.approx(expected, rel=0.05)


def test_peak_comes_early_and_rises_with_resolution(coarse: dict[float, gs.Run]) -> None:
    """The independent code has 1.60 s at 0.1 m and 1.57 s at 0.05 m, and no times for larger cells;
    those are held to the 0.1 s to which the paper gives its 1.6 s."""
    assert coarse[0.4].energy.peak.value < coarse[0.2].energy.peak.value < PEAKS[0.05]
    for run in coarse.values():
        assert run.energy.peak.time == pytest.approx(1.60, abs=0.1)


def test_literal_reading_is_slower_and_weaker(coarse: dict[float, gs.Run], tmp_path: Path) -> None:
    """132 against 159 kJ/m and 1.97 against 1.60 s at 0.1 m."""
    literal = slide(tmp_path, "literal", 0.2, 2.5).energy.peak
    identified = coarse[0.2].energy.peak
    assert 0.7 < literal.value / identified.value < 0.95
    assert 0.2 < literal.time - identified.time < 0.5


def test_energy_only_becomes_less(coarse: dict[float, gs.Run]) -> None:
    """Soil can lose energy to friction and blend but has no source of it."""
    for run in coarse.values():
        total = run.energy.kinetic + run.energy.potential + run.energy.elastic
        assert total.max() <= total[0] * (1 + 1e-6)
        assert total[-1] < total[0] - run.energy.kinetic[-1]


def assert_closed(run: gs.Run) -> None:
    """No joule is lost but to rounding, and the time step's residue is below 0.5 % of the energy
    turned over."""
    rows = run.ledger
    assert abs(rows.balance - rows.balance[0]).max() < 1e-10 * rows.turned_over
    assert abs(rows.integration).max() < 0.005 * rows.turned_over


def test_every_joule_is_somewhere(coarse: dict[float, gs.Run]) -> None:
    for run in coarse.values():
        assert_closed(run)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("reading", "expected"),
    [
        (
            "identified",
            {
                "time_of_peak": (1.60, 0.05),
                "peak_kinetic_energy": (159e3, 0.03 * 159e3),
                "speed_at_peak": (3.36, 0.03 * 3.36),
                "max_displacement_total": (9.28, 0.1),
                "max_displacement_horizontal": (8.95, 0.1),
                "max_displacement_vertical": (5.28, 0.1),
            },
        ),
        (
            "literal",
            {
                "time_of_peak": (1.97, 0.05),
                "peak_kinetic_energy": (132e3, 0.03 * 132e3),
                "max_displacement_total": (8.90, 0.1),
                "max_displacement_horizontal": (8.90, 0.1),
                "max_displacement_vertical": (5.23, 0.1),
            },
        ),
    ],
)
def test_figures_at_one_tenth(reading: str, expected: dict[str, Any], tmp_path: Path) -> None:
    run = slide(tmp_path, reading, 0.1, 10.0)
    assert_closed(run)
    summary: dict[str, Any] = run.summary
    assert summary["points"] == 23_490
    off = {
        name: (summary[name], value)
        for name, (value, band) in expected.items()
        if abs(summary[name] - value) > band
    }
    assert not off, f"(here, expected): {off}; all: {summary}"
    if reading == "identified":
        assert summary["final_kinetic_energy"] < 0.006 * summary["peak_kinetic_energy"]
