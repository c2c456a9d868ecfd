"""Rigid stones on their own against mechanics: flight, fall, body forces and their impulse."""

from __future__ import annotations

import numpy as np
import pytest
from rigid_scene import (
    ANGLE_IRON,
    SPACING,
    SQUARE_OF_A_POINT,
    G,
    angular_momentum,
    bodies,
    disk,
    distances,
    rectangle,
    thrown,
)

import gimpslope as gs

SHAPES = {"angle iron": ANGLE_IRON, "disk": disk(0.2, SPACING)}


def assert_flies_on(solver: gs.Solver, steps: int) -> None:
    """Nothing is summed over its points: velocity, spin and energy stay to the last bit. Centre and
    angle are sums of as many equal parts, and round as often: 1e-16 a step. Distances between its
    points are those of its shape but for the rounding of their places."""
    start = solver.position
    solver.step()
    first, before, energy = solver.time, bodies(solver), solver.energies().kinetic
    turned = angular_momentum(solver)
    solver.advance(steps)
    after, rounding = bodies(solver), 2e-16 * steps
    change = np.abs(distances(solver.position) - distances(start))
    assert change.max() < 1e-15 * np.abs(solver.position).max()
    np.testing.assert_array_equal(after.velocity, before.velocity)
    np.testing.assert_array_equal(after.spin, before.spin)
    np.testing.assert_allclose(after.angle, before.spin * solver.time, rtol=rounding)
    expected = before.centre + before.velocity * (solver.time - first)
    np.testing.assert_allclose(after.centre, expected, rtol=rounding)
    arms = solver.mass @ (np.hypot(*solver.position.T) * np.hypot(*solver.velocity.T))
    assert abs(angular_momentum(solver) - turned) < rounding * arms
    assert solver.energies().kinetic == energy
    assert abs(solver.ledger.taken) < 1e-15 * energy
    np.testing.assert_allclose(solver.velocity.mean(axis=0), after.velocity[0], rtol=1e-12)


@pytest.mark.parametrize("grid_shape", ["ugimp", "linear", "cpgimp"])
@pytest.mark.parametrize("alpha", [0.0, 0.05, 1.0])
@pytest.mark.parametrize("name", SHAPES)
def test_free_stone_flies_and_turns_on_for_ever(name: str, alpha: float, grid_shape: str) -> None:
    """Nothing acts on it, so momentum, angular momentum, energy and shape stay, whatever the share
    of PIC: a stone's points take no part in it."""
    assert_flies_on(thrown(SHAPES[name], alpha, 5.0, shape=grid_shape), 10_000)


@pytest.mark.slow
@pytest.mark.parametrize("alpha", [0.0, 0.05, 1.0])
def test_free_stone_after_a_million_steps(alpha: float) -> None:
    assert_flies_on(thrown(ANGLE_IRON, alpha, 5.0), 1_000_000)


def test_free_fall() -> None:
    """Symplectic Euler falls g dt^2 n (n + 1) / 2, and a falling stone has no impulse."""
    falling, steps, dt = thrown(ANGLE_IRON, 0.05, 5.0), 1000, 1e-3
    before = bodies(falling)
    falling.set_gravity(0.0, -G)
    falling.advance(steps)
    after = bodies(falling)
    fall = np.array([0.0, -G * dt**2 * steps * (steps + 1) / 2])
    expected = before.centre + before.velocity * falling.time + fall
    np.testing.assert_allclose(after.centre, expected, rtol=1e-11)
    np.testing.assert_allclose(after.spin, before.spin, rtol=1e-11)
    assert np.abs(after.impulse).max() < 1e-10 * falling.mass.sum() * G


@pytest.mark.parametrize("alpha", [0.0, 0.05, 1.0])
def test_body_force_pushes_and_turns_by_its_sum_and_moment(alpha: float) -> None:
    """A bar pushed at one end across its axis, wherever that points: force F = sum m b and torque
    T = sum m r x b are constant, so the spin is T t / I and the velocity that of F turned, both to
    rounding."""
    bar = rectangle(0.8, 0.1, SPACING)
    pushed, steps, dt = thrown(bar, alpha, 0.0), 300, 1e-3
    arm = bar - bar.mean(axis=0)
    across = np.where(arm[:, 0] > 0.3, 25.0, 0.0)  # m/s2, of the points at the right end
    mass, velocity = pushed.mass, bodies(pushed).velocity[0]
    inertia = float(mass @ np.sum(arm**2 + SQUARE_OF_A_POINT / 2, axis=1))
    torque = float(mass @ (arm[:, 0] * across))
    impulse = np.zeros(2)
    for _ in range(steps):
        angle = bodies(pushed).angle[0]
        normal = np.array([-np.sin(angle), np.cos(angle)])
        pushed.body_force = across[:, None] * normal
        impulse += dt * float(mass @ across) * normal
        pushed.step()
    after = bodies(pushed)
    assert after.spin[0] == pytest.approx(torque * dt * steps / inertia, rel=1e-12)
    angle = torque / inertia * dt**2 * steps * (steps + 1) / 2
    assert after.angle[0] == pytest.approx(angle, rel=1e-12)
    assert after.angle[0] > 0.5
    np.testing.assert_allclose(after.impulse[0], impulse, rtol=1e-11)
    np.testing.assert_allclose(after.velocity[0] - velocity, impulse / mass.sum(), rtol=1e-11)
    assert after.angular_impulse[0] == pytest.approx(torque * dt * steps, rel=1e-12)


def test_impulse_books_what_kinetic_damping_stops() -> None:
    """Change of momentum = impulse + weight times time, and of angular momentum."""
    falling = thrown(ANGLE_IRON, 0.0, 5.0)
    mass, before = falling.mass.sum(), bodies(falling)
    falling.set_gravity(0.0, -G)
    falling.set_damping(kinetic=True)
    falling.advance(200)
    after = bodies(falling)
    change = mass * (after.velocity - before.velocity)
    weight = np.array([0.0, -G]) * mass * falling.time
    np.testing.assert_allclose(after.impulse + weight, change, rtol=1e-10, atol=1e-10 * mass)
    inertia = falling.mass @ np.sum((ANGLE_IRON - ANGLE_IRON.mean(axis=0)) ** 2, axis=1)
    inertia += mass * SQUARE_OF_A_POINT
    expected = inertia * (after.spin - before.spin)
    np.testing.assert_allclose(after.angular_impulse, expected, rtol=1e-10)
    assert after.spin[0] == 0.0
