"""Single pieces of the kernel in `gimpslope.kernel`: shape functions and return mapping."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import gimpslope as gs

SOIL = gs.DruckerPrager(density=1800, young=30e6, poisson=0.33, friction=22, cohesion=1e3)


@pytest.mark.parametrize("shape", ["linear", "ugimp", "cpgimp"])
def test_shape_functions_are_a_partition_that_reproduces_places(shape: Any) -> None:
    random = np.random.default_rng(0)
    points = random.uniform(-3, 3, (50, 2))
    halves = random.uniform(0.05, 0.2, (50, 2))
    cell, origin = 0.5, (-0.2, 0.3)
    found = gs.kernel.shape_functions(shape, points, halves, cell=cell, origin=origin)
    nodes = np.asarray(origin) + cell * found.nodes
    np.testing.assert_allclose(found.values.sum(axis=1), 1, rtol=1e-12)
    np.testing.assert_allclose(found.gradients.sum(axis=1), 0, atol=1e-12)
    np.testing.assert_allclose((found.values[..., None] * nodes).sum(axis=1), points, atol=1e-12)
    jacobian = np.einsum("pkc,pkd->pcd", nodes, found.gradients)
    np.testing.assert_allclose(jacobian, np.tile(np.eye(2), (50, 1, 1)), atol=1e-12)


def test_shape_functions_refuse() -> None:
    with pytest.raises(ValueError, match="half_length must be given with shape 'ugimp', got None"):
        gs.kernel.shape_functions("ugimp", [(0.0, 0.0)], cell=1.0)
    with pytest.raises(ValueError, match=r"shape must be one of .*got 'cubic'"):
        gs.kernel.shape_functions("cubic", [(0.0, 0.0)], cell=1.0)
    with pytest.raises(ValueError, match=r"half_length must be .*\(1, 2\)"):
        gs.kernel.shape_functions("ugimp", [(0.0, 0.0)], np.ones((2, 2)), cell=1.0)
    with pytest.raises(ValueError, match=r"cell must be .*got 0"):
        gs.kernel.shape_functions("linear", [(0.0, 0.0)], cell=0.0)


def test_return_mapping_ends_on_the_cone() -> None:
    trial = 1e5 * np.random.default_rng(0).normal(size=(200, 4)) - [2e5, 2e5, 2e5, 0]
    found = gs.kernel.return_mapping(SOIL, trial)
    eta, xi, _ = SOIL.cone_coefficients

    def excess(stress: np.ndarray) -> np.ndarray:
        mean = stress[:, :3].mean(axis=1)
        deviator = stress[:, :3] - mean[:, None]
        j2 = 0.5 * (deviator**2).sum(axis=1) + stress[:, 3] ** 2
        result: np.ndarray = np.sqrt(j2) + eta * mean - xi * SOIL.cohesion
        return result

    outside = excess(trial) > 0
    assert 0 < outside.sum() < 200
    np.testing.assert_allclose(excess(found.stress)[outside], 0, atol=1e-6)
    np.testing.assert_array_equal(found.stress[~outside], trial[~outside])
    np.testing.assert_array_equal(found.plastic_strain > 0, outside)


def test_return_mapping_refuses() -> None:
    with pytest.raises(TypeError, match="material must be a DruckerPrager"):
        gs.kernel.return_mapping(SOIL.elastic(), np.zeros((1, 4)))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"stress must be .*\(n, 4\)"):
        gs.kernel.return_mapping(SOIL, np.zeros((2, 3)))


@pytest.mark.parametrize(
    ("shape", "half_length", "expected"),
    [
        ("linear", 0.0, 1 / 6),
        ("ugimp", 0.25, 1 / 6 + 1 / 48),
        ("ugimp", 0.3, 1 / 6 + 0.03),
        ("ugimp", 0.5, 1 / 4),
        ("quadratic_bspline", 0.25, 1 / 4),
    ],
)
def test_second_moment(shape: str, half_length: float, expected: float) -> None:
    """That of a hat and of the box it is averaged over add up: h^2 / 6 + l^2 / 3; a spline of three
    boxes one cell wide has h^2 / 4."""
    moment = gs.kernel.second_moment(shape, half_length * 0.2, cell=0.2)
    assert moment == pytest.approx(expected * 0.2**2, rel=1e-12)
