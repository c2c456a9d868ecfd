"""A run beside the reference study, and beside the run that it repeats, in words."""

from __future__ import annotations

from collections.abc import Mapping

import h5py

from ..run import Run

_ROWS = (
    ("time of peak kinetic energy", "time_of_peak", "s", "{:g}"),
    ("peak kinetic energy", "peak_kinetic_energy", "kJ/m", ""),
    ("fastest point at the peak", "speed_at_peak", "m/s", "> {:g}"),
    ("largest displacement", "max_displacement_total", "m", "{:g}"),
    ("  horizontal", "max_displacement_horizontal", "m", "{:g}"),
    ("  vertical", "max_displacement_vertical", "m", "{:g}"),
    ("toe", "toe", "m", ""),
    ("final kinetic energy", "final_kinetic_energy", "J/m", ""),
)


def text(title: str, summary: Mapping[str, float | int | None], paper: Mapping[str, float]) -> str:
    """A run's summary beside the paper's values by the same names, where there are any."""
    lines = [f"{title:32}{'paper':>8}{'here':>10}" if paper else f"{title:32}{'':>10}"]
    for label, key, unit, form in _ROWS:
        published = form.format(paper[key]) if form and key in paper else "-"
        value = summary[key]
        scale = 1e-3 if unit == "kJ/m" else 1.0
        here = "-" if value is None else f"{value * scale:.2f}"
        lines.append(f"{label:32}{f'{published:>8}' if paper else ''}{here:>10} {unit}")
    if "max_displacement_horizontal" in paper:
        lines.append(
            "The paper swaps the labels of horizontal and vertical; here they are put right."
        )
    gap = summary["smallest_gap_in_cells"]
    if gap is not None:
        lines.append(
            f"The nearest two stones are {gap:.2f} cells apart; closer than two they act as one."
        )
    rate = summary["point_steps_per_second"]
    if rate is not None:
        lines.append(
            f"{summary['points']:,} points, {summary['steps']:,} steps in "
            f"{summary['wall_seconds']:.1f} s: {rate / 1e6:.1f} M point-steps/s"
        )
    return "\n".join(lines)


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
