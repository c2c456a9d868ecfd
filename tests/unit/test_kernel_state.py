"""State in and out of the compiled solver, its clock, energies, memory and interruption."""

from __future__ import annotations

import gc
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kernel_scene import FREE, SOIL, STONE, block, sliding, solver

from gimpslope import _core

STATM = Path("/proc/self/statm")


def sorted_solver(**options: Any) -> _core.Solver:
    """A solver whose points have been sorted away from the order in which they were given."""
    scene = sliding(20, 30)
    shuffled = np.random.default_rng(3).permutation(len(scene["mass"]))
    for name in ("position", "velocity", "stress", "half_length", "mass", "volume", "material"):
        scene[name] = scene[name][shuffled]
    stepped = solver(scene, **options)
    stepped.advance(60)
    assert (stepped.numbers() != np.arange(stepped.size)).any()
    return stepped


@pytest.mark.parametrize("name", ["position", "velocity", "stress", "volume", "plastic_strain"])
def test_values_come_back_in_the_given_order(name: str) -> None:
    stepped = sorted_solver()
    given = stepped.get(name) + np.random.default_rng(0).uniform(0, 1e-3, stepped.get(name).shape)
    stepped.set(name, given)
    np.testing.assert_array_equal(stepped.get(name), given)
    stepped.advance(1)
    assert np.abs(stepped.get(name) - given).max() < 0.5 * np.abs(given).max()


def test_mass_and_material_stay_with_their_points() -> None:
    scene = block(20, 30, jitter=0.2, speed=0.5) | {"materials": [SOIL, STONE]}
    random = np.random.default_rng(1)
    n = len(scene["mass"])
    scene["mass"] = scene["mass"] * random.uniform(0.9, 1.1, n)
    scene["material"] = random.integers(0, 2, n)
    stepped = solver(scene)
    stepped.advance(60)
    np.testing.assert_array_equal(stepped.get("mass"), scene["mass"])
    np.testing.assert_array_equal(stepped.material(), scene["material"])
    np.testing.assert_array_equal(stepped.get("half_length"), scene["half_length"])


@pytest.mark.parametrize(
    "name", ["position", "velocity", "stress", "volume", "mass", "plastic_strain", "half_length"]
)
def test_view_is_a_window_in_storage_order(name: str) -> None:
    stepped = sorted_solver()
    view, numbers = stepped.view(name), stepped.numbers()
    assert np.shares_memory(view, stepped.view(name))
    np.testing.assert_array_equal(view, stepped.get(name)[numbers])
    with pytest.raises(ValueError, match="read-only"):
        view[0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        numbers[0] = 0
    stepped.advance(70)
    np.testing.assert_array_equal(view, stepped.get(name)[numbers])


def test_own_half_lengths_and_deformation_can_be_seen() -> None:
    stepped = sorted_solver(shape="cpgimp", domain_update="stretch")
    for name, columns in (("half_length", 2), ("deformation_gradient", 4)):
        view = stepped.view(name)
        assert view.shape == (stepped.size, columns)
        np.testing.assert_array_equal(view, stepped.get(name)[stepped.numbers()])
    f = stepped.get("deformation_gradient")
    jacobian = f[:, 0] * f[:, 3] - f[:, 1] * f[:, 2]
    volume = stepped.get("volume") / 0.25**2
    np.testing.assert_allclose(jacobian, volume, rtol=0.05)


def test_view_keeps_the_solver_alive() -> None:
    stepped = sorted_solver()
    view, numbers = stepped.view("position"), stepped.numbers()
    expected = stepped.get("position")
    del stepped
    gc.collect()
    np.empty(1_000_000)  # would take the place of memory that had been freed
    np.testing.assert_array_equal(view, expected[numbers])


def test_the_interpreter_runs_while_stepping() -> None:
    stepped = solver(sliding(40, 40))
    ticks, done = [0], threading.Event()

    def tick() -> None:
        while not done.wait(1e-3):
            ticks[0] += 1

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    while time.perf_counter() - start < 0.3:
        stepped.advance(200)
    done.set()
    thread.join()
    assert ticks[0] > 30


@pytest.fixture
def heeds_interrupts() -> Iterator[None]:
    """Ctrl-C is an error here, also where it was ignored, as in the background of a shell."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heeds_interrupts")
def test_interrupt_stops_within_a_second() -> None:
    stepped = solver(sliding(40, 40))
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    start = time.perf_counter()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        stepped.advance(10**9)
    assert time.perf_counter() - start < 1.3
    timer.join()

    steps, at = stepped.steps, stepped.time
    again = solver(sliding(40, 40))
    again.advance(steps)
    assert again.time == at
    np.testing.assert_array_equal(again.get("position"), stepped.get("position"))
    stepped.advance(1)
    assert stepped.steps == steps + 1


def test_energies_are_sums_over_the_points() -> None:
    stepped = sorted_solver()
    found = stepped.energies()
    mass, volume = stepped.get("mass"), stepped.get("volume")
    velocity, position = stepped.get("velocity"), stepped.get("position")
    stress = stepped.get("stress")
    speed = np.linalg.norm(velocity, axis=1)
    assert found["kinetic"] == pytest.approx(np.sum(mass * speed**2) / 2, rel=1e-12)
    assert found["max_speed"] == pytest.approx(speed.max(), rel=1e-12)
    gravity = np.array(sliding()["gravity"][:2])
    assert found["potential"] == pytest.approx(-np.sum(mass * (position @ gravity)), rel=1e-12)

    young = np.array([SOIL["young"], STONE["young"]])[stepped.material()]
    poisson = np.array([SOIL["poisson"], STONE["poisson"]])[stepped.material()]
    trace, square = stress[:, :3].sum(axis=1), (stress[:, :3] ** 2).sum(axis=1)
    double = square + 2 * stress[:, 3] ** 2
    density = ((1 + poisson) * double - poisson * trace**2) / (2 * young)
    assert found["elastic"] == pytest.approx(volume @ density, rel=1e-12)


def test_released_energy_is_the_difference() -> None:
    stepped = solver(sliding(12, 12) | {"materials": [SOIL | {"law": "elastic"}, STONE]})
    stepped.set("stress", 2e4 * np.random.default_rng(5).standard_normal((stepped.size, 4)))
    before = stepped.energies()["elastic"]
    assert stepped.release_stress() == 0.0
    stepped.set_materials([_core.Material(**SOIL), _core.Material(**STONE)])
    assert stepped.energies()["elastic"] == pytest.approx(before, rel=1e-14)
    released = stepped.release_stress()
    assert released > 0.1 * before
    assert before - stepped.energies()["elastic"] == pytest.approx(released, rel=1e-12)
    assert (stepped.get("plastic_strain") > 0).any()
    assert stepped.release_stress() == pytest.approx(0.0, abs=1e-9 * before)


def test_clock() -> None:
    stepped = solver(sliding(12, 12), time_step=("fixed", 2e-3))
    assert (stepped.time, stepped.steps) == (0.0, 0)
    stepped.advance(100)
    assert stepped.steps == 100
    assert stepped.time == pytest.approx(0.2, rel=1e-12)
    assert stepped.get("plastic_strain").max() > 0
    position = stepped.get("position")
    stepped.reset_clock()
    assert (stepped.time, stepped.steps) == (0.0, 0)
    assert stepped.get("plastic_strain").max() == 0
    np.testing.assert_array_equal(stepped.get("position"), position)


@pytest.mark.parametrize("end", [0.1, 0.12345, 1e-5])
def test_courant_steps_end_at_the_time_asked_for(end: float) -> None:
    stepped = solver(sliding(12, 12), time_step=("courant", 0.4))
    largest = stepped.time_step
    stepped.advance_to(end)
    assert stepped.time == pytest.approx(end, rel=1e-14)
    assert stepped.steps >= end / largest
    steps = stepped.steps
    stepped.advance_to(end)
    stepped.advance_to(end / 2)
    assert stepped.steps == steps
    stepped.advance_to(2 * end)
    assert stepped.time == pytest.approx(2 * end, rel=1e-14)


def test_fixed_steps_end_at_the_first_one_past_the_time() -> None:
    stepped = solver(sliding(12, 12), time_step=("fixed", 1e-3))
    stepped.advance_to(0.1)
    assert stepped.steps == 100
    assert stepped.time == pytest.approx(0.1, rel=1e-12)
    stepped.advance_to(0.1005)
    assert stepped.steps == 101


def test_what_the_next_step_will_be() -> None:
    scene = block(8, 8, speed=0.5) | {"walls": [FREE] * 4}
    wave = _core.Material(**SOIL).wave_speed
    stepped = solver(scene, time_step=("courant", 0.4), blend=("viscosity", 0.2))
    fastest = np.linalg.norm(scene["velocity"], axis=1).max()
    dt = 0.4 * 0.5 / (wave + fastest)
    assert stepped.time_step == pytest.approx(dt, rel=1e-12)
    assert stepped.stable_time_step == pytest.approx(_core.courant_limit * 0.5 / wave, rel=1e-9)
    assert stepped.alpha == pytest.approx(0.2 * dt / (0.5**2 / 6 + 0.125**2 / 3), rel=1e-12)
    stepped.set_time_step("fixed", 1e-3)
    assert stepped.time_step == 1e-3
    assert (stepped.size, stepped.threads) == (64, 1)


def test_memory_is_below_a_kilobyte_a_point() -> None:
    scene = sliding(200, 100)
    before = resident_bytes()
    stepped = solver(scene)
    stepped.advance(2)
    assert stepped.size == 20_000
    assert 100 * stepped.size < stepped.bytes < 1000 * stepped.size
    assert resident_bytes() - before < 1000 * stepped.size


def resident_bytes() -> int:
    """Memory of this process; 0 where the system does not tell."""
    return int(STATM.read_text().split()[1]) * 4096 if STATM.exists() else 0


@pytest.mark.parametrize("volume_update", ["linear", "exponential"])
@pytest.mark.parametrize("lighter", [1.0, 0.7])
def test_courant_step_after_steps(lighter: float, volume_update: str) -> None:
    """With the largest wave speed sqrt(M V / m) of all points, whose masses may differ."""
    scene = sliding(24, 24) | {"materials": [SOIL], "volume_update": volume_update}
    scene["material"] = np.zeros_like(scene["material"])
    scene["mass"][::7] *= lighter
    stepped = solver(scene)
    soil = _core.Material(**SOIL)
    for _ in range(5):
        stepped.advance(60)
        specific = (stepped.get("volume") / stepped.get("mass")).max()
        wave = np.sqrt(soil.wave_speed**2 * SOIL["density"] * specific)
        fastest = np.linalg.norm(stepped.get("velocity"), axis=1).max()
        assert stepped.time_step == pytest.approx(0.4 * 0.5 / (wave + fastest), rel=1e-12)
