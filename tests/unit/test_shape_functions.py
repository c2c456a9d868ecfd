"""Shape functions: what they must fulfil, and their values by integration of the hat function."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from gimpslope import _core

Array = NDArray[np.float64]

CELL = 0.4
ORIGIN = (0.3, -0.7)
SHAPES = [
    ("linear", 0.0),
    ("ugimp", 1.0),
    ("ugimp", 2.99),
    ("cpgimp", 1.0),
    ("cpgimp", 2.99),
    ("quadratic_bspline", 0.0),
]
IDS = [f"{shape} to {widest:g} cells" for shape, widest in SHAPES]


def sample(widest: float, n: int = 400) -> tuple[Array, Array]:
    """Random places on both sides of the origin, some on grid lines, and half-lengths."""
    random = np.random.default_rng(int(widest))
    position = ORIGIN + CELL * random.uniform(-6.0, 6.0, (n, 2))
    half_length = CELL * random.uniform(0.02, max(widest, 0.5) / 2, (n, 2))
    half_length[0] = CELL * max(widest, 0.5) / 2
    position[1:5] = ORIGIN + CELL * np.array([(0, 0), (-1, 2), (-3.25, 0.25), (1.5, -0.5)])
    half_length[1:5] = CELL / 4
    return position, half_length


def evaluate(shape: str, position: Array, half_length: Array) -> tuple[Array, Array, Array]:
    """Node coordinates (n, k, 2), values (n, k) and gradients (n, k, 2)."""
    nodes, values, gradients = _core.shape_functions(shape, position, half_length, CELL, ORIGIN)
    return np.array(ORIGIN) + CELL * nodes, values, gradients


def dense(shape: str, position: Array, half_length: Array) -> tuple[Array, Array]:
    """Values (n, 40, 40) and gradients (n, 40, 40, 2) on a fixed window of nodes."""
    nodes, values, gradients = _core.shape_functions(shape, position, half_length, CELL, ORIGIN)
    value, gradient = np.zeros((len(nodes), 40, 40)), np.zeros((len(nodes), 40, 40, 2))
    for k, (place, s, g) in enumerate(zip(nodes + 20, values, gradients, strict=True)):
        value[k, place[:, 0], place[:, 1]] = s
        gradient[k, place[:, 0], place[:, 1]] = g
    return value, gradient


def hat_mean(z: Array, half_length: Array) -> Array:
    """Mean of the hat of width CELL over [z - l, z + l]: the trapezoidal rule between its kinks."""
    low, high = z - half_length, z + half_length
    kinks = [np.clip(k, low, high) for k in (-CELL, 0.0, CELL)]
    edges = np.stack([low, *kinks, high])
    hat = np.maximum(0.0, 1.0 - np.abs(edges) / CELL)
    area = np.sum((hat[1:] + hat[:-1]) / 2 * np.diff(edges, axis=0), axis=0)
    return np.asarray(area / (high - low))


def averaged_over(shape: str, half_length: Array) -> Array:
    """Half-lengths over which a shape function is the mean of the hat: of the quadratic spline,
    three boxes one cell wide, convolved, of which two are the hat, half a cell."""
    return np.full_like(half_length, CELL / 2) if "bspline" in shape else half_length


def test_every_shape_function_is_tested() -> None:
    assert {shape for shape, _ in SHAPES} == set(_core.shapes())


@pytest.mark.parametrize(("shape", "widest"), SHAPES, ids=IDS)
def test_partition_of_unity(shape: str, widest: float) -> None:
    _, values, gradients = evaluate(shape, *sample(widest))
    np.testing.assert_allclose(values.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(gradients.sum(axis=1), 0.0, atol=1e-12)
    assert values.min() > -1e-15


@pytest.mark.parametrize(("shape", "widest"), SHAPES, ids=IDS)
def test_linear_fields_are_exact(shape: str, widest: float) -> None:
    position, half_length = sample(widest)
    nodes, values, gradients = evaluate(shape, position, half_length)
    place = np.einsum("nk,nkj->nj", values, nodes)
    np.testing.assert_allclose(place, position, atol=1e-14)
    identity = np.einsum("nki,nkj->nij", gradients, nodes)
    np.testing.assert_allclose(identity, np.tile(np.eye(2), (len(place), 1, 1)), atol=1e-12)


@pytest.mark.parametrize(("shape", "widest"), SHAPES, ids=IDS)
def test_values_are_means_of_the_hat(shape: str, widest: float) -> None:
    position, half_length = sample(widest)
    nodes, values, gradients = evaluate(shape, position, half_length)
    z = position[:, None, :] - nodes
    domain = np.broadcast_to(averaged_over(shape, half_length)[:, None, :], z.shape)
    if shape == "linear":
        hats = np.maximum(0.0, 1.0 - np.abs(z) / CELL)
    else:
        hats = hat_mean(z, domain)
        edges = [np.maximum(0.0, 1.0 - np.abs(z + s * domain) / CELL) for s in (1, -1)]
        slopes = (edges[0] - edges[1]) / (2 * domain)
        expected = np.stack([slopes[..., 0] * hats[..., 1], hats[..., 0] * slopes[..., 1]], -1)
        np.testing.assert_allclose(gradients, expected, atol=1e-13 / CELL)
    np.testing.assert_allclose(values, hats[..., 0] * hats[..., 1], atol=1e-14)


@pytest.mark.parametrize(("shape", "widest"), SHAPES, ids=IDS)
def test_no_node_with_a_value_is_left_out(shape: str, widest: float) -> None:
    position, half_length = sample(widest)
    value, _ = dense(shape, position, half_length)
    lines = np.arange(-20, 20) * CELL
    for axis, other in ((0, 2), (1, 1)):
        z = position[:, axis, None] - (ORIGIN[axis] + lines)
        domain = np.broadcast_to(averaged_over(shape, half_length)[:, axis, None], z.shape)
        hats = np.maximum(0, 1 - np.abs(z) / CELL) if shape == "linear" else hat_mean(z, domain)
        np.testing.assert_allclose(value.sum(axis=other), hats, atol=1e-14)


@pytest.mark.parametrize(("shape", "widest"), SHAPES, ids=IDS)
def test_gradient_is_the_derivative(shape: str, widest: float) -> None:
    position, half_length = sample(widest)
    position, half_length = position[5:], half_length[5:]
    _, gradient = dense(shape, position, half_length)
    step = 1e-6 * CELL
    for axis in (0, 1):
        shift = step * np.eye(2)[axis]
        ahead, _ = dense(shape, position + shift, half_length)
        behind, _ = dense(shape, position - shift, half_length)
        slope = (ahead - behind) / (2 * step)
        np.testing.assert_allclose(slope, gradient[..., axis], atol=1e-4 / CELL)


@pytest.mark.parametrize(("shape", "widest"), SHAPES, ids=IDS)
def test_continuous_across_cells(shape: str, widest: float) -> None:
    """Values nowhere jump along a line through several cells; of GIMP, the gradients neither."""
    n = 4001
    steps = np.linspace(-2.5, 2.5, n)[:, None] * CELL
    position = np.array(ORIGIN) + steps * (1.0, 0.7)
    half_length = np.tile([[0.31, 0.43]], (n, 1)) * CELL * max(widest, 1.0)
    value, gradient = dense(shape, position, half_length)
    move = float(np.linalg.norm(position[1] - position[0]))
    assert np.abs(np.diff(value, axis=0)).max() < 2 * move / CELL
    if shape != "linear":
        bend = 4 / (CELL * 2 * half_length.min())
        assert np.abs(np.diff(gradient, axis=0)).max() < bend * move


def test_small_domains_become_the_linear_hat() -> None:
    position, _ = sample(1.0)
    inside = np.abs((position - ORIGIN) / CELL % 1 - 0.5).max(axis=1) < 0.49
    position = position[inside]
    tiny = np.full_like(position, 1e-4 * CELL)
    narrow, linear = dense("ugimp", position, tiny), dense("linear", position, tiny)
    for ours, hats in zip(narrow, linear, strict=True):
        np.testing.assert_allclose(ours, hats, atol=1e-10 / CELL)


def test_wide_and_narrow_formula_agree() -> None:
    """One wide domain among them makes all points take the five-node formula."""
    position, half_length = sample(1.0)
    narrow = dense("ugimp", position, half_length)
    half_length[0] = 1.2 * CELL
    wide = dense("ugimp", position, half_length)
    for a, b in zip(narrow, wide, strict=True):
        np.testing.assert_allclose(a[1:], b[1:], atol=1e-13 / CELL)
