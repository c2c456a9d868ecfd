"""What the solver refuses of rigid stones, by parameter, value and what is allowed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rigid_scene import ANGLE_IRON, CELL, ROCK, SOIL, SPACING, G, points, rectangle, thrown

import gimpslope as gs
from gimpslope import _core

PATCH = rectangle(0.4, 0.4, SPACING)


def patch(stone: Any, material: Any, materials: list[gs.Material], **options: Any) -> gs.Solver:
    """A few points of soil, the first eight with those numbers of stone and material."""
    given = points(SPACING, (PATCH, 2000.0, 0, -1))
    numbers, kinds = given.stone.copy(), given.material.copy()
    numbers[:8], kinds[:8] = stone, material
    given = gs.Points(given.position, given.half_length, given.volume, given.mass, kinds, numbers)
    return gs.Solver(given, materials, cell=CELL, method=gs.Method(**options))


def assert_refused(make: Callable[[], object], *parts: str) -> None:
    """The error names the parameter, its value and what is allowed."""
    with pytest.raises((ValueError, TypeError)) as caught:
        make()
    for part in parts:
        assert part in str(caught.value), str(caught.value)


def test_refused_in_single_precision() -> None:
    parts = ("precision", "single", "double with rigid stones")
    assert_refused(lambda: patch(0, 1, [SOIL, ROCK], precision="single"), *parts)


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("scheme", "usl", "usf"),
        ("scheme", "musl", "usf"),
        ("transfer", "apic", "flip"),
        ("transfer", "xpic", "flip"),
    ],
)
def test_members_of_the_family_that_are_refused(name: str, value: str, allowed: str) -> None:
    parts = (name, value, f"{allowed} with rigid stones")
    assert_refused(lambda: patch(0, 1, [SOIL, ROCK], **{name: value}), *parts)


def test_refused_outside_a_stone() -> None:
    parts = ("stone", "-1", "the number of a stone where the material is rigid")
    assert_refused(lambda: patch(-1, 1, [SOIL, ROCK]), *parts)


@pytest.mark.parametrize("other", [0, 2])
def test_refused_in_a_stone_that_is_also_of_another_material(other: int) -> None:
    material = [1, 1, 1, other, 1, 1, 1, 1]
    parts = ("stone", "5", "one material")
    soft = gs.Elastic(2600.0, 1e7, 0.2)
    assert_refused(lambda: patch(5, material, [SOIL, ROCK, soft]), *parts)


def test_no_material_becomes_rigid_or_ceases_to_be() -> None:
    solver = patch(0, 1, [SOIL, ROCK])
    parts = ("materials", "rigid where it was", "only there")
    assert_refused(lambda: solver.set_materials([SOIL, SOIL]), *parts, "number 1")
    assert_refused(lambda: solver.set_materials([ROCK, ROCK]), *parts, "number 0")
    heavier = gs.Rigid(ROCK.density + 1.0)
    assert_refused(lambda: solver.set_materials([SOIL, heavier]), *parts, "number 1", "density")
    rougher = gs.Rigid(ROCK.density, friction=10.0)
    assert_refused(lambda: solver.set_materials([SOIL, rougher]), *parts, "number 1", "friction")
    solver.set_materials([gs.Elastic(2000.0, 2e5, 0.2), ROCK])
    solver.advance(3)


def test_refused_in_the_plain_loop() -> None:
    n = len(PATCH)
    kinds = np.zeros(n, np.int32)
    kinds[:8] = 1
    assert_refused(
        lambda: _core.Plain(
            PATCH,
            0 * PATCH,
            np.full_like(PATCH, SPACING / 2),
            np.full(n, 5.0),
            np.full(n, SPACING**2),
            kinds,
            [SOIL.to_core(), ROCK.to_core()],
            cell=CELL,
            origin=(0.0, 0.0),
            walls=[("free", 0.0, 0.0)] * 4,
            blend=("alpha", 0.0),
            time_step=("fixed", 1e-4),
            gravity=(0.0, -G),
            margin=3,
        ),
        "materials",
        "rigid",
        "deformable in the plain loop",
    )


@pytest.mark.parametrize("density", [0.0, -1.0, float("nan"), float("inf"), "heavy"])
def test_density_is_refused(density: Any) -> None:
    assert_refused(lambda: gs.Rigid(density), "density", str(density).split(".")[0])


@pytest.mark.parametrize("angle", [-1.0, 90.0, float("nan"), "rough"])
@pytest.mark.parametrize("name", ["friction", "mutual_friction"])
def test_friction_is_refused(name: str, angle: Any) -> None:
    with pytest.raises((ValueError, TypeError), match=rf"^{name} must be "):
        gs.Rigid(2600.0, **{name: angle})


def test_refused_to_step_by_a_wave_speed_where_no_wave_runs() -> None:
    """Rigid stones alone have no wave speed for a Courant number: a fixed step is needed."""
    given = points(SPACING, (ANGLE_IRON, ROCK.density, 0, 0))
    method = gs.Method(courant=0.4)
    make = lambda: gs.Solver(given, [ROCK], cell=CELL, method=method)  # noqa: E731
    assert_refused(make, "courant", "0.4", "time_step", "deformable")


def test_stone_that_turns_too_fast_is_stopped() -> None:
    """The ends of a bar may go half a cell a step."""
    bar = rectangle(2.0, 0.1, SPACING)
    thrown(bar, 0.0, 48.0).step()
    with pytest.raises(gs.solver.Diverged, match=r"more than half a cell.*its speed"):
        thrown(bar, 0.0, 55.0).step()
