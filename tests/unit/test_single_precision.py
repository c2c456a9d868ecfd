"""Points kept in single precision: the same motion but for the digits that are kept."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_scene import block, sliding, solver

from gimpslope import Method

DIGITS = 2.0**-24  # relative error of a number rounded to single precision


@pytest.mark.parametrize(
    ("shape", "steps"),
    [("linear", 20), ("ugimp", 200), ("cpgimp", 200), ("quadratic_bspline", 200)],
)
@pytest.mark.parametrize("volumetric_strain", ["point", "cell_average"])
def test_state_stays_near_that_of_double(shape: str, steps: int, volumetric_strain: str) -> None:
    """Few steps with linear hats: where a point crosses a cell a step later, its force jumps."""
    scene = sliding() | {"shape": shape, "volumetric_strain": volumetric_strain}
    if shape == "cpgimp":
        scene["domain_update"] = "jacobian"
    states = {}
    for precision in ("double", "single"):
        stepped = solver(scene, precision=precision)
        stepped.advance(steps)
        states[precision] = {
            name: stepped.get(name) for name in ("position", "velocity", "stress", "volume")
        }
    for name, double in states["double"].items():
        error = np.abs(states["single"][name] - double).max() / np.abs(double).max()
        assert 0 < error < 1e4 * DIGITS, name


def test_places_keep_their_digits_far_from_the_origin() -> None:
    """A block in free flight, 10 km away: places are good to a ten-thousandth of a cell, where
    numbers in single precision are half a millimetre, a thousandth of a cell, apart."""
    far, cell, speed, dt, steps = 1e4, 0.5, 3.0, 1e-3, 1000
    scene = block(8, 8, cell=cell, corner=(far, -far))
    assert np.spacing(np.float32(far)) > 1e-3 * cell
    stepped = solver(scene, precision="single", time_step=("fixed", dt))
    stepped.set("velocity", np.tile([speed, -speed], (64, 1)))
    start = stepped.get("position")
    stepped.advance(steps)
    moved = stepped.get("position") - start
    np.testing.assert_allclose(
        moved, np.tile([1, -1], (64, 1)) * speed * dt * steps, atol=1e-4 * cell
    )


def test_values_set_are_stepped_on_from() -> None:
    stepped = solver(block(8, 8), precision="single")
    stepped.advance(5)
    stepped.set("velocity", np.tile([0.25, 0.5], (64, 1)))  # exact in single precision
    before = stepped.get("position")
    time = stepped.time
    stepped.advance(1)
    moved = (stepped.get("position") - before) / (stepped.time - time)
    np.testing.assert_allclose(moved, np.tile([0.25, 0.5], (64, 1)), rtol=1e-3)


def test_method_names_what_it_takes() -> None:
    with pytest.raises(ValueError, match="precision must be one of 'double', 'single', got 'half'"):
        Method(precision="half")  # type: ignore[arg-type]


def test_view_shows_the_present_state() -> None:
    stepped = solver(sliding(), precision="single")
    window = stepped.view("position")
    stepped.advance(30)
    shown = window.copy()
    np.testing.assert_array_equal(shown, stepped.get("position")[stepped.numbers()])


def test_what_no_step_changes_keeps_its_digits() -> None:
    scene = block(8, 8, jitter=0.2)
    scene["body_force"] = np.full((64, 2), 0.1)
    scene["mass"] = scene["mass"] / 3
    stepped = solver(scene, precision="single")
    stepped.advance(10)
    for name in ("mass", "body_force", "half_length"):
        np.testing.assert_array_equal(stepped.get(name), scene[name])


def test_what_is_done_between_steps_is_stepped_on_from() -> None:
    """Return of the stresses, kinetic damping, a new clock and the ledger, as in double."""
    ends = {}
    for precision in ("double", "single"):
        stepped = solver(
            sliding(30, 30) | {"damping": (0.0, True)}, precision=precision, ledger=True
        )
        stepped.advance(150)
        stepped.set("stress", 3.0 * stepped.get("stress"))
        released = stepped.release_stress()
        stepped.reset_clock()
        stepped.set_damping(0.0, False)
        stepped.advance(100)
        ledger = stepped.ledger()
        ends[precision] = np.array(
            [
                released,
                *stepped.energies().values(),
                ledger["plastic"],
                ledger["transfer"],
                stepped.get("plastic_strain").mean(),  # since the clock was reset
            ]
        )
    assert ends["double"][0] > 0.0
    np.testing.assert_allclose(ends["single"], ends["double"], rtol=2e-3)
