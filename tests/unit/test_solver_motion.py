"""Motion by the Python solver that has an exact answer."""

from __future__ import annotations

import numpy as np
import pytest
from floating_slope import SCENE, SOIL, G, N, floating

import gimpslope as gs


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
