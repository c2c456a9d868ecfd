"""Figures show what the run holds; they are drawn without a display."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import synthetic_run as synthetic
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.image import imread

from gimpslope import figures
from gimpslope.figures.quantity import SPEED
from gimpslope.figures.single import moments
from gimpslope.run import Run

REFERENCE = {
    "time_of_peak": 1.6,
    "max_displacement_total": 9.3,
    "max_displacement_horizontal": 8.9,
    "max_displacement_vertical": 5.4,
}
NAMES = ["kinetic_energy", "speed", "plastic_zone", "displacement", "displacement_bars"]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return synthetic.write_run(tmp_path_factory.mktemp("run") / "run.h5")


@pytest.fixture
def ax() -> Axes:
    return Figure().add_subplot()


def squares(ax: Axes) -> PolyCollection:
    """The points as they are drawn over what fills gaps between them."""
    found = ax.collections[1]
    assert isinstance(found, PolyCollection)
    return found


def test_kinetic_energy_marks_both_peaks(run: Run, ax: Axes) -> None:
    assert figures.kinetic_energy(run.energy, ax, reference=REFERENCE) is ax
    curve = ax.lines[0]
    np.testing.assert_allclose(curve.get_ydata(), run.energy.kinetic / 1e3)
    labels = ax.get_legend_handles_labels()[1]
    assert "at 2.00 s" in labels[0] and "1.6 s" in labels[1]


def test_each_point_is_a_square_of_its_volume(run: Run, ax: Axes) -> None:
    run.plot_speed(1.0, ax)
    state = run.snapshot(1.0)
    corners = np.array([path.vertices[:4] for path in squares(ax).get_paths()])
    np.testing.assert_allclose(corners.mean(axis=1), state.position)
    np.testing.assert_allclose(np.prod(np.ptp(corners, axis=1), axis=1), state.volume)
    np.testing.assert_allclose(squares(ax).get_array(), state.speed)
    assert ax.get_aspect() == 1.0
    low, high = ax.get_xlim()
    assert low < 0 and high > state.position[:, 0].max()


def test_what_fills_gaps_stays_within_the_slope(run: Run, ax: Axes) -> None:
    """Three times as wide as a point, but never beyond the box of all points, where walls are."""
    run.plot_speed(1.0, ax)
    below, above = (
        np.array([path.vertices[:4] for path in collection.get_paths()])
        for collection in ax.collections[:2]
    )
    low, high = above.min(axis=(0, 1)), above.max(axis=(0, 1))
    inside = ((above > low + 0.2) & (above < high - 0.2)).all(axis=(1, 2))
    assert inside.sum() > 100
    np.testing.assert_allclose(np.ptp(below[inside], axis=1), 3 * np.ptp(above[inside], axis=1))
    assert (below >= low).all() and (below <= high).all()


def test_maps_have_a_labelled_colour_bar(run: Run) -> None:
    for draw, label in (
        (run.plot_speed, "speed (m/s)"),
        (run.plot_plastic_zone, "plastic strain"),
        (run.plot_displacement, "displacement (m)"),
    ):
        figure = Figure()
        ax = draw(1.0, figure.add_subplot())
        assert ax.get_title() == "1.00 s"
        assert label in figure.axes[1].get_ylabel()


def test_plastic_strain_is_drawn_for_soil_only(run: Run, ax: Axes) -> None:
    run.plot_plastic_zone(1.0, ax)
    values = squares(ax).get_array()
    np.testing.assert_array_equal(np.ma.getmaskarray(values), synthetic.POINTS.material == 1)


def test_stones_have_edges_and_shades_of_their_own(run: Run, ax: Axes) -> None:
    assert run.plot_shape(1.0, ax) is ax
    (edge,) = ax.collections[2].get_paths()
    np.testing.assert_allclose(edge.vertices[:-1], run.stone_outlines(1.0)[0], atol=1e-9)
    shades = squares(ax).get_array()
    np.testing.assert_array_equal(np.ma.getmaskarray(shades), synthetic.POINTS.stone < 0)
    texts = [text.get_text() for text in ax.get_legend().get_texts()]
    assert texts == ["soil", "stone", "outline at the start"]


def test_the_moment_of_the_peak(run: Run, ax: Axes) -> None:
    assert run.plot_speed("peak", ax).get_title() == "2.00 s"


def test_surface_with_its_roughness(run: Run, ax: Axes) -> None:
    assert run.plot_surface(0.0, ax) is ax
    np.testing.assert_allclose(ax.lines[0].get_xydata()[:, 1], run.surface(0.0).y)
    rough = 100 * run.surface(0.0).roughness()
    assert ax.get_legend().get_texts()[0].get_text() == f"roughness {rough:.2g} cm"


def test_a_map_of_any_values(run: Run, ax: Axes) -> None:
    state = run.snapshot(1.0)
    drawn = figures.map_of(state.density, state, ax, label="density (kg/m3)", cmap="cividis")
    assert drawn is ax
    assert squares(ax).norm.vmax == pytest.approx(state.density.max())


def test_displacement_bars_stand_beside_the_paper(run: Run, ax: Axes) -> None:
    figures.displacement_bars({"soil": run}, REFERENCE, ax)
    heights = [bar.get_height() for bar in ax.patches]
    np.testing.assert_allclose(heights, [*run.max_displacement(), 9.3, 8.9, 5.4])
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["soil", "the paper"]


@pytest.mark.parametrize(
    ("paper", "beside"),
    [({"time_of_peak": 1.5}, [0, 0, 0]), ({"max_displacement_total": 8.7}, [1, 0, 0])],
)
def test_bars_are_about_their_names_and_in_the_legend_if_drawn(
    run: Run, ax: Axes, paper: dict[str, float], beside: list[int]
) -> None:
    figures.displacement_bars({"B": run}, paper, ax)
    for tick, others in enumerate(beside):
        sides = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in ax.patches]
        about = [side for side in sides if abs(np.mean(side) - tick) < 0.5]
        assert len(about) == 1 + others and np.mean(about) == pytest.approx(tick)
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == (["B", "the paper"] if any(beside) else ["B"])


def test_panels_share_their_scales(run: Run) -> None:
    figure = moments(run, SPEED, figures.SPEED_TIMES)
    panels = figure.axes[:3]
    assert len({ax.get_xlim() for ax in panels}) == 1
    for ax in panels:
        assert squares(ax).get_clim() == pytest.approx((0.0, run.snapshot(2.0).speed.max()))
    assert "2.00 s" in panels[1].get_title()


def test_write_figures(run: Run, tmp_path: Path) -> None:
    paths = figures.write_figures(run, tmp_path / "new" / "figures", REFERENCE)
    assert [path.stem for path in paths] == NAMES
    for path in paths:
        height, width = imread(path).shape[:2]
        assert width > 900 and height > 500


def test_panels_after_the_end_say_so(tmp_path: Path) -> None:
    run = synthetic.write_run(tmp_path / "short.h5", until=1.0, finished=False)
    figure = moments(run, SPEED, figures.SPEED_TIMES)
    titles = [ax.get_title() for ax in figure.axes[:3]]
    assert titles[0] == "0.50 s"
    assert titles[2] == "3.50 s: not reached, the last snapshot is at 1.00 s"
    assert len(figures.write_figures(run, tmp_path)) == len(NAMES)


def test_a_run_without_a_slide_is_refused(tmp_path: Path) -> None:
    run = Run(synthetic.new_writer(tmp_path / "run.h5").path)
    with pytest.raises(ValueError, match=r"run.h5"):
        figures.write_figures(run, tmp_path)


def test_axes_are_made_when_none_are_given(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MPLBACKEND", "Agg")
    ax = run.plot_energy()
    assert ax.get_xlabel() == "time since the trigger (s)"
    from matplotlib import pyplot

    pyplot.close("all")


def test_maps_share_a_scale_when_told(run: Run, ax: Axes) -> None:
    run.plot_speed(1.0, ax, largest=7.5)
    assert squares(ax).norm.vmax == 7.5
    for refused in (float("nan"), -1.0):
        with pytest.raises(ValueError, match=r"largest must be a finite number > 0, got"):
            run.plot_speed(1.0, ax, largest=refused)
