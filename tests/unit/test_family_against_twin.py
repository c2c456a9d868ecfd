"""Every combination of shape function and scheme takes the steps of the NumPy twin."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest
from test_kernel_against_twin import (
    BASE,
    OPTIONS,
    assert_same,
    kernel,
    relative_difference,
    twin,
)

from gimpslope import _core

SHAPES: dict[str, dict[str, Any]] = {
    name: OPTIONS[name][0]
    for name in (
        "base",
        "linear",
        "own_half_lengths",
        "wide_half_lengths",
        "cpgimp_jacobian",
        "cpgimp_stretch",
        "cpgimp_deformation_diagonal",
        "quadratic_bspline",
    )
}
SCHEMES = ("usf", "usl", "musl")
# USL needs a shorter step than the base scene has.
SCENE = BASE | {"time_step": ("fixed", 1e-3), "steps": 30}
SETTINGS: dict[str, dict[str, Any]] = {
    name: OPTIONS[name][0]
    for name in (
        "cell_average_exponential_volume",
        "two_materials",
        "body_force",
        "both_dampings",
        "horizontal_gravity_ramp",
        "mixed_box",
        "walls_inside_the_block",
    )
} | {"courant": {"time_step": ("courant", 0.1)}}


@pytest.mark.parametrize("strain", ["point", "cell_average"])
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("shape", SHAPES)
def test_member(shape: str, scheme: str, strain: str) -> None:
    scene = SCENE | SHAPES[shape] | {"scheme": scheme, "volumetric_strain": strain}
    assert_same(kernel(scene), twin(scene), BASE["position"])


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize("scheme", SCHEMES[1:])
@pytest.mark.parametrize("setting", SETTINGS)
def test_setting(setting: str, scheme: str, instruction_set: str) -> None:
    """What a scene may set besides, with the schemes that `test_kernel_against_twin` leaves out."""
    scene = SCENE | SETTINGS[setting] | {"scheme": scheme}
    assert_same(kernel(scene, instruction_set), twin(scene), BASE["position"])


def test_members_differ() -> None:
    found = [kernel(SCENE | {"scheme": scheme})["velocity"] for scheme in SCHEMES]
    for one, other in combinations(found, 2):
        assert relative_difference(one, other) > 1e-4
