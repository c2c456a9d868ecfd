"""The plain loop takes the same steps as the kernel: 2,000 of a slope that yields and slides."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel_scene import arguments, block, sliding, solver

from gimpslope import _core
from gimpslope.studies import reference

FIELDS = ("position", "velocity", "stress", "volume", "plastic_strain")


def plain(scene: dict[str, Any], **options: Any) -> _core.Plain:
    """The plain loop of a scene of `kernel_scene`."""
    given = arguments(scene)
    given.pop("shape", None)
    materials = [_core.Material(**material) for material in scene["materials"]]
    gravity = scene["gravity"][:2]
    return _core.Plain(materials=materials, gravity=gravity, **{"margin": 20} | given | options)


@pytest.mark.parametrize("reading", reference.READINGS)
def test_slope(reading: str) -> None:
    scene = reference.slope("soil", reading, cell=0.2)
    method = reference.method(reading, ledger=False).to_core()
    points = scene.points
    arrays = (points.position, np.zeros_like(points.position), points.half_length)
    arrays += (points.mass, points.volume, points.material)
    materials = [material.to_core() for material in scene.materials]
    given = {
        "cell": scene.cell,
        "origin": scene.origin,
        "walls": scene.walls.to_core(scene.wall_positions),
    }
    fast = _core.Solver(*arrays, materials, **given, **method)
    fast.set_gravity(0.0, -9.81)
    step = {name: method[name] for name in ("blend", "time_step", "volume_update")}
    slow = _core.Plain(*arrays, materials, gravity=(0.0, -9.81), margin=20, **given, **step)
    for stepped in (fast, slow):
        stepped.advance(2000)
    assert slow.time == pytest.approx(fast.time, rel=1e-12)
    assert fast.get("plastic_strain").max() > 0.1
    for name in FIELDS:
        found, expected = slow.get(name), fast.get(name)
        assert np.abs(found - expected).max() <= 1e-10 * np.abs(expected).max(), name


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
def test_two_materials_between_walls_that_rub(instruction_set: str) -> None:
    scene = sliding(30, 30) | {"volume_update": "exponential"}
    fast, slow = solver(scene), plain(scene, instruction_set=instruction_set)
    for stepped in (fast, slow):
        stepped.advance(300)
    for name in FIELDS:
        found, expected = slow.get(name), fast.get(name)
        assert np.abs(found - expected).max() <= 1e-10 * np.abs(expected).max(), name


def test_a_point_that_leaves_the_grid_is_an_error() -> None:
    scene = sliding(8, 8)
    scene["velocity"] = scene["velocity"] + (50.0, 0.0)
    with pytest.raises(RuntimeError, match="left the grid"):
        plain(scene, margin=4).advance(1000)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"half_length": np.random.default_rng(1).uniform(0.1, 0.2, (64, 2))}, "half_length"),
        ({"half_length": np.full((64, 2), 0.3)}, "half_length"),
        ({"margin": 1}, "margin"),
        ({"mass": np.zeros(64)}, "mass"),
        ({"blend": ("alpha", 2.0)}, "alpha"),
    ],
)
def test_refused(changes: dict[str, Any], name: str) -> None:
    scene = sliding(8, 8) | block(8, 8) | {"material": np.zeros(64, np.int32)}
    with pytest.raises(ValueError, match=f"{name} must be"):
        plain(scene | {k: v for k, v in changes.items() if k != "margin"}, **changes)
