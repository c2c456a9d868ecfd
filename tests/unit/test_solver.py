"""The Python solver over the compiled one."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import gimpslope as gs

G = 9.81
SOIL = gs.DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)
SCENE = gs.Scene(gs.Outline.slope(), SOIL, cell=0.8)
N = SCENE.n_points


def floating(**options: Any) -> gs.Solver:
    """The points of the slope without walls."""
    return gs.Solver(SCENE.points, [SOIL.elastic()], cell=SCENE.cell, **options)


# Motion with an exact answer


def test_free_fall() -> None:
    """Every step adds g dt to the velocity, then v dt to the place: sums with a closed form."""
    dt, n = 1e-3, 200
    solver = floating(gravity=(1.5, -G), method=gs.Method(time_step=dt, alpha=0.0))
    solver.advance(n)
    gravity = np.array([1.5, -G])
    np.testing.assert_allclose(solver.velocity, np.tile(gravity * n * dt, (N, 1)), rtol=1e-10)
    fallen = solver.position - SCENE.points.position
    np.testing.assert_allclose(
        fallen, np.tile(gravity * dt**2 * n * (n + 1) / 2, (N, 1)), rtol=1e-9
    )
    assert solver.steps == n and solver.time == pytest.approx(n * dt)
    # Rounding only: 1e-16 of the modulus and of 200 sums.
    assert np.abs(solver.stress).max() < 1e-10 * SOIL.young


def test_uniform_body_force_is_a_gravity() -> None:
    """Also across sorts, by which points change their places in memory; and it stays until it is
    set anew."""
    method = gs.Method(alpha=0.0, time_step=2e-3)
    falling, pushed = floating(gravity=(3.0, -G), method=method), floating(method=method)
    assert not pushed.body_force.any()
    shown = pushed.view("body_force")
    pushed.body_force = np.tile([3.0, -G], (N, 1))
    np.testing.assert_array_equal(shown, pushed.body_force)
    for solver in (falling, pushed):
        solver.advance(300)
    np.testing.assert_allclose(pushed.position, falling.position, rtol=0, atol=1e-9)
    pushed.body_force = np.zeros((N, 2))
    before = pushed.velocity
    pushed.advance(10)
    np.testing.assert_allclose(pushed.velocity, before, atol=1e-9)


def test_body_force_follows_its_points() -> None:
    """Two halves pushed apart: each goes its own way, whatever its order in memory."""
    apart = np.where(SCENE.points.position[:, :1] < 4.0, -1.0, 1.0) * (1.0, 0.0)
    dust = gs.Solver(
        SCENE.points,
        [gs.Elastic(1800, 1.0, 0.0)],
        cell=SCENE.cell,
        method=gs.Method(alpha=0.0, time_step=5e-3),
    )
    dust.body_force = apart * 5.0
    dust.advance_to(1.0)
    assert (dust.numbers != np.arange(N)).any()
    away = np.abs(SCENE.points.position[:, 0] - 4.0) > 2 * SCENE.cell
    moved = dust.position - SCENE.points.position
    np.testing.assert_allclose(moved[away, 0], 2.5 * apart[away, 0], rtol=0.05)


def test_gravity_grows_linearly_and_then_stays() -> None:
    """Step k of the ramp adds g dt (k dt / ramp)."""
    dt, ramp = 1e-3, 0.1
    solver = floating(method=gs.Method(time_step=dt))
    solver.set_gravity(0.0, -G, ramp)
    for k in (30, 100, 150):
        solver.advance(k - solver.steps)
        in_ramp = min(k, 100)
        speed = G * dt * (dt / ramp * in_ramp * (in_ramp + 1) / 2 + (k - in_ramp))
        np.testing.assert_allclose(solver.velocity[:, 1], -speed, rtol=1e-9)


def test_momentum_and_angular_momentum_without_walls() -> None:
    """A stressed body that flies apart keeps its momentum; mass is that of before to the bit."""
    random = np.random.default_rng(4)
    solver = floating(velocity=random.normal(size=(N, 2)), method=gs.Method(alpha=0.0))
    before = solver.mass @ solver.velocity
    solver.advance(100)
    scale = solver.mass @ np.abs(solver.velocity)
    np.testing.assert_allclose(solver.mass @ solver.velocity, before, atol=1e-11 * scale.max())
    np.testing.assert_array_equal(solver.mass, SCENE.points.mass)


def test_bar_swings_in_its_period() -> None:
    """A bar between rollers that gravity meets at once swings at f = c / (4 H) between no load and
    twice the static one. The mesh of n cells is 1/(24) (pi / (2 n))^2 off, under 0.1 % for 8."""
    height = 4.0
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, height), (0.0, height)])
    rock = gs.Elastic(density=2000, young=1e9, poisson=0.3)
    walls = gs.Walls(gs.Roller(), gs.Roller(), gs.Roller(), gs.Free())
    scene = gs.Scene(gs.Outline(corners), rock, cell=0.5, walls=walls)
    solver = gs.Solver.of(scene, gs.Method(alpha=0.0, courant=0.2))
    period = 4 * height / rock.wave_speed
    times, tops = [], []
    while solver.time < 3 * period:
        solver.step()
        times.append(solver.time)
        tops.append(solver.position[:, 1].max())
    fall = tops[0] - np.array(tops)
    static = rock.density * G * height**2 / (2 * rock.wave_speed**2 * rock.density)
    assert fall.max() == pytest.approx(2 * static, rel=0.06)
    middle = fall > static
    rises = np.asarray(times)[1:][middle[1:] & ~middle[:-1]]
    # Steps are 1/160 of a period, and higher modes tilt each passage.
    assert np.diff(rises).mean() == pytest.approx(period, rel=0.03)


# Energies


def test_energies_of_a_known_state() -> None:
    stress = np.zeros((N, 4))
    stress[:, :3] = -5e4
    solver = floating(velocity=np.tile((3.0, 4.0), (N, 1)), stress=stress, gravity=(0.0, -G))
    mass, volume = SCENE.points.mass, SCENE.points.volume
    energies = solver.energies()
    assert energies.kinetic == pytest.approx(12.5 * mass.sum())
    assert energies.potential == pytest.approx(G * mass @ SCENE.points.position[:, 1])
    assert energies.elastic == pytest.approx(5e4**2 / (2 * SOIL.bulk_modulus) * volume.sum())
    assert energies.max_speed == pytest.approx(5.0)


def test_release_stress_returns_and_tells_the_energy() -> None:
    random = np.random.default_rng(0)
    stress = 1e5 * random.normal(size=(N, 4))
    solver = gs.Solver.of(SCENE)
    solver.stress = stress
    before = solver.energies().elastic
    released = solver.release_stress()
    expected = gs.kernel.return_mapping(SOIL, stress)
    np.testing.assert_allclose(solver.stress, expected.stress, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(solver.plastic_strain, expected.plastic_strain, rtol=1e-12)
    assert released == pytest.approx(before - solver.energies().elastic, rel=1e-9)
    assert released > 0
    # What was returned is on the surface: again nothing is released but rounding.
    assert abs(solver.release_stress()) < 1e-9 * released


# State, clock, time step


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


def energies_of(solver: gs.Solver) -> dict[str, float]:
    """By their definitions, from the fields."""
    speed = np.linalg.norm(solver.velocity, axis=1)
    normal, shear = solver.stress[:, :3], solver.stress[:, 3]
    young, poisson = SOIL.young, SOIL.poisson
    double_density = (
        (1 + poisson) * (normal**2).sum(axis=1)
        - poisson * normal.sum(axis=1) ** 2
        + 2 * (1 + poisson) * shear**2
    ) / young
    return {
        "kinetic": 0.5 * solver.mass @ speed**2,
        "potential": G * solver.mass @ solver.position[:, 1],
        "elastic": 0.5 * solver.volume @ double_density,
        "max_speed": speed.max(),
    }


@pytest.mark.parametrize(
    "method",
    [
        gs.Method(threads=2),
        gs.Method(ledger=True),
        gs.Method(volumetric_strain="cell_average"),
        gs.Method(precision="single"),
        gs.Method(time_step=1e-3),
    ],
    ids=["threads", "ledger", "cell average", "single", "fixed step"],
)
def test_rows_on_the_way_are_the_energies_there(method: gs.Method) -> None:
    """Whether they are summed up in the last step or afterwards, and however often one looks."""
    times = [0.0105, 0.02, 0.0311, 0.05]
    once, often = (gs.Solver.of(SCENE, method) for _ in range(2))
    once.advance_through(times)
    rows = once.take_rows()
    assert len(rows["time"]) == len(times)
    for number, time in enumerate(times):
        often.advance_to(time)
        assert rows["step"][number] == often.steps
        assert rows["time"][number] == often.time
        for name, value in energies_of(often).items():
            assert rows[name][number] == pytest.approx(value, rel=1e-12), name
        if method.ledger:
            assert rows["plastic"][number] == often.ledger.plastic
    assert ("plastic" in rows) == method.ledger
    assert len(once.take_rows()["time"]) == 0


def test_energies_follow_what_is_set_after_a_step() -> None:
    solver = gs.Solver.of(SCENE)
    solver.advance_to(0.02)
    for change in ("velocity", "stress", "volume", "position"):
        setattr(solver, change, 1.001 * getattr(solver, change))
        for name, value in energies_of(solver).items():
            assert getattr(solver.energies(), name) == pytest.approx(value, rel=1e-12), change


def test_times_that_are_not_ahead_have_no_row() -> None:
    solver = gs.Solver.of(SCENE, gs.Method(time_step=1e-3))
    solver.advance_through([1e-3, 1.2e-3, 1.4e-3, 3e-3])
    np.testing.assert_allclose(solver.take_rows()["time"], [1e-3, 2e-3, 3e-3])
    with pytest.raises(ValueError, match=r"^times must grow, got \[0\.2 0\.1\]"):
        solver.advance_through([0.2, 0.1])


def test_rows_of_before_a_failure_are_kept() -> None:
    solver = floating(method=gs.Method(time_step=0.02, allow_unstable=True), gravity=(0, -G))
    solver.velocity = np.random.default_rng(1).normal(size=(N, 2))
    with pytest.raises(gs.Diverged) as failure:
        solver.advance_through(0.02 * np.arange(1, 1000))
    assert len(solver.take_rows()["time"]) == failure.value.step - 1 > 0


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
