"""What is followed from grid to grid, and measured of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..._check import FloatArray
from ...analysis import SmoothPeak, smooth_peak
from ...run import Run
from ...summary import smallest_gap
from ..reproduce.measures import RUN_OUT
from ..reproduce.quantities import QUANTITIES as OF_THE_STUDY
from ..reproduce.quantities import Quantity
from .surfaces import heights

_CHOSEN = (
    *("peak_energy", "peak_time", "peak_speed", "total", "horizontal", "vertical"),
    *("run_out", "plastic_soil"),
)
_OWN = (
    Quantity("drop", "drop of the potential energy", "kJ/m", 0),
    Quantity("plastic_work", "share of plastic work", "", 3),
    Quantity("transfer", "share of the transfer loss", "", 3),
    Quantity("integration", "residue of the time step, share", "", 4),
    Quantity("mean_strain", "mean plastic strain of the soil", "", 2),
    Quantity("largest_strain", "largest plastic strain of the soil", "", 2),
)
QUANTITIES = tuple(
    one._replace(digits=one.digits + 1)
    for one in (*(one for name in _CHOSEN for one in OF_THE_STUDY if one.figure == name), *_OWN)
)
"""With a digit more than the study shows, for fine grids differ by little."""


@dataclass(frozen=True, eq=False)
class Measured:
    """One run.

    Attributes
    ----------
    figures : by their names in `QUANTITIES`; NaN for those of a peak that is not reached, and those
        of the end of a slide that has not come to rest
    surface : heights of the final one as in `heights`; None if it has not come to rest
    gap : between the two nearest stones, in cells; NaN without two
    points, point_steps : numbers of material points, and of these times steps
    core_seconds : processor time spent stepping, s; of a run file of an older version, which does
        not have it, the wall time times the threads
    """

    figures: Mapping[str, float]
    surface: FloatArray | None
    gap: float
    points: int
    point_steps: int
    core_seconds: float


def measure(run: Run, width: float) -> Measured:
    """A run, its surface over columns of a width, m."""
    peak, rests = smooth_peak(run.energy), run.phases().rest is not None
    timing, gap = run.attributes["timing"], smallest_gap(run.scene)
    nothing = dict.fromkeys((one.figure for one in QUANTITIES), math.nan)
    return Measured(
        nothing | ({} if peak is None else _at(peak)) | (_in_the_end(run) if rests else {}),
        heights(run, width) if rests else None,
        math.nan if gap is None else gap,
        len(run.points),
        timing["point_steps"],
        timing.get("processor_seconds", timing["wall_seconds"] * run.method.threads),
    )


def _at(peak: SmoothPeak) -> dict[str, float]:
    return {
        "peak_energy": peak.kinetic / 1e3,
        "peak_time": peak.time,
        "peak_speed": peak.max_speed,
    }


def _in_the_end(run: Run) -> dict[str, float]:
    end, ledger, moved = run.final, run.ledger, run.max_displacement()
    strain = end.plastic_strain[end.points.stone < 0]
    shares = ledger.shares() if ledger.potential[-1] < ledger.potential[0] else {}
    return {
        **moved._asdict(),
        "run_out": run.run_out(percentile=RUN_OUT),
        "plastic_soil": float(run.plastic_share().soil or 0.0),
        "drop": ledger.turned_over / 1e3,
        "plastic_work": shares.get("plastic", math.nan),
        "transfer": shares.get("transfer", math.nan),
        "integration": shares.get("integration", math.nan),
        "mean_strain": float(strain.mean()),
        "largest_strain": float(strain.max()),
    }
