"""What is said of slopes on several grids, from values whose order, limit and errors are known."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from made_convergence import CELLS, power, series, study
from matplotlib.colors import to_hex

from gimpslope.studies.converge import figures, output, tables
from gimpslope.studies.converge.limits import meet, reference
from gimpslope.studies.richardson import Extrapolation

FIRST, SECOND = power(10.0, 5.0, 1.0), power(10.0, -20.0, 2.0)
DIVERGES = [1.0, 2.0, 4.0]


def limit(value: float, uncertainty: float) -> Extrapolation:
    return Extrapolation((1.0,), value, uncertainty, "converges")


def rows(page: str, start: str) -> list[list[str]]:
    """Cells of the lines of a table whose first cell is this."""
    lines = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("|")]
    return [cells for cells in lines if cells[0] == start]


def test_order_limit_and_errors_of_a_power_law() -> None:
    made = study(softened=series(FIRST))
    found = made.series["softened"].limit("total")
    assert found is not None and found.orders == pytest.approx((1.0,))
    assert found.limit == pytest.approx(10.0) and found.uncertainty == pytest.approx(1.25 * 0.5)
    errors = made.errors("total", "softened")
    assert errors is not None and errors.values == pytest.approx([0.2, 0.1, 0.05])
    assert errors.known_to == pytest.approx(0.0625)


def test_limits_are_of_the_means_over_draws() -> None:
    apart = [value + 1 for value in FIRST], [value - 1 for value in FIRST]
    found = series(*apart).limit("total")
    assert found is not None and found.limit == pytest.approx(10.0)


def test_limits_that_agree_share_the_surest() -> None:
    """That of second order is known to 0.083, that of first order to 0.63."""
    made = study(softened=series(FIRST), rigid=series([value + 0.1 for value in SECOND]))
    softened, rigid = (made.errors("total", model) for model in ("softened", "rigid"))
    assert softened is not None and softened.against.model == "rigid"
    assert rigid is not None and rigid.against.model == "rigid"
    assert softened.values[0] == pytest.approx(12.0 / 10.1 - 1)
    (row,) = rows(tables.markdown(made), "largest displacement, m")[2:]
    assert row[1:3] == ["softened 10.000 ± 0.62", "rigid 10.100 ± 0.25"]
    assert row[3:] == ["0.100", "0.67", "yes"]
    first, second = rows(tables.markdown(made), "largest displacement, m")[:2]
    assert first[2:] == [
        *("12.000", "11.000", "10.500", "1.0", "10.000 ± 0.62", "converges"),
        "19, 8.9, 4 (of the limit of rigid)",
    ]
    assert second[-4:] == ["2.0", "10.100 ± 0.25", "converges", "32, 7.9, 2"]


def test_limits_that_do_not_agree_stand_alone() -> None:
    made = study(softened=series(FIRST), rigid=series([value + 5 for value in SECOND]))
    for model, value in (("softened", 10.0), ("rigid", 15.0)):
        errors = made.errors("total", model)
        assert errors is not None and errors.against.model == model
        assert errors.against.limit == pytest.approx(value)
    assert rows(tables.markdown(made), "largest displacement, m")[2][3:] == [
        *("5.000", "0.67", "**no**")
    ]


def test_without_a_limit_of_its_own_errors_are_of_the_other() -> None:
    made = study(softened=series(DIVERGES), rigid=series(FIRST))
    errors = made.errors("total", "softened")
    assert errors is not None and errors.against.model == "rigid"
    assert errors.values == pytest.approx([0.9, 0.8, 0.6])
    page = tables.markdown(made)
    assert rows(page, "largest displacement, m")[0][-3:] == [
        *("none", "diverges", "90, 80, 60 (of the limit of rigid)")
    ]
    assert rows(page, "largest displacement, m")[2][1:] == [
        *("softened none", "rigid 10.000 ± 0.62", "-", "-", "cannot tell")
    ]


def test_no_limit_at_all() -> None:
    made = study(softened=series(DIVERGES), rigid=series(DIVERGES))
    assert made.errors("total", "softened") is None
    page = rows(tables.markdown(made), "largest displacement, m")
    assert [row[-1] for row in page] == ["-", "-", "cannot tell"]


def test_uncertainties_add_up_as_independent_ones() -> None:
    assert meet(limit(0.0, 3.0), limit(5.0, 4.0))
    assert not meet(limit(0.0, 3.0), limit(5.01, 4.0))
    assert reference("rigid", {}) is None


def test_a_figure_that_is_not_reached() -> None:
    """On the finest grid it leaves no limit, on the coarsest of four the others decide."""
    nan = math.nan
    made = study(rigid=series([*FIRST[:2], nan], [*FIRST[:2], 10.5]))
    assert made.series["rigid"].limit("total") is None
    (row,) = rows(tables.markdown(made), "largest displacement, m")
    assert row[4:] == ["not reached", "-", "-", "too few grids", "-"]


def test_draws_spread_and_missing_runs() -> None:
    both = [value + 1 for value in FIRST], [*(value - 1 for value in FIRST[:2]), None]
    made = study(missing=["oval.h5: not run yet"], rigid=series(*both))
    page = tables.markdown(made)
    assert "Missing: oval.h5: not run yet." in page
    (row,) = rows(page, "largest displacement, m")
    assert row[2:5] == ["12.000 ± 1.414", "11.000 ± 1.414", "missing"]
    assert rows(page, "core-seconds, rigid")[0][1:] == ["1.0, 1.0", "8.0, 8.0", "64.0, missing"]
    assert rows(page, "smallest gap between stones, cells")[0][-1] == "1.00, missing"


def test_a_model_whose_finest_run_is_missing_has_the_limit_of_the_others() -> None:
    made = series(FIRST)
    finer = type(made)((*made.grids, (None,)))
    found = finer.limit("total")
    assert found is not None and found.limit == pytest.approx(10.0)
    assert finer.off_finest()[:, 0] == pytest.approx([1.5, 0.5, 0.0, math.nan], nan_ok=True)


def test_surfaces_between_models() -> None:
    made = study(softened=series(FIRST, FIRST), rigid=series(SECOND, SECOND))
    page = tables.markdown(made)
    (row,) = rows(page, "softened to rigid")
    assert row[1:] == ["5.200 ± 0.000", "1.800 ± 0.000", "0.700 ± 0.000"]
    (row,) = rows(page, "softened, to that of the finest grid")
    assert row[1:] == ["1.500 ± 0.000", "0.500 ± 0.000", "0.000 ± 0.000"]


def test_errors_against_core_seconds_are_drawn() -> None:
    made = figures.costs(study(softened=series(FIRST), rigid=series(DIVERGES)))
    assert [ax.get_title() for ax in made.axes] == [
        "peak kinetic energy",
        "time of peak kinetic energy",
        "largest displacement",
        "run-out of 99 % of the mass",
    ]
    assert {ax.get_xlabel() for ax in made.axes} == {"core-seconds (processor)"}
    ax = made.axes[2]
    assert ax.get_xscale() == ax.get_yscale() == "log"
    lines = {line.get_label(): line for line in ax.lines if line.get_label()[0] != "_"}
    assert lines["softened"].get_xdata() == pytest.approx([1.0, 8.0, 64.0])
    assert lines["softened"].get_ydata() == pytest.approx([20.0, 10.0, 5.0])
    assert lines["rigid"].get_ydata() == pytest.approx([90.0, 80.0, 60.0])
    assert to_hex(lines["softened"].get_color()) != to_hex(lines["rigid"].get_color())
    (known,) = [line for line in ax.lines if line.get_linestyle() == ":"]
    assert set(known.get_ydata()) == {6.25}
    (legend,) = made.legends
    assert [text.get_text() for text in legend.texts] == [
        *("softened", "rigid", "h = 0.4 m", "h = 0.2 m", "h = 0.1 m", "uncertainty of the limit")
    ]


def test_nothing_to_draw_is_said() -> None:
    made = figures.costs(study(rigid=series(DIVERGES)))
    assert [ax.texts[0].get_text() for ax in made.axes] == ["no limit"] * 4


def test_values_and_limits_are_drawn() -> None:
    made = figures.values(study(softened=series(FIRST, FIRST), rigid=series(DIVERGES, DIVERGES)))
    ax = made.axes[0]
    (bar,) = ax.containers
    assert bar.get_label() == "softened, limit"
    (place,), (value,) = bar.lines[0].get_data()
    assert place < 0 and value == pytest.approx(10.0)
    low, high = ax.get_ylim()
    assert low < 1.0 and high > 12.0
    (legend,) = made.legends
    assert [text.get_text() for text in legend.texts] == ["softened", "rigid", "softened, limit"]


def test_a_limit_that_is_hardly_known_does_not_flatten_the_rest() -> None:
    """Of a low order the uncertainty is three times the spread, 1.9; results and limit span 2.8."""
    made = figures.values(study(rigid=series([10.0, 11.0, 11.9])))
    (bar,) = made.axes[0].containers
    (_, low), (_, high) = bar.lines[2][0].get_segments()[0]
    assert high - low == pytest.approx(2 * 3 * 1.9)
    assert np.ptp(made.axes[0].get_ylim()) == pytest.approx(3 * 2.8 + 2 * 0.05 * 2.8)


def test_numbers_as_json(tmp_path: Path) -> None:
    made = study(softened=series(FIRST), rigid=series(SECOND))
    output.write([made], tmp_path)
    (plain,) = json.loads((tmp_path / "convergence.json").read_text())
    total = plain["models"]["softened"]["quantities"]["total"]
    assert total["values"] == [[value] for value in FIRST]
    assert total["errors_against"]["model"] == "rigid"
    assert plain["limits_agree"]["total"] == {"softened, rigid": True}
    assert plain["surfaces_apart"]["softened, rigid"][2] == [pytest.approx(0.7)]
    assert plain["cells"] == list(CELLS)
