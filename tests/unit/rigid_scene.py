"""Shapes of rigid stones, their points, and what they and their solver carry."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import gimpslope as gs
from gimpslope._check import FloatArray

G = 9.81
ROCK = gs.Rigid(2600.0)
SOIL = gs.Elastic(2000.0, 1e6, 0.3)
CELL, SPACING = 0.1, 0.05
SQUARE_OF_A_POINT = SPACING**2 / 6  # mean squared distance from its centre in the square of a point
Inside = Callable[[FloatArray, FloatArray], Any]


class Bodies(NamedTuple):
    """Motion of m rigid stones, of shape (m,) or (m, 2)."""

    number: NDArray[np.int32]
    centre: FloatArray
    angle: FloatArray
    velocity: FloatArray
    spin: FloatArray
    impulse: FloatArray
    angular_impulse: FloatArray


def bodies(solver: gs.Solver) -> Bodies:
    """Angles in radians."""
    found = solver.rigid_stones
    return Bodies(
        found.number,
        found.centre,
        np.radians(found.angle),
        found.velocity,
        found.spin,
        found.impulse,
        found.angular_impulse,
    )


def lattice(
    width: float, height: float, spacing: float, inside: Inside, corner: Any = (0.0, 0.0)
) -> FloatArray:
    """Points of a rectangle with its lower left corner there, of which those `inside` are kept."""
    x = corner[0] + spacing * (np.arange(round(width / spacing)) + 0.5)
    y = corner[1] + spacing * (np.arange(round(height / spacing)) + 0.5)
    columns, rows = np.meshgrid(x, y)
    place = np.column_stack([columns.ravel(), rows.ravel()])
    return np.asarray(place[inside(place[:, 0], place[:, 1]) | np.zeros(len(place), bool)])


def rectangle(width: float, height: float, spacing: float) -> FloatArray:
    return lattice(width, height, spacing, lambda x, y: True)


def disk(radius: float, spacing: float, centre: Any = (0.0, 0.0)) -> FloatArray:
    corner = np.asarray(centre) - radius
    return lattice(
        2 * radius,
        2 * radius,
        spacing,
        lambda x, y: np.hypot(x - centre[0], y - centre[1]) < radius,
        corner,
    )


def points(spacing: float, *parts: tuple[FloatArray, float, int, int]) -> gs.Points:
    """Points of parts, each with its position, density, material and stone."""
    count = [len(part[0]) for part in parts]
    density, material, stone = (np.repeat([part[i] for part in parts], count) for i in (1, 2, 3))
    volume = np.full(sum(count), spacing**2)
    place = np.vstack([part[0] for part in parts])
    half = np.full_like(place, spacing / 2)
    return gs.Points(place, half, volume, density * volume, material, stone)


def turning(place: FloatArray, spin: float) -> FloatArray:
    """Velocities of a turn about the mean of the places."""
    arm = place - place.mean(axis=0)
    return spin * np.column_stack([-arm[:, 1], arm[:, 0]])


def moments(arm: FloatArray, vector: FloatArray) -> FloatArray:
    """z of arm x vector."""
    return np.asarray(arm[..., 0] * vector[..., 1] - arm[..., 1] * vector[..., 0])


def momentum(solver: gs.Solver) -> FloatArray:
    return solver.mass @ solver.velocity


def angular_momentum(solver: gs.Solver) -> float:
    """About the origin."""
    return float(solver.mass @ moments(solver.position, solver.velocity))


def distances(place: FloatArray) -> FloatArray:
    return np.asarray(np.hypot(*(place[:, None] - place[None]).T))


ANGLE_IRON = lattice(0.25, 0.2, SPACING, lambda x, y: (x < 0.1) | (y < 0.1))  # 14 points


def thrown(place: FloatArray, alpha: float, spin: float, **options: Any) -> gs.Solver:
    return gs.Solver(
        points(SPACING, (place, ROCK.density, 0, 3)),
        [ROCK],
        cell=CELL,
        velocity=np.array([1.0, 0.7]) + turning(place, spin),
        method=gs.Method(alpha=alpha, time_step=1e-3, ledger=True, **options),
    )
