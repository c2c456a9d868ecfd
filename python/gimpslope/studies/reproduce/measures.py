"""The figures of a run that the paper's claims are about."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

from ..._check import FloatArray
from ...analysis import ROUGHNESS_LENGTH, mass_percentile, plastic_zone
from ...run import Run
from ...snapshot import Snapshot

EARLY, LATE = 0.5, 3.5
"""Times of the paper's maps of speed, beside that of the peak, s."""

FAST = 1.0
"""Speed above which a point is fast, m/s."""

NEAR, FAR = 2.0, 4.0
"""Displacements below which a point has moved little, and above which it has moved far, m."""

BOTTOM = 2.0
"""Height of the bottom of the slope, m."""

RUN_OUT = 99.0
"""Share of the mass whose front tells the run-out, %."""

_BANDS = {"early": 1.0, "late": 5.0}  # s, of the paper's maps of the plastic zone
_BEHIND = 75.0  # % of the mass behind the front
_STUCK = 1.0  # m from the left side
_COLUMNS = 4
_PEAK = ("peak_energy", "peak_time", "peak_speed", "fast_share", "peak_bands")
_END = (
    *("plastic_soil", "plastic_stone", "bottom_intact", "total", "horizontal", "vertical"),
    *("near_share", "far_front", "run_out", "roughness"),
)


@dataclass(frozen=True)
class Measures:
    """Figures of one run; NaN for what it has not reached: those of the peak where the kinetic
    energy still grows, those of the end where the slope has not come to rest.

    Attributes
    ----------
    mass : of soil and stones, t/m
    peak_energy : kinetic, kJ/m
    peak_time, rest_time : when kinetic energy is largest, and from when it stays below 1 % of that,
        s since the trigger
    early_speed, peak_speed, late_speed : of the fastest point at 0.5 s, the peak and 3.5 s, m/s
    fast_share : share of the mass that moves by 1 m/s or more at the peak
    late_rear : share of the mass that is faster than 1 m/s at 3.5 s and not in the front quarter
    early_bands, peak_bands, late_bands : connected plastic regions of the soil at 1 s, the peak and
        5 s
    early_islands : what these enclose on all sides at 1 s
    plastic_soil, plastic_stone : share of the mass with more than 1 % of plastic strain in the end
    bottom_intact : share of the soil that lay in the lowest 2 m and has no such strain in the end
    total, horizontal, vertical : largest displacements in the end, m
    near_share : share of the mass that has moved by less than 2 m in the end
    far_front : share of the mass moved by more than 4 m that ends in the front quarter; NaN where
        nothing has
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
    late_rear: float
    early_bands: float
    peak_bands: float
    late_bands: float
    early_islands: float
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
    """The figures of a run."""
    phases = run.phases()
    return Measures(
        mass=float(run.points.mass.sum()) / 1e3,
        rest_time=np.nan if phases.rest is None else phases.rest,
        **_at_times(run),
        **_at_the_peak(run, reached=phases.peak is not None),
        **_in_the_end(run, reached=phases.rest is not None),
    )


def _at_times(run: Run) -> dict[str, float]:
    """What happens at the times of the paper's maps."""
    early, late = _state(run, EARLY), _state(run, LATE)
    bands = {
        name: None if _state(run, time) is None else run.plastic_bands(time)
        for name, time in _BANDS.items()
    }
    return {
        "early_speed": np.nan if early is None else float(early.speed.max()),
        "late_speed": np.nan if late is None else float(late.speed.max()),
        "late_rear": np.nan if late is None else _share(late, (late.speed > FAST) & ~front(late)),
        "early_islands": np.nan if bands["early"] is None else float(len(bands["early"].islands)),
        **{
            f"{name}_bands": np.nan if found is None else float(len(found))
            for name, found in bands.items()
        },
    }


def _at_the_peak(run: Run, *, reached: bool) -> dict[str, float]:
    if not reached:
        return dict.fromkeys(_PEAK, np.nan)
    peak = run.state("peak")
    found = (
        run.energy.peak.value / 1e3,
        run.energy.peak.time,
        run.energy.speed_at_peak,
        _share(peak, peak.speed >= FAST),
        float(len(run.plastic_bands("peak"))),
    )
    return dict(zip(_PEAK, found, strict=True))


def _in_the_end(run: Run, *, reached: bool) -> dict[str, float]:
    if not reached:
        return dict.fromkeys(_END, np.nan)
    end = run.final
    soil, stone = run.plastic_share()
    found = (
        np.nan if soil is None else soil,
        np.nan if stone is None else stone,
        bottom_intact(end),
        *run.max_displacement(),
        _share(end, _moved(end) < NEAR),
        far_front(end),
        run.run_out(percentile=RUN_OUT),
        _roughness(run),
    )
    return dict(zip(_END, found, strict=True))


def front(state: Snapshot) -> npt.NDArray[np.bool_]:
    """Which points are in the front quarter of the mass, shape (n,)."""
    x = state.position[:, 0]
    ahead: npt.NDArray[np.bool_] = x >= mass_percentile(x, state.points.mass, _BEHIND)
    return ahead


def bottom_intact(state: Snapshot) -> float:
    """Share of the soil that lay in the lowest 2 m at the start and is not in the plastic zone."""
    bottom = (state.points.stone < 0) & (state.points.position[:, 1] < BOTTOM)
    return float(np.average(~plastic_zone(state)[bottom], weights=state.points.mass[bottom]))


def far_front(state: Snapshot) -> float:
    """Share of the mass moved by more than 4 m that is in the front quarter; NaN without any."""
    far = _moved(state) > FAR
    return _share(state, far & front(state)) / _share(state, far) if far.any() else np.nan


def _state(run: Run, time: float) -> Snapshot | None:
    return run.snapshot(time) if len(run.times) and time <= run.times[-1] else None


def _moved(state: Snapshot) -> FloatArray:
    moved: FloatArray = np.linalg.norm(state.displacement, axis=1)
    return moved


def _share(state: Snapshot, which: npt.NDArray[np.bool_]) -> float:
    """Share of the mass that these points have."""
    mass = state.points.mass
    return float(mass[which].sum() / mass.sum())


def _roughness(run: Run) -> float:
    """Of the deposit, without the steep soil that sticks to the left side, mm."""
    surface = run.surface()
    deposit = surface.between(_STUCK, surface.x[-1])
    return 1e3 * deposit.roughness(max(ROUGHNESS_LENGTH, _COLUMNS * surface.width))
