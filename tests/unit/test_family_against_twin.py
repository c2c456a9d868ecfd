"""Every combination of shape function, scheme and transfer takes the steps of the NumPy twin."""

from __future__ import annotations

from itertools import combinations, product
from typing import Any

import numpy as np
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
PIC = {"blend": ("alpha", 1.0)}
TRANSFERS: dict[str, dict[str, Any]] = {
    "flip": {},
    "apic": {"transfer": "apic"} | PIC,
    "xpic": {"transfer": "xpic", "order": 3} | PIC,
}
MEMBERS = [
    pytest.param(shape, scheme, transfer, id=f"{shape}-{scheme}-{transfer}")
    for shape, scheme, transfer in product(SHAPES, SCHEMES, TRANSFERS)
    if (shape, transfer) != ("linear", "apic")  # refused: see test_kernel_refusals
]
# USL needs a shorter step than the base scene has.
SCENE = BASE | {"time_step": ("fixed", 1e-3), "steps": 15, "margin": 4}
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
@pytest.mark.parametrize(("shape", "scheme", "transfer"), MEMBERS)
def test_member(shape: str, scheme: str, transfer: str, strain: str) -> None:
    scene = SCENE | SHAPES[shape] | TRANSFERS[transfer]
    scene |= {"scheme": scheme, "volumetric_strain": strain}
    assert_same(kernel(scene), twin(scene), BASE["position"])


@pytest.mark.parametrize(("scheme", "transfer"), list(product(SCHEMES, TRANSFERS))[1:])
@pytest.mark.parametrize("setting", SETTINGS)
def test_setting(setting: str, scheme: str, transfer: str) -> None:
    """What a scene may set besides, with the members that `test_kernel_against_twin` leaves out;
    on each instruction set in turn."""
    scene = SCENE | SETTINGS[setting] | TRANSFERS[transfer] | {"scheme": scheme}
    number = list(SETTINGS).index(setting) + SCHEMES.index(scheme)
    sets = _core.instruction_sets()
    found = kernel(scene, sets[number % len(sets)])
    assert_same(found, twin(scene), BASE["position"])


@pytest.mark.parametrize("order", [1, 2, 8])
def test_order(order: int) -> None:
    scene = SCENE | {"transfer": "xpic", "order": order} | PIC
    assert_same(kernel(scene), twin(scene), BASE["position"])


def test_xpic_of_order_one_is_pic() -> None:
    xpic, pic = kernel(SCENE | {"transfer": "xpic"} | PIC), kernel(SCENE | PIC)
    for name, field in xpic.items():
        np.testing.assert_array_equal(field, pic[name], err_msg=name)


def test_members_differ() -> None:
    made = [kernel(SCENE | {"scheme": scheme}) for scheme in SCHEMES]
    made += [kernel(SCENE | given) for given in (PIC, TRANSFERS["apic"], TRANSFERS["xpic"])]
    for one, other in combinations([state["velocity"] for state in made], 2):
        assert relative_difference(one, other) > 1e-4
