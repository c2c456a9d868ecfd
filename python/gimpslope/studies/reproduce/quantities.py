"""The figures of a run that stand on the page, beside those of the paper."""

from __future__ import annotations

import math
from typing import NamedTuple

from .. import reference
from .measures import RUN_OUT


class Quantity(NamedTuple):
    """A figure as the page shows it.

    Attributes
    ----------
    figure : its name in `Measures`
    title, unit : in words
    digits : behind the point
    published : its name in `reference.PAPER`, None where the paper gives none
    counted : whether it is a count, which has no limit as the cell shrinks
    """

    figure: str
    title: str
    unit: str
    digits: int
    published: str | None = None
    counted: bool = False

    @property
    def label(self) -> str:
        """Title and unit."""
        return f"{self.title}, {self.unit}" if self.unit else self.title

    def paper(self, slope: str) -> float:
        """The paper's value for a slope; NaN where it gives none."""
        return reference.PAPER[slope].get(self.published or "", math.nan)

    @property
    def is_bound(self) -> bool:
        """Whether the paper gives what the figure exceeds."""
        return self.published in reference.LOWER_BOUNDS

    def shown(self, value: float) -> str:
        """A value in words."""
        return "not reached" if math.isnan(value) else f"{value:.{self.digits}f}"

    def shown_paper(self, slope: str) -> str:
        """The paper's value for a slope in words."""
        paper = self.paper(slope)
        return "-" if math.isnan(paper) else reference.published(self.published or "", paper)


QUANTITIES = (
    Quantity("peak_time", "time of peak kinetic energy", "s", 2, "time_of_peak"),
    Quantity("peak_energy", "peak kinetic energy", "kJ/m", 1),
    Quantity("peak_speed", "fastest point at the peak", "m/s", 2, "speed_at_peak"),
    Quantity("rest_time", "at rest after", "s", 2),
    Quantity("total", "largest displacement", "m", 2, "max_displacement_total"),
    Quantity(
        "horizontal", "largest horizontal displacement", "m", 2, "max_displacement_horizontal"
    ),
    Quantity("vertical", "largest vertical displacement", "m", 2, "max_displacement_vertical"),
    Quantity("run_out", f"run-out of {RUN_OUT:g} % of the mass", "m", 2),
    Quantity("plastic_soil", "share of the soil that is plastic", "", 3),
    Quantity("peak_bands", "plastic bands at the peak", "", 0, counted=True),
    Quantity("roughness", "roughness of the surface", "mm", 0),
)
