"""The Python solver over the compiled one: state, clock, time step, failures."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from floating_slope import SCENE, SOIL, G, N, floating

import gimpslope as gs


def test_scene_becomes_a_solver_at_rest() -> None:
    solver = gs.Solver.of(SCENE)
    assert len(solver) == N
    for name in ("position", "half_length", "volume", "mass", "material"):
        np.testing.assert_array_equal(getattr(solver, name), getattr(SCENE.points, name))
    np.testing.assert_allclose(solver.density, SOIL.density)
    for name in ("velocity", "stress", "plastic_strain"):
        assert not getattr(solver, name).any()
    assert solver.time == 0 and solver.steps == 0 and solver.threads == 1
    assert solver.instruction_set == gs.kernel.instruction_sets()[-1]
    assert "368 points" in repr(solver) and 0 < solver.bytes < 1000 * N


def test_arrays_in_the_given_order_and_views_in_storage_order() -> None:
    shuffled = np.random.default_rng(1).permutation(N)
    points = gs.Points(**{k: v[shuffled] for k, v in vars(SCENE.points).items() if k != "_"})
    solver = gs.Solver(points, [SOIL], cell=SCENE.cell, gravity=(2.0, -G))
    solver.advance(5)
    assert (solver.numbers != np.arange(N)).any()
    assert np.abs(solver.position - points.position).max() < 0.01
    for name in ("position", "velocity", "stress", "volume", "plastic_strain"):
        np.testing.assert_array_equal(solver.view(name), getattr(solver, name)[solver.numbers])


@pytest.mark.parametrize(
    ("name", "shape"),
    [
        ("position", (N, 2)),
        ("velocity", (N, 2)),
        ("body_force", (N, 2)),
        ("stress", (N, 4)),
        ("volume", (N,)),
        ("plastic_strain", (N,)),
    ],
)
def test_setters_take_what_they_give(name: str, shape: tuple[int, ...]) -> None:
    solver = gs.Solver.of(SCENE)
    values = np.random.default_rng(2).uniform(0.1, 0.2, shape)
    setattr(solver, name, values)
    np.testing.assert_array_equal(getattr(solver, name), values)


def test_step_advance_and_advance_to_are_one() -> None:
    method = gs.Method(time_step=1e-3)
    solvers = [gs.Solver.of(SCENE, method) for _ in range(3)]
    for _ in range(20):
        solvers[0].step()
    solvers[1].advance(20)
    solvers[2].advance_to(0.02)
    for other in solvers[1:]:
        assert other.steps == 20
        np.testing.assert_array_equal(other.position, solvers[0].position)
        np.testing.assert_array_equal(other.stress, solvers[0].stress)


def test_advance_to_ends_exactly_with_a_courant_number() -> None:
    solver = gs.Solver.of(SCENE, gs.Method(courant=0.3))
    for until in (0.01, 0.0101, 0.3):
        solver.advance_to(until)
        assert solver.time == pytest.approx(until, rel=1e-12)
    steps = solver.steps
    solver.advance_to(0.1)
    assert solver.steps == steps


def test_courant_step_is_that_share_of_the_crossing_time() -> None:
    velocity = np.zeros((N, 2))
    velocity[5] = (30.0, 40.0)
    solver = floating(velocity=velocity, method=gs.Method(courant=0.3))
    expected = 0.3 * SCENE.cell / (SOIL.wave_speed + 50.0)
    assert solver.time_step == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("method", "alpha"),
    [
        (gs.Method(time_step=1e-3), 0.01),
        (gs.Method(time_step=1e-3, alpha=0.2), 0.2),
        (gs.Method(time_step=1e-3, relaxation_time=0.1), 0.01),
        # 0.1875 alpha h2 / dt is the viscosity at two points a direction.
        (gs.Method(time_step=1e-3, viscosity=0.6), 0.6 * 1e-3 / (0.1875 * 0.8**2)),
    ],
)
def test_share_of_pic(method: gs.Method, alpha: float) -> None:
    assert gs.Solver.of(SCENE, method).alpha == pytest.approx(alpha, rel=1e-12)


def test_step_above_the_stable_limit_is_refused_unless_allowed() -> None:
    limit = gs.Solver.of(SCENE).stable_time_step
    above = gs.Method(time_step=1.01 * limit)
    with pytest.raises(ValueError, match=r"time_step must be at most 0\.00\d+ s.*allow_unstable"):
        gs.Solver.of(SCENE, above)
    assert gs.Solver.of(SCENE, replace(above, allow_unstable=True)).time_step == 1.01 * limit
    gs.Solver.of(SCENE, gs.Method(time_step=limit))


def test_diverged_names_step_time_point_and_cause() -> None:
    solver = gs.Solver.of(SCENE, gs.Method(time_step=1e-3))
    solver.advance(3)
    velocity = solver.velocity
    velocity[11] = (0.0, 1e8)
    solver.velocity = velocity
    with pytest.raises(
        gs.Diverged, match=r"step 4 from t = 0\.003 s: point \d+ at .*likely cause"
    ) as e:
        solver.advance(10)
    assert (e.value.step, e.value.time) == (4, pytest.approx(3e-3))
    assert 0 <= e.value.point < N


def test_two_solvers_in_turns_do_not_touch_each_other() -> None:
    other = replace(SCENE, cell=1.0, walls=gs.Walls(bottom=gs.Coulomb(0.2)))

    def make() -> tuple[gs.Solver, gs.Solver]:
        return gs.Solver.of(SCENE), gs.Solver.of(other, gs.Method(shape="linear", threads=2))

    alone, turns = make(), make()
    for solver in alone:
        solver.advance(90)
    for _ in range(30):
        for solver in turns:
            solver.advance(3)
    for one, same in zip(alone, turns, strict=True):
        np.testing.assert_array_equal(one.position, same.position)
        np.testing.assert_array_equal(one.stress, same.stress)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"cell": -1.0}, "cell must be .*got -1"),
        ({"origin": (float("nan"), 0.0)}, "origin must be .*got nan"),
        ({"velocity": np.zeros((3, 2))}, r"velocity must be .*\(368, 2\).*got .*\(3, 2\)"),
        ({"stress": np.full((N, 4), np.nan)}, "stress must be .*got nan"),
        ({"gravity": (0.0, float("inf"))}, "gravity must be .*got inf"),
        ({"instruction_set": "abacus"}, "instruction_set must be one of .*got abacus"),
        ({"walls": gs.Walls()}, "wall_positions must be given"),
        ({"materials": []}, "material must be an index into the 0 materials"),
    ],
)
def test_refused_parameters(options: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"materials": [SOIL], "cell": SCENE.cell} | options
    with pytest.raises((TypeError, ValueError), match=message):
        gs.Solver(SCENE.points, **given)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: s.advance(-1), "steps must be a whole number >= 0, got -1"),
        (lambda s: s.advance(1.5), r"steps must be a whole number >= 0, got 1\.5"),
        (lambda s: s.advance_to(float("nan")), "time must be a finite number, got nan"),
        (lambda s: s.set_gravity(0.0, -G, -1.0), "ramp must be .*got -1"),
        (lambda s: s.set_damping(1.0), r"local must be in \[0, 1\), got 1"),
        (lambda s: s.set_materials([]), "materials must be a list of 1"),
        (lambda s: s.view("colour"), "field must be one of .*got colour"),
        (lambda s: setattr(s, "position", np.zeros(3)), r"position must be .*\(368, 2\)"),
        (lambda s: setattr(s, "stress", np.full((N, 4), np.inf)), "stress must be .*got inf"),
    ],
)
def test_refused_arguments(call: Callable[[gs.Solver], Any], message: str) -> None:
    solver = gs.Solver.of(SCENE)
    with pytest.raises((TypeError, ValueError), match=message):
        call(solver)
    assert solver.steps == 0


# Instruction sets, threads, failures


def test_instruction_sets_agree() -> None:
    """Fused multiply-adds round otherwise, so that sets differ, but by rounding only."""
    sets = gs.kernel.instruction_sets()
    assert "generic" in sets
    solvers = [gs.Solver.of(SCENE, instruction_set=name) for name in sets]
    for name, solver in zip(sets, solvers, strict=True):
        assert solver.instruction_set == name
        solver.advance(50)
        np.testing.assert_allclose(solver.position, solvers[0].position, rtol=1e-10)


def test_solver_that_steps_in_another_thread_is_refused() -> None:
    solver = gs.Solver.of(SCENE)
    started, done = threading.Event(), threading.Event()

    def step() -> None:
        started.set()
        solver.advance(3000)
        done.set()

    worker = threading.Thread(target=step)
    worker.start()
    started.wait()
    refused = 0
    while not done.is_set():
        try:
            solver.energies()
        except RuntimeError as error:
            assert "stepping in another thread" in str(error)
            refused += 1
    worker.join()
    assert refused > 0 and solver.steps == 3000


def test_no_step_follows_a_failed_one() -> None:
    solver = gs.Solver.of(SCENE, gs.Method(time_step=1e-3))
    velocity = solver.velocity
    velocity[0] = (1e9, 0.0)
    solver.velocity = velocity
    messages = []
    for _ in range(2):
        with pytest.raises(gs.Diverged, match=r"likely cause: its speed of 1e\+09 m/s") as error:
            solver.step()
        messages.append(str(error.value))
    assert messages[0] == messages[1] and solver.steps == 0


def test_fixed_steps_are_counted_to_the_last() -> None:
    solver = gs.Solver.of(SCENE, gs.Method(time_step=1e-5, alpha=0.0))
    solver.advance_to(0.2)
    assert solver.steps == 20_000 and solver.time == 0.2
