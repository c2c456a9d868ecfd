"""The figures of a run that the paper's claims are about."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...analysis import ROUGHNESS_LENGTH, mass_percentile
from ...run import Run
from ...snapshot import Snapshot

EARLY, LATE, PLASTIC_EARLY, PLASTIC_LATE = 0.5, 3.5, 1.0, 5.0
"""Times of the paper's maps of speed and of the plastic zone, beside that of the peak, s."""

_FAST = 1.0  # m/s
_FRONT = 75.0  # % of the mass behind it
_FAR, _FARTHER = 2.0, 4.0  # m
_BOTTOM = 2.0  # m
_STUCK = 1.0  # m from the left side
_COLUMNS = 4


@dataclass(frozen=True)
class Measures:
    """Figures of one run; NaN for what it has not reached.

    Attributes
    ----------
    mass : of soil and stones, t/m
    peak_energy : kinetic, kJ/m
    peak_time, rest_time : when kinetic energy is largest, and from when it stays below 1 % of that,
        s since the trigger
    early_speed, peak_speed, late_speed : of the fastest point at 0.5 s, the peak and 3.5 s, m/s
    fast_share : share of the mass that moves by 1 m/s or more at the peak
    late_front : share of the mass faster than 1 m/s at 3.5 s that is in the front quarter of the
        slope's mass
    early_bands, peak_bands, late_bands : connected plastic regions of the soil at 1 s, the peak and
        5 s
    early_islands, peak_islands, late_islands : what these enclose on all sides
    plastic_soil, plastic_stone : share of the mass with more than 1 % of plastic strain in the end
    bottom_intact : share of the soil that lay in the lowest 2 m and has no such strain in the end
    total, horizontal, vertical : largest displacements in the end, m
    near_share : share of the mass that has moved by less than 2 m in the end
    far_front : share of the mass moved by more than 4 m that ends in the front quarter
    run_out : how far the toe has moved in the end, 99 % of the mass, m
    roughness : of the surface in the end from 1 m beside the left side on, mm
    """

    mass: float
    peak_energy: float
    peak_time: float
    rest_time: float
    early_speed: float
    peak_speed: float
    late_speed: float
    fast_share: float
    late_front: float
    early_bands: float
    peak_bands: float
    late_bands: float
    early_islands: float
    peak_islands: float
    late_islands: float
    plastic_soil: float
    plastic_stone: float
    bottom_intact: float
    total: float
    horizontal: float
    vertical: float
    near_share: float
    far_front: float
    run_out: float
    roughness: float

    @property
    def deceleration(self) -> float:
        """From the peak to rest, s."""
        return self.rest_time - self.peak_time

    @property
    def stone_over_soil(self) -> float:
        """The plastic share of the stones over that of the soil."""
        return self.plastic_stone / self.plastic_soil

    @property
    def sideways(self) -> float:
        """The largest horizontal displacement as a share of the largest in all."""
        return self.horizontal / self.total

    def to_dict(self) -> dict[str, float]:
        """By the names in `FIGURES`."""
        return {name: getattr(self, name) for name in FIGURES}


FIGURES = (
    *(field.name for field in fields(Measures)),
    "deceleration",
    "stone_over_soil",
    "sideways",
)
"""All that is measured."""


def measure(run: Run) -> Measures:
    """The figures of a run that has come to its end."""
    end, peak, phases = run.final, run.state("peak"), run.phases()
    late, plastic = _reached(run, LATE), run.plastic_share()
    mass, start = run.points.mass, run.points.position
    moved = np.linalg.norm(end.displacement, axis=1)
    bottom = (run.points.stone < 0) & (start[:, 1] < _BOTTOM)
    largest = run.max_displacement()
    return Measures(
        mass=mass.sum() / 1e3,
        peak_energy=run.energy.peak.value / 1e3,
        peak_time=run.energy.peak.time,
        rest_time=_or_nan(phases.rest),
        early_speed=_fastest(_reached(run, EARLY)),
        peak_speed=run.energy.speed_at_peak,
        late_speed=_fastest(late),
        fast_share=_share(peak.speed >= _FAST, peak),
        late_front=np.nan if late is None else _in_front(late, late.speed > _FAST),
        **_bands(run, early=PLASTIC_EARLY, peak=run.energy.peak.time, late=PLASTIC_LATE),
        plastic_soil=_or_nan(plastic.soil),
        plastic_stone=_or_nan(plastic.stone),
        bottom_intact=float(np.average(~run.plastic_zone()[bottom], weights=mass[bottom])),
        total=largest.total,
        horizontal=largest.horizontal,
        vertical=largest.vertical,
        near_share=_share(moved < _FAR, end),
        far_front=_in_front(end, moved > _FARTHER),
        run_out=run.run_out(percentile=99.0),
        roughness=_roughness(run),
    )


def _reached(run: Run, time: float) -> Snapshot | None:
    return run.snapshot(time) if len(run.times) and time <= run.times[-1] else None


def _fastest(state: Snapshot | None) -> float:
    return np.nan if state is None else float(state.speed.max())


def _bands(run: Run, **moments: float) -> dict[str, float]:
    """Bands and islands by the names of their moments."""
    found: dict[str, float] = {}
    for name, time in moments.items():
        bands = None if _reached(run, time) is None else run.plastic_bands(time)
        found[f"{name}_bands"] = np.nan if bands is None else float(len(bands))
        found[f"{name}_islands"] = np.nan if bands is None else float(len(bands.islands))
    return found


def _roughness(run: Run) -> float:
    """Of the deposit, without the steep soil that sticks to the left side, mm."""
    surface = run.surface()
    deposit = surface.between(_STUCK, surface.x[-1])
    return 1e3 * deposit.roughness(max(ROUGHNESS_LENGTH, _COLUMNS * surface.width))


def _share(which: np.ndarray, state: Snapshot) -> float:
    mass = state.points.mass
    return float(mass[which].sum() / mass.sum())


def _in_front(state: Snapshot, which: np.ndarray) -> float:
    """Share of the mass of these points that is in the front of the slope; NaN without any."""
    mass, x = state.points.mass, state.position[:, 0]
    front = x >= mass_percentile(x, mass, _FRONT)
    return float(mass[which & front].sum() / mass[which].sum()) if which.any() else np.nan


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value
