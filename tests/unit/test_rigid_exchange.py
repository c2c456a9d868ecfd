"""What rigid stones and soil give each other: momentum, angular momentum, energy and rotation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from rigid_scene import (
    CELL,
    ROCK,
    SOIL,
    SPACING,
    SQUARE_OF_A_POINT,
    angular_momentum,
    bodies,
    disk,
    moments,
    momentum,
    points,
    rectangle,
    turning,
)

import gimpslope as gs
from gimpslope._check import FloatArray
from reference import Material, Reference
from reference.bodies import Rigid
from reference.shapes import weights

STONES = [ROCK, gs.Rigid(ROCK.density, friction=30.0)]
SMOOTH = gs.Rigid(ROCK.density, friction=0.0)


def hitting(stone: gs.Material, alpha: float) -> tuple[gs.Solver, Any]:
    """A spinning disk that hits a free elastic block off its middle; and which points it has."""
    block = rectangle(1.0, 1.0, SPACING)
    ball = disk(0.2, SPACING, (-0.25, 0.65))
    given = points(SPACING, (block, SOIL.density, 0, -1), (ball, stone.density, 1, 0))
    of = given.stone == 0
    velocity = np.zeros((len(given), 2))
    velocity[of] = np.array([1.5, 0.0]) + turning(ball, 3.0)
    method = gs.Method(alpha=alpha, courant=0.4, ledger=True)
    return gs.Solver(given, [SOIL, stone], cell=CELL, velocity=velocity, method=method), of


@pytest.mark.parametrize("stone", STONES)
@pytest.mark.parametrize("alpha", [0.0, 0.05, 1.0])
def test_impact_keeps_momentum_and_energy_in_the_books(alpha: float, stone: gs.Rigid) -> None:
    impact, of = hitting(stone, alpha)
    before, energy = momentum(impact), impact.energies()
    stone_before = bodies(impact)
    impact.advance_to(0.3)
    change, after = momentum(impact) - before, bodies(impact)
    assert np.abs(change).max() < 1e-12 * np.abs(before).max()
    assert after.velocity[0, 0] < 0.6 * stone_before.velocity[0, 0]  # it did hit
    lost = impact.mass[of].sum() * (after.velocity - stone_before.velocity)
    np.testing.assert_allclose(after.impulse, lost, rtol=1e-10)
    now = impact.energies()
    balance = now.kinetic + now.elastic + impact.ledger.taken
    assert balance == pytest.approx(energy.kinetic, rel=1e-10)
    assert impact.ledger.rigidity > 0


def test_friction_is_in_the_books() -> None:
    """What slips along a rough stone loses energy to friction, along a smooth one none, and soil
    that sticks none that counts as such."""
    entries = []
    for stone in (*STONES, SMOOTH):
        impact, _ = hitting(stone, 0.0)
        impact.advance_to(0.3)
        entries.append(impact.ledger)
    sticking, rough, smooth = entries
    assert sticking.friction == 0
    assert rough.friction > 0.01 * rough.taken
    assert abs(smooth.friction) < 1e-9 * smooth.taken


def stopped(solver: gs.Solver, stone: gs.Rigid, alpha: float) -> gs.Solver:
    """A new solver with the state of `hitting`: one that does not know what touched before."""
    given = gs.Points(
        solver.position,
        solver.half_length,
        solver.volume,
        solver.mass,
        solver.material,
        np.where(solver.material == 1, 0, -1),
    )
    method = gs.Method(alpha=alpha, courant=0.4, ledger=True)
    again = gs.Solver(given, [SOIL, stone], cell=CELL, velocity=solver.velocity, method=method)
    again.stress = solver.stress
    return again


def twin_of(solver: gs.Solver, stone: gs.Rigid, alpha: float) -> Reference:
    """The plain NumPy twin of a state of `hitting`, for one step."""
    plain = Reference(
        solver.position,
        solver.velocity,
        solver.half_length,
        solver.mass,
        solver.volume,
        solver.material,
        [Material(SOIL.density, SOIL.young, SOIL.poisson), Rigid(stone.density, stone.friction)],
        np.where(solver.material == 1, 0, -1),
        cell=CELL,
        origin=(0.0, 0.0),
        walls=[("free", 0.0, 0.0)] * 4,
        shape="ugimp",
        blend=("alpha", alpha),
        time_step=("fixed", solver.time_step),
        margin=3,
    )
    plain.stress = solver.stress
    return plain


@pytest.mark.parametrize("kind", STONES)
@pytest.mark.parametrize("alpha", [0.0, 0.05, 1.0])
def test_stone_takes_from_the_nodes_what_angular_momentum_they_give(
    alpha: float, kind: gs.Rigid
) -> None:
    """Internal forces keep the angular momentum of the nodes. A point of soil takes its share at
    its own place and loses m S (xn - xp) x b of what node n gives, b = v+ - (1 - alpha) v-. That
    is all that is lost: the stone with the nodes it holds keeps theirs. Places apart, which move
    along with displacements of PIC while the velocities are FLIP's."""
    impact, of = hitting(kind, alpha)
    soil, mass = ~of, impact.mass
    held = 0.0  # angular momentum that the stone takes up
    for wait in (0.05, 0.05, 0.1, 0.1):
        impact.advance_to(wait)
        impact = stopped(impact, kind, alpha)
        place, velocity, stone = impact.position, impact.velocity, bodies(impact)
        plain = twin_of(impact, kind, alpha)
        share = weights("ugimp", place, plain.half_length, plain.lines, CELL)[0] * mass[:, None]
        share = share[soil]
        node_mass = share.sum(axis=0)
        reached = node_mass > 0
        raw = (share.T @ velocity[soil])[reached] / node_mass[reached, None]
        plain.advance(1)
        impact.step()
        given = plain.node_velocity[reached] - (1 - alpha) * raw
        levers = plain.nodes[reached][None] - place[soil][:, None]
        lost = float(np.sum(share[:, reached] * moments(levers, given[None])))

        now = bodies(impact)
        of_stone = mass[of].sum()
        inertia = mass[of] @ np.sum((place[of] - stone.centre) ** 2, axis=1)
        inertia += of_stone * SQUARE_OF_A_POINT
        gained = inertia * (now.spin - stone.spin)[0]
        gained += of_stone * moments(stone.centre, now.velocity - stone.velocity)[0]
        held = max(held, abs(gained))
        change = float(mass[soil] @ moments(place, impact.velocity - velocity)[soil])
        scale = float(mass @ (np.hypot(*place.T) * np.hypot(*velocity.T)))
        assert abs(change + gained + lost) < 1e-13 * scale
    assert held > 1e-4 * scale


@pytest.mark.parametrize("alpha", [0.0, 0.01, 0.05])
def test_angular_momentum_drifts_no_more_than_with_a_stone_that_deforms(alpha: float) -> None:
    """The rest of the drift is that of soil: points without a spin of their own lose the moments
    within their domains, and move as PIC has it while they keep FLIP's velocities. Measured within
    0.6 s, with a rigid stone and one of 100 MPa: 1.7 and 2.1 % of the angular momentum without PIC,
    3.2 and 7.6 % with one per cent of it a step, 9.4 and 14.6 % with five."""
    drift = []
    for stone in (ROCK, gs.Elastic(ROCK.density, 1e8, 0.2)):
        impact, _ = hitting(stone, alpha)
        before, found = angular_momentum(impact), []
        for time in np.linspace(0.05, 0.6, 12):
            impact.advance_to(time)
            found.append(abs(angular_momentum(impact) / before - 1))
        drift.append(max(found))
    assert drift[0] < 0.12
    assert drift[0] < 1.2 * drift[1]


def angle_of(solver: gs.Solver, of: Any, start: FloatArray) -> float:
    """Mean angle, by least squares, by which some points have turned since the start."""
    old = start[of] - start[of].mean(axis=0)
    arm = solver.position[of] - solver.position[of].mean(axis=0)
    return float(np.arctan2(moments(old, arm).sum(), np.sum(old * arm)))


@pytest.mark.parametrize("alpha", [0.0, 0.05])
@pytest.mark.parametrize(
    ("radius", "cell"),
    [(0.2, 0.1), (0.4, 0.1), (0.1, 0.05), (0.1, 0.1)],
)
def test_stone_turns_with_the_soil_that_turns_around_it(
    radius: float, cell: float, alpha: float
) -> None:
    """A disk of soil turns as a whole, with a rigid disk of the same density in its middle: there
    is no reason for that to turn any faster or slower than the soil next to it, whose own angle
    falls behind 0.4 by up to 3 % without PIC and 13 % with 5 % of it a step, and without a stone
    as well. Measured: within 0.15 %."""
    spacing = cell / 2
    ground = disk(radius + 0.5, spacing)
    inside = np.hypot(*ground.T) < radius
    given = points(
        spacing, (ground[~inside], SOIL.density, 0, -1), (ground[inside], SOIL.density, 1, 0)
    )
    start = given.position
    wheel = gs.Solver(
        given,
        [SOIL, gs.Rigid(SOIL.density)],
        cell=cell,
        velocity=turning(start, 1.0),
        method=gs.Method(alpha=alpha, courant=0.4),
    )
    wheel.advance_to(0.4)
    around = (given.stone < 0) & (np.hypot(*start.T) < radius + 0.15)
    soil = angle_of(wheel, around, start)
    assert soil > 0.3
    assert bodies(wheel).angle[0] == pytest.approx(soil, rel=0.003)
