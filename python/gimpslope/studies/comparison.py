"""A run beside the reference study, and beside the run that it repeats, in words."""

from __future__ import annotations

from collections.abc import Mapping

import h5py

from ..method_warning import NEAR_STONES
from ..run import Run
from ..summary import still_grows
from . import reference

_ROWS = (
    ("time of peak kinetic energy", "time_of_peak", "s"),
    ("peak kinetic energy", "peak_kinetic_energy", "kJ/m"),
    ("fastest point at the peak", "speed_at_peak", "m/s"),
    ("largest displacement", "max_displacement_total", "m"),
    ("  horizontal", "max_displacement_horizontal", "m"),
    ("  vertical", "max_displacement_vertical", "m"),
    ("toe", "toe", "m"),
    ("final kinetic energy", "final_kinetic_energy", "J/m"),
)
_OF_PEAK = {"time_of_peak", "peak_kinetic_energy", "speed_at_peak"}


def text(title: str, summary: Mapping[str, float | int | None], paper: Mapping[str, float]) -> str:
    """A run's summary beside the paper's values by the same names, where there are any."""
    lines = [f"{title:32}{'paper':>8}{'here':>10}" if paper else title]
    grows = still_grows(summary)
    for label, key, unit in _ROWS:
        published = reference.published(key, paper[key]) if key in paper else "-"
        here = "  still growing" if grows and key in _OF_PEAK else _shown(summary[key], unit)
        lines.append(f"{label:32}{f'{published:>8}' if paper else ''}{here}")
    if "max_displacement_horizontal" in paper:
        lines.append(
            "The paper swaps the labels of horizontal and vertical; here they are put right."
        )
    gap = summary["smallest_gap_in_cells"]
    if gap is not None:
        sharing = "; closer than two cells deformable ones share nodes" if gap < NEAR_STONES else ""
        lines.append(f"The nearest two stones are {gap:.2f} cells apart{sharing}.")
    rate = summary["point_steps_per_second"]
    if rate is not None:
        lines.append(
            f"{summary['points']:,} points, {summary['steps']:,} steps in "
            f"{summary['wall_seconds']:.1f} s: {rate / 1e6:.1f} M point-steps/s"
        )
    return "\n".join(lines)


def _shown(value: float | None, unit: str) -> str:
    scale = 1e-3 if unit == "kJ/m" else 1.0
    return f"{'-' if value is None else f'{value * scale:.2f}':>10} {unit}"


def repetition(first: Run, second: Run) -> str:
    """Whether a run repeats another one to the last bit; if not, what may be the cause."""
    if _same(first, second):
        return f"repeats {first.path} to the last bit"
    before, after = first.attributes, second.attributes
    causes = [
        f"{name.replace('_', ' ')} {before[name]!r} there, {after[name]!r} here"
        for name in ("status", "gimpslope_version", "instruction_set")
        if before[name] != after[name]
    ]
    return f"differs from {first.path}: {'; '.join(causes) or 'for no cause known'}"


def _same(first: Run, second: Run) -> bool:
    """Whether the two files hold the same datasets, to the last bit."""
    with h5py.File(first.path) as one, h5py.File(second.path) as other:
        before, after = _datasets(one), _datasets(other)
        return before.keys() == after.keys() and all(
            before[name][...].tobytes() == after[name][...].tobytes() for name in before
        )


def _datasets(file: h5py.File) -> dict[str, h5py.Dataset]:
    found: dict[str, h5py.Dataset] = {}
    file.visititems(
        lambda name, item: found.update({name: item} if isinstance(item, h5py.Dataset) else {})
    )
    return found
