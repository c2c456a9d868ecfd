"""Surfaces of known profile and roughness."""

import numpy as np
import pytest
from made_snapshot import made

from gimpslope.analysis import Surface, surface_of

WIDTH = 0.1
X = (np.arange(240) + 0.5) * WIDTH


def under(height, x=X):
    """Columns of points whose tops, half a point above the highest, are at a height."""
    tops = np.column_stack([x, height - 0.05])
    below = [tops - (0, depth) for depth in (0.1, 0.2, 0.35)]
    return made(np.concatenate([*below, tops]))


def test_the_surface_is_the_top_of_the_highest_domain():
    height = 3 + np.cos(X)
    surface = surface_of(under(height), WIDTH)
    np.testing.assert_allclose(surface.x, X)
    np.testing.assert_allclose(surface.y, height)


def test_domains_grow_with_their_volume():
    four_times = made([(0.05, 1.0)], volume=np.array([0.04]))
    assert surface_of(four_times, WIDTH).y == pytest.approx([1.1])


def test_columns_begin_where_they_are_told():
    points = made([(-0.26, 0.0), (0.31, 1.0), (0.33, 3.0)])
    surface = surface_of(points, 0.2, left=0.1)
    np.testing.assert_allclose(surface.x, (-0.2, 0.0, 0.2, 0.4))
    np.testing.assert_allclose(surface.y, (0.05, np.nan, np.nan, 3.05))


@pytest.mark.parametrize("length", [0.4, 1.0, 2.0])
def test_a_parabola_is_smooth(length):
    surface = Surface(WIDTH, X, 9 - 0.7 * X + 0.03 * X**2)
    assert surface.roughness(length) < 1e-12


@pytest.mark.parametrize("wave", [0.6, 1.2, 2.4, 8.0])
def test_roughness_of_a_wave(wave):
    """The response of the moving parabola to a wave follows from the coefficients that Savitzky and
    Golay (1964) give in closed form; of what it leaves, the root mean square over whole periods is
    the amplitude over the root of two."""
    amplitude, half = 0.08, 10
    place = np.arange(-half, half + 1)
    numerator = 3 * (3 * half**2 + 3 * half - 1 - 5 * place**2)
    weights = numerator / ((2 * half - 1) * (2 * half + 1) * (2 * half + 3))
    left = 1 - np.sum(weights * np.cos(2 * np.pi * place * WIDTH / wave))
    x = (np.arange(240 + 2 * half) + 0.5) * WIDTH  # 24 m, whole periods, have both sides
    surface = Surface(WIDTH, x, 5 - x / 3 + amplitude * np.sin(2 * np.pi * x / wave))
    assert surface.roughness(2.0) == pytest.approx(amplitude * abs(left) / np.sqrt(2))


def test_waves_shorter_than_the_length_count_and_longer_ones_hardly():
    def roughness(wave):
        return Surface(WIDTH, X, 0.1 * np.sin(2 * np.pi * X / wave)).roughness(2.0)

    assert roughness(1.0) == pytest.approx(0.1 / np.sqrt(2), rel=0.25)
    assert roughness(12.0) < 0.001


def test_a_gap_does_not_count():
    height = 4 - 0.2 * X
    height[100:103] = np.nan
    assert Surface(WIDTH, X, height).roughness() < 1e-12
    step = np.repeat([0.0, 1.0], [101, 139])
    assert Surface(WIDTH, X, step).roughness() > 0.05
    assert Surface(WIDTH, X, step + 0 * height).roughness() < 1e-12


def test_a_part_of_the_surface():
    height = np.where(X < 4, 0.5 * (-1.0) ** np.arange(240), 4 - 0.2 * X)
    surface = Surface(WIDTH, X, height)
    flank = surface.between(4.05, 20.0)
    np.testing.assert_allclose(flank.x[[0, -1]], (4.05, 19.95))
    assert surface.roughness() > 0.1 and flank.roughness() < 1e-12
    with pytest.raises(ValueError, match=r"column between them, got 30 and 40 m"):
        surface.between(30, 40)


def test_length_and_width_are_refused():
    surface = Surface(WIDTH, X, 0 * X)
    with pytest.raises(ValueError, match=r"length must be at least four columns, 0\.4 m, got 0\.3"):
        surface.roughness(0.3)
    with pytest.raises(ValueError, match=r"length must fit .*got 30 m .*0\.05 to 23\.95 m"):
        surface.roughness(30.0)
    with pytest.raises(ValueError, match=r"width must be a finite number > 0, got 0"):
        surface_of(under(X), 0.0)
    with pytest.raises(ValueError, match=r"length must fit"):
        surface_of(made([(0.05, 1.0)]), WIDTH).roughness()
