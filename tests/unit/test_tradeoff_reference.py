"""What the slope with a stone is held against: limits of the full model, stones of 20 GPa, and of
those that agree with them the surest."""

from __future__ import annotations

import pytest

from gimpslope import Method
from gimpslope.studies.converge.limits import meet, reference
from gimpslope.studies.richardson import Extrapolation, extrapolate
from gimpslope.studies.tradeoff import problems, slopes

CELLS = (0.2, 0.1, 0.05)

pytestmark = pytest.mark.slow


def limits(model: str, method: Method) -> list[Extrapolation]:
    slides = [slopes.with_stone(cell, method, model).figures for cell in CELLS]
    return [extrapolate(values) for values in zip(*slides, strict=True)]


def test_limits_of_the_slope_with_a_stone() -> None:
    method = Method(viscosity=slopes.VISCOSITY, courant=0.8, volumetric_strain="point")
    cured = Method(viscosity=slopes.VISCOSITY, courant=0.8, volumetric_strain="cell_average")
    known = zip(problems.WITH_STONE, problems.UNCERTAINTY_WITH_STONE, strict=True)
    found = zip(limits("deformable", method), limits("rigid", cured), strict=True)
    models = ("rigid", "full", "rigid")  # of whose grids peak, time and displacement are surer
    for (full, rigid), (limit, uncertainty), model in zip(found, known, models, strict=True):
        assert meet(full, rigid)
        surest = reference("full", {"full": full, "rigid": rigid})
        assert surest is not None and surest.model == model
        assert surest.limit == pytest.approx(limit, rel=1e-3)
        assert surest.uncertainty == pytest.approx(uncertainty, rel=2e-2)
