"""Soil that meets a stone in the NumPy twin, against the law of Coulomb."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reference.bodies import quarter_turn
from reference.interface import APART, Interface


def runs_into_an_ellipse(seed: int, friction: float, heaviest: float) -> Interface:
    """Soil that runs at random into an ellipse of mass 1, in nodes of at most the `heaviest`."""
    random = np.random.default_rng(seed)
    count, axes = random.integers(2, 9), np.array([1.0, 0.5])
    turn = random.uniform(0, 2 * np.pi, count)
    place = axes * np.column_stack([np.cos(turn), np.sin(turn)])
    normal = place / axes**2
    normal /= np.hypot(*normal.T)[:, None]
    body: Any = SimpleNamespace(
        centre=np.zeros(2), mass=1.0, inertia=axes @ axes / 4, friction=friction
    )
    whole: Any = SimpleNamespace(velocity=np.zeros(2), spin=0.0)
    mass, free = random.uniform(0.02, heaviest, count), random.standard_normal((count, 2))
    return Interface(body, whole, place, normal, np.full(count, APART), mass, free)


@pytest.mark.parametrize(
    ("friction", "heaviest", "seeds"),
    [
        (0.1, 0.5, (31, 124, 126, 142, 260)),  # soil turns about on its way to where it settles
        (0.1, 0.5, (112, 374, 453, 595, 655, 1945, 2078)),  # whole steps of Newton's method cycle
        (0.7, 3.0, (93, 344, 686, 834)),  # no part of such a step is better: in turn
        (0.7, 3.0, range(200)),
    ],
)
def test_soil_meets_a_stone_by_the_law_of_coulomb(
    friction: float, heaviest: float, seeds: Sequence[int]
) -> None:
    """None runs into it or is pulled; friction is enough for what sticks, and the most it can be,
    against the slip, where soil slips; no energy is gained."""
    for seed in seeds:
        found = runs_into_an_ellipse(seed, friction, heaviest)
        assert found.unsettled == 0.0
        motion = np.append(found.whole.velocity, found.whole.spin)
        across = quarter_turn(found.normal)
        left = found.velocity() - found.motion_at @ motion
        out, slip = (np.sum(left * of, axis=1) for of in (found.normal, across))
        pushed, rubbed = (np.sum(found.taken * of, axis=1) for of in (found.normal, across))
        assert out.min() > -1e-9 and pushed.min() > -1e-9
        assert np.abs(out * pushed).max() < 1e-9
        assert (np.abs(rubbed) - friction * pushed).max() < 1e-9
        slips = np.abs(slip) > 1e-9
        most = -np.sign(slip) * friction * pushed
        np.testing.assert_allclose(rubbed[slips], most[slips], atol=1e-9)
        energy = found.mass @ (found.velocity() ** 2).sum(axis=1) + motion @ found.inertia @ motion
        assert energy < found.mass @ (found.free**2).sum(axis=1) * (1 + 1e-12)


def test_soil_on_the_verge_of_slipping_takes_all_its_friction() -> None:
    """Rounding may find that it neither sticks nor slips; its impulse is the same either way."""
    random, friction = np.random.default_rng(3), 0.7
    stone = runs_into_an_ellipse(0, friction, 1.0)
    for rubbing in np.where(random.random(1000) < 0.5, friction, -friction):
        arm = random.standard_normal(2)
        yields = random.uniform(1.0, 9.0) * np.eye(2) + np.outer(arm, arm)
        impulse = np.array([1.0, rubbing])
        apart = -yields @ impulse
        if apart[0] < 0:
            found, _, _ = stone._met(apart, yields)
            np.testing.assert_allclose(found, impulse, rtol=1e-11)
