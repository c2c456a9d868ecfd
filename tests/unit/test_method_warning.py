"""Runs that enter a region where a method is known to fail say so, and others do not."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gimpslope as gs
from gimpslope.method_warning import warn_at_end, warn_at_start
from gimpslope.studies import reference, stability

SOIL = gs.DruckerPrager(1800, 30e6, 0.33, friction=22, cohesion=1e3)
SLOPE = gs.Outline.slope(2, 1)
GRANITE = gs.Elastic(2400, 0.5e9, 0.2)
QUIET = gs.Method(viscosity=0.01)


def scene(soil: gs.DruckerPrager = SOIL, **options: Any) -> gs.Scene:
    return gs.Scene(SLOPE, soil, **{"cell": 0.2, **options})


def two_stones(gap: float, material: gs.Material) -> gs.Scene:
    """Squares of 0.4 m a gap (cells) apart."""
    left, right = 0.2, 0.6 + gap * 0.2
    squares = [
        gs.Outline(np.array([(x, 0.2), (x + 0.4, 0.2), (x + 0.4, 0.6), (x, 0.6)]))
        for x in (left, right)
    ]
    return scene(stones=squares, stone=material)


def told(at: Any, setup: gs.Setup, solver: gs.Solver | None = None) -> list[str]:
    """Names of the modes that are warned of."""
    solver = gs.Solver.of(setup.scene, setup.method, elastic=True) if solver is None else solver
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        at(setup, solver)
    assert all(warning.category is gs.MethodWarning for warning in caught)
    assert all(warning.filename == __file__ for warning in caught)
    names = [str(warning.message).split(":")[0] for warning in caught]
    assert all(f"stability {n}" in str(w.message) for n, w in zip(names, caught, strict=True))
    assert set(names) <= set(stability.NAMES)
    return names


@pytest.mark.parametrize(
    ("given", "method", "expected"),
    [
        (scene(), QUIET, []),
        (scene(), gs.Method(alpha=0.5), ["blend"]),
        (scene(), gs.Method(viscosity=10.0), []),
        (scene(), gs.Method(transfer="apic"), []),
        (scene(), gs.Method(transfer="xpic"), []),
        (scene(replace(SOIL, cone="outer")), QUIET, ["cones"]),
        (scene(replace(SOIL, cone="outer", friction=45)), QUIET, ["cones"]),
        (scene(replace(SOIL, cone="inner")), QUIET, []),
        (scene(replace(SOIL, cone="plane_strain", friction=45)), QUIET, []),
        (two_stones(1.0, GRANITE), QUIET, ["near_stones"]),
        (two_stones(2.5, GRANITE), QUIET, []),
        (two_stones(1.0, gs.Rigid(2400)), QUIET, []),
        (scene(), replace(QUIET, courant=0.95), ["step_limit"]),
        (scene(), replace(QUIET, scheme="usl"), []),
        (scene(), replace(QUIET, scheme="usl", shape="linear"), ["small_masses"]),
        (scene(), replace(QUIET, scheme="usl", courant=0.6), ["small_masses"]),
        (scene(), replace(QUIET, scheme="musl"), []),
    ],
)
def test_settings(given: gs.Scene, method: gs.Method, expected: list[str]) -> None:
    assert told(warn_at_start, gs.Setup(given, method)) == expected


def test_alpha_is_judged_at_the_step_that_is_taken() -> None:
    """On soft soil the default blend is fine at the default step, too much at a fortieth of it."""
    soft = scene(replace(SOIL, young=3e5), cell=0.05)
    assert told(warn_at_start, gs.Setup(soft)) == []
    assert told(warn_at_start, gs.Setup(soft, gs.Method(courant=0.01))) == ["blend"]


def test_study_is_told_only_what_is_true_of_it() -> None:
    """The literal reading has the outer cone; stones are drawn closer than two cells of 0.1 m."""
    assert told(warn_at_start, reference.setup("soil")) == []
    assert told(warn_at_start, reference.setup("soil", reading="literal")) == ["cones"]
    assert told(warn_at_start, reference.setup("round")) == ["near_stones"]
    assert told(warn_at_start, reference.setup("round", stone_model="rigid")) == []


@pytest.mark.parametrize(("half_width", "expected"), [(0.3, []), (0.7, ["fracture"])])
def test_points_drawn_apart(half_width: float, expected: list[str]) -> None:
    """A hole of one and a half cells, and one of three and a half."""
    given = gs.Scene(gs.Outline(np.array([(0, 0), (6, 0), (6, 6), (0, 6)])), SOIL, cell=0.5)
    setup = gs.Setup(given, QUIET)
    solver = gs.Solver.of(given, QUIET)
    place = solver.position
    in_hole = (np.abs(place - 3.0) < half_width).all(axis=1)
    place[in_hole] = place[0]
    solver.position = place
    assert told(warn_at_end, setup, solver) == expected


def test_simulate_warns_where_it_is_called(tmp_path: Path) -> None:
    with pytest.warns(gs.MethodWarning, match="stability cones") as caught:
        gs.simulate(
            scene(replace(SOIL, cone="outer")),
            0.01,
            method=QUIET,
            output=tmp_path / "a.h5",
            progress=False,
        )
    assert [warning.filename for warning in caught] == [__file__]
