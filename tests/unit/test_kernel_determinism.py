"""The same scene gives the same bits, however it is stepped."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel_scene import sliding, solver
from numpy.typing import NDArray

from gimpslope import _core

State = dict[str, NDArray[np.float64]]

FIELDS = ("position", "velocity", "stress", "volume", "plastic_strain")
STEPS = 2000
FEW = 300  # for comparisons to rounding, which grows as the block collapses


def state(stepped: _core.Solver) -> State:
    return {name: stepped.get(name) for name in FIELDS} | {"time": np.array(stepped.time)}


def after(steps: int = STEPS, **options: Any) -> State:
    stepped = solver(sliding(), **options)
    stepped.advance(steps)
    return state(stepped)


def assert_identical(a: State, b: State) -> None:
    for name in a:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)


@pytest.fixture(scope="module")
def expected() -> State:
    return after(threads=1)


def test_scene_slides_across_slabs_sorts_and_windows(expected: State) -> None:
    start, cell = sliding()["position"], sliding()["cell"]
    assert np.ptp(start[:, 1]) > 12 * cell
    moved = np.abs(expected["position"] - start).max(axis=0)
    assert moved[0] > 50 * cell  # farther than any window of the start reaches
    assert moved[1] > 12 * cell
    assert (expected["plastic_strain"] > 0).mean() > 0.3


def test_run_to_run(expected: State) -> None:
    assert_identical(after(threads=1), expected)


@pytest.mark.parametrize("threads", [2, 3, 4])
def test_any_number_of_threads(expected: State, threads: int) -> None:
    assert_identical(after(threads=threads), expected)


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_any_number_of_threads_in_single_precision(threads: int) -> None:
    assert_identical(
        after(threads=threads, precision="single"), after(threads=1, precision="single")
    )


def test_looking_on_changes_nothing_in_single_precision() -> None:
    """The state is given out in double and stays in single."""
    stepped = solver(sliding(), precision="single")
    for _ in range(STEPS // 10):
        stepped.advance(10)
        stepped.energies()
        stepped.get("position")
    assert_identical(state(stepped), after(precision="single"))


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize(
    "member",
    [
        {"scheme": "usl", "transfer": "xpic", "order": 3},
        {"scheme": "musl", "transfer": "apic", "shape": "quadratic_bspline"},
    ],
    ids=["usl-xpic", "musl-apic"],
)
def test_any_number_of_threads_with_other_members(member: dict[str, Any], precision: str) -> None:
    options = member | {"precision": precision, "blend": ("alpha", 1.0)}
    scene = sliding(30, 60) | {"time_step": ("courant", 0.1), "volumetric_strain": "cell_average"}
    states = []
    for threads in (1, 3):
        stepped = solver(scene, threads=threads, **options)
        stepped.advance(FEW)
        states.append(state(stepped))
    assert_identical(*states)


@pytest.mark.parametrize("threads", [2, 3])
def test_any_number_of_threads_with_cells_and_body_forces(threads: int) -> None:
    """Averages over cells and forces at nodes are sums that slabs share at their borders."""
    scene = sliding() | {"volumetric_strain": "cell_average"}
    scene["body_force"] = np.random.default_rng(3).normal(size=(len(scene["mass"]), 2))
    states = []
    for count in (1, threads):
        stepped = solver(scene, threads=count)
        stepped.advance(STEPS // 2)
        states.append(state(stepped))
    assert_identical(*states)


@pytest.mark.parametrize("rows", [2, 6, 20])
def test_more_threads_than_slabs(rows: int) -> None:
    """One slab of four rows of cells, two, and a few."""
    states = []
    for threads in (1, 2, 3, 8):
        stepped = solver(sliding(30, rows), threads=threads)
        stepped.advance(FEW)
        states.append(state(stepped))
    for other in states[1:]:
        assert_identical(other, states[0])


def test_steps_taken_one_by_one(expected: State) -> None:
    stepped = solver(sliding())
    for _ in range(STEPS):
        stepped.advance(1)
    assert_identical(state(stepped), expected)


def test_setting_what_is_there_changes_rounding_alone() -> None:
    stepped = solver(sliding())
    for _ in range(FEW // 10):
        stepped.advance(10)
        stepped.energies()
        stepped.set("velocity", stepped.get("velocity"))
    found, expected = state(stepped), after(FEW)
    for name in found:
        np.testing.assert_allclose(
            found[name], expected[name], rtol=0, atol=1e-9 * np.abs(expected[name]).max()
        )


def test_solvers_do_not_touch_each_other(expected: State) -> None:
    other = sliding() | {"gravity": (-1.0, -5.0, 0.0), "shape": "linear"}
    alone = solver(other)
    alone.advance(STEPS)
    first, second = solver(sliding()), solver(other)
    for _ in range(STEPS // 5):
        first.advance(5)
        second.advance(5)
    assert_identical(state(first), expected)
    assert_identical(state(second), state(alone))


@pytest.mark.parametrize("instruction_set", _core.instruction_sets())
@pytest.mark.parametrize("shape", ["linear", "ugimp"])
def test_instruction_sets_agree(shape: str, instruction_set: str) -> None:
    reference = after(FEW, shape=shape, instruction_set=_core.instruction_sets()[0])
    found = after(FEW, shape=shape, instruction_set=instruction_set)
    for name in found:
        scale = np.abs(reference[name]).max()
        assert np.abs(found[name] - reference[name]).max() <= 1e-9 * scale, name


def test_default_instruction_set_is_the_fastest() -> None:
    assert solver(sliding(8, 8)).instruction_set == _core.instruction_sets()[-1]
