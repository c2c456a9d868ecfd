"""The study's figures: which panel shows which run at which time, at which scale."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import synthetic_run as synthetic
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread

from gimpslope.figures import displacement_bars_by_run, kinetic_energies, study
from gimpslope.figures.panels import tag
from gimpslope.run import Run

PAPER = {
    "A soil": {"time_of_peak": 1.6, "max_displacement_total": 9.3},
    "B arbitrary": {"time_of_peak": 2.0},
}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Run]:
    """One that ended at 4 s and one killed at 1 s, while it was still getting faster."""
    folder = tmp_path_factory.mktemp("runs")
    return {
        "A soil": synthetic.write_run(folder / "a.h5"),
        "B arbitrary": synthetic.write_run(folder / "b.h5", until=1.0, finished=False),
    }


def titles(figure: Figure) -> list[str]:
    return [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]


def words(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts]


def test_panels_say_run_and_time(runs: dict[str, Run]) -> None:
    assert titles(study.speed(runs)) == [
        "A1   0.50 s",
        "A2   2.00 s (peak at 2.00 s)",
        "A3   3.50 s",
        "B1   0.50 s",
        "B2   1.00 s (energy still grows)",
        "B3   3.50 s",
    ]


def test_panels_of_times_that_are_not_reached_say_so(runs: dict[str, Run]) -> None:
    panels = study.speed(runs).axes
    assert words(panels[5]) == ["not reached:\nthe last snapshot is at 1.00 s"]
    assert len(panels[5].collections) == 0 and len(panels[4].collections) > 0
    assert not any(words(ax) for ax in panels[:5])


def test_panels_share_their_colours_and_metres(runs: dict[str, Run]) -> None:
    figure = study.speed(runs)
    largest = synthetic.SHARE.max() * np.sqrt(5)  # of the peak of A
    for ax in figure.axes[:5]:
        assert ax.collections[1].get_clim() == pytest.approx((0.0, largest))
    assert figure.axes[6].get_xlabel() == "speed (m/s)"
    figure.draw_without_rendering()
    boxes = [ax.get_window_extent() for ax in figure.axes[:6]]
    scales = [
        box.width / np.ptp(ax.get_xlim()) for ax, box in zip(figure.axes, boxes, strict=False)
    ]
    np.testing.assert_allclose(scales, scales[0], rtol=0.01)
    assert boxes[0].width < boxes[1].width < boxes[2].width
    assert boxes[0].x0 == pytest.approx(boxes[3].x0)


def test_plastic_zone_and_displacement(runs: dict[str, Run]) -> None:
    assert titles(study.plastic_zone(runs))[::3] == ["A1   1.00 s", "B1   1.00 s"]
    figure = study.displacement(runs)
    assert titles(figure) == ["A1   4.00 s", "A2   4.00 s", "B1   1.00 s", "B2   1.00 s"]
    moved = np.linalg.norm(synthetic.displacement(synthetic.END), axis=1)
    np.testing.assert_allclose(figure.axes[0].collections[1].get_array(), moved)
    assert [ax.get_xlabel() for ax in figure.axes[4:]] == ["displacement (m)"]
    assert figure.axes[1].get_legend() is not None


def test_initial_slopes_are_the_points_and_stones_of_the_scene(runs: dict[str, Run]) -> None:
    three = runs | {"C round": runs["A soil"]}
    figure = study.initial_slopes(three)
    count = len(synthetic.POINTS)
    assert figure.axes[2].get_title() == f"C round: {count} points, 1 stone"
    assert not figure.axes[3].axison
    squares = figure.axes[0].collections[1].get_paths()
    centres = np.array([path.vertices[:4].mean(axis=0) for path in squares])
    np.testing.assert_allclose(centres, synthetic.POINTS.position)


def test_kinetic_energy_of_all(runs: dict[str, Run]) -> None:
    figure = study.kinetic_energy(runs, PAPER)
    whole, close = figure.axes
    assert whole.get_xlim()[1] >= synthetic.END and close.get_xlim() == (0.0, 5.0)
    marks = [line.get_xdata()[0] for line in close.lines if line.get_marker() == "^"]
    assert marks == [1.6, 2.0]
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts == ["A soil", "B arbitrary", "peak", "time of the paper's peak"]


def test_kinetic_energies_draws_into_the_axes_it_is_given(runs: dict[str, Run]) -> None:
    ax = Figure().add_subplot()
    energies = {name: run.energy for name, run in runs.items()}
    assert kinetic_energies(energies, ax, until=2.5) is ax
    np.testing.assert_allclose(ax.lines[0].get_ydata(), energies["A soil"].kinetic / 1e3)
    assert ax.get_xlim() == (0.0, 2.5)
    with pytest.raises(ValueError, match=r"until must be a finite number > 0, got 0"):
        kinetic_energies(energies, ax, until=0.0)


def test_bars_stand_beside_the_paper_where_it_has_values(runs: dict[str, Run]) -> None:
    ax = Figure().add_subplot()
    assert displacement_bars_by_run(runs, PAPER, ax) is ax
    (total, *rest), killed = (run.max_displacement() for run in runs.values())
    heights = [bar.get_height() for bar in ax.patches]
    np.testing.assert_allclose(heights, [total, 9.3, *rest, *killed])
    assert [bar.get_hatch() for bar in ax.patches].count("////") == 1
    centres = [bar.get_x() + bar.get_width() / 2 for bar in ax.patches]
    assert np.mean(centres[:4]) == pytest.approx(0) and np.mean(centres[4:]) == pytest.approx(1)
    assert [label.get_text() for label in ax.get_xticklabels()] == list(runs)


def test_all_figures_by_their_numbers(runs: dict[str, Run], tmp_path: Path) -> None:
    made = study.figures(runs, PAPER)
    assert list(made) == [3, 4, 5, 6, 7, 8]
    for number, figure in made.items():
        assert figure.get_figwidth() == 10.0
        figure.savefig(tmp_path / f"{number}.png", dpi=50)
        assert imread(tmp_path / f"{number}.png").shape[1] == 500


def test_one_run_is_enough(runs: dict[str, Run]) -> None:
    made = study.figures({"soil": runs["A soil"]})
    for figure in made.values():
        figure.draw_without_rendering()
    assert len(made) == 6
    assert titles(study.speed({"soil": runs["A soil"]}))[0] == "soil 1   0.50 s"


def test_values_of_the_paper_for_another_run_are_refused(runs: dict[str, Run]) -> None:
    for draw in (study.kinetic_energy, study.displacement_bars):
        with pytest.raises(ValueError, match=r"names of the runs, 'A soil', .*got 'soil'"):
            draw(runs, {"soil": {"time_of_peak": 1.6}})


@pytest.mark.parametrize(
    "draw",
    [
        study.initial_slopes,
        study.kinetic_energy,
        study.speed,
        study.plastic_zone,
        study.displacement,
        study.displacement_bars,
    ],
)
def test_no_run_is_refused(draw: Callable[[dict[str, Run]], Figure]) -> None:
    with pytest.raises(ValueError, match="at least one run, got none"):
        draw({})


def test_a_run_before_its_slide(runs: dict[str, Run], tmp_path: Path) -> None:
    both = {"A": runs["A soil"], "B": Run(synthetic.new_writer(tmp_path / "new.h5").path)}
    panels = study.speed(both).axes
    assert words(panels[4]) == ["not reached:\nthere is no snapshot"]
    assert panels[4].get_title(loc="left") == "B2   peak"
    assert len(study.kinetic_energy(both).axes[0].lines) == 3
    with pytest.raises(ValueError, match=r"must have snapshots.*new\.h5"):
        study.displacement_bars(both)


@pytest.mark.parametrize(
    ("name", "called"), [("A soil", "A2"), ("A", "A2"), ("soil", "soil 2"), ("", "2")]
)
def test_panels_are_called_by_the_first_word(name: str, called: str) -> None:
    assert tag(name, 2).strip() == called


def test_times_of_the_paper_are_marked_within_the_axes(runs: dict[str, Run]) -> None:
    """Also where a run ends before them; beyond a given end they are left out."""
    short = {"B arbitrary": runs["B arbitrary"].energy}
    paper = {"B arbitrary": {"time_of_peak": 2.0}}
    whole = kinetic_energies(short, reference=paper)
    marks = [line for line in whole.lines if line.get_marker() == "^"]
    assert [mark.get_xdata()[0] for mark in marks] == [2.0]
    assert whole.get_xlim()[1] >= 2.0
    close = kinetic_energies(short, until=1.5, reference=paper)
    assert not [line for line in close.lines if line.get_marker() == "^"]
    assert close.get_xlim()[1] == 1.5
