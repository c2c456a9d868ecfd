"""What was measured, as text."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from importlib.metadata import version
from os import PathLike
from pathlib import Path

from . import output, picture, study
from .machine import BUFFERS, MEMORY, Limits
from .output import OutputCost
from .results import Results
from .single import SingleError
from .speed import Measurement
from .study import StudyTime

_DPI = 110
_COLUMNS = (
    "points",
    "threads",
    "precision",
    "shape",
    "scheme",
    "strains",
    "ledger",
    "stones",
    "M point-steps/s",
    "(slowest ... fastest)",
    "plain loop",
    "ratio",
    "of fastest",
    "to standard",
    "GFLOP/s",
    "of peak",
    "bytes/point",
)


def text(results: Results) -> str:
    """All of it: machine, speeds, where the time goes, single precision, the whole study."""
    sections = [
        _machine(results.machine),
        table(results.speeds),
        _legend(results.speeds),
        _time(results.output),
        _single(results.single),
        _study(results.study),
    ]
    return "\n\n".join(sections)


def write(results: Results, directory: str | PathLike[str]) -> None:
    """Write bench.txt and the picture bench.png into a directory."""
    (Path(directory) / "bench.txt").write_text(text(results) + "\n")
    picture.figure(results).savefig(Path(directory) / "bench.png", dpi=_DPI)


def table(measurements: Sequence[Measurement]) -> str:
    """Speeds, a line a case."""
    return _aligned([_COLUMNS, *map(_row, measurements)])


def _row(m: Measurement) -> tuple[str, ...]:
    case = m.case
    return (
        f"{m.points:,}",
        f"{case.threads}",
        case.precision,
        case.shape,
        case.scheme,
        case.volumetric_strain.replace("_", " "),
        "on" if case.ledger else "off",
        f"{100 * case.stones:.0f} %",
        f"{m.median / 1e6:.1f}",
        f"({m.slowest / 1e6:.1f} ... {m.fastest / 1e6:.1f})",
        f"{m.plain / 1e6:.1f}",
        f"{m.ratio:.2f}",
        f"{m.ratio_of_fastest:.2f}",
        "-" if m.to_standard is None else f"{m.to_standard:.2f}",
        "-" if m.flops is None else f"{m.flops * m.median / 1e9:.1f}",
        "-" if m.peak_share is None else f"{100 * m.peak_share:.0f} %",
        f"{m.bytes_per_point:.0f}",
    )


def _machine(limits: Sequence[Limits]) -> str:
    here = f"gimpslope {version('gimpslope')}, {platform.machine()}, {os.cpu_count()} processors"
    head = ("threads", "multiply-add GFLOP/s", *(f"{name} GB/s" for name in limits[0].reading))
    rows = [
        (
            str(one.threads),
            *(f"{rate / 1e9:.0f}" for rate in (one.multiply_add, *one.reading.values())),
        )
        for one in limits
    ]
    sizes = ", ".join(f"{name} {size // 1024} KiB a thread" for name, size in BUFFERS.items())
    return "\n".join(
        [
            f"{here}, instructions {limits[0].instruction_set}",
            _aligned([head, *rows]),
            f"read from buffers of {sizes}, DRAM {MEMORY // 1024**2} MiB in all",
        ]
    )


def _legend(measurements: Sequence[Measurement]) -> str:
    counted = {m.case.shape: m.flops for m in measurements if m.flops is not None}
    counts = ", ".join(f"{shape} {operations:.0f}" for shape, operations in counted.items())
    return "\n".join(
        [
            "ratio: to the plain loop on one thread; to standard: to the first case of this size "
            "and number of threads; both are medians of repeats in turn",
            "of fastest: ratio of the fastest repeats of both, which others on the machine disturb "
            "least",
            f"floating-point operations counted a point-step: {counts}; of peak: share of the "
            "fused multiply-adds of as many threads, measured in turn",
        ]
    )


def _time(costs: Sequence[OutputCost]) -> str:
    head = ("threads", *costs[0].parts, "saved without output")
    rows = [
        (str(one.threads), *(f"{100 * share:.1f} %" for share in (*one.parts.values(), one.share)))
        for one in costs
    ]
    first = costs[0]
    interval = 1e3 * output.RECORDING.energy_interval
    return "\n".join(
        [
            f"where the time of a run goes: {first.points:,} points, {output.SNAPSHOTS} snapshots "
            f"and a row every {interval:g} ms in {output.DURATION:g} s",
            _aligned([head, *rows]),
            f"measured over {first.steps:,} steps with {first.snapshots} snapshots and "
            f"{first.rows:,} rows, and the same steps without",
        ]
    )


def _single(error: SingleError) -> str:
    return (
        f"single against double precision after {error.steps:,} steps of the slide, relative: "
        f"kinetic energy {error.kinetic:.1e},\n"
        f"largest displacement {error.largest:.1e}, median displacement {error.median:.1e}"
    )


def _study(time: StudyTime) -> str:
    one = ", ".join(
        f"{_minutes(seconds)} on {threads} thread{'s' if threads > 1 else ''}"
        for threads, seconds in time.slope.items()
    )
    way = (
        f"{time.at_once} at a time with one thread each, if side by side they are as fast as alone"
        if time.at_once > 1
        else f"one after the other with {time.cores} thread{'s' if time.cores > 1 else ''}"
    )
    return (
        f"extrapolated to the paper's own step of {1e3 * study.TIME_STEP:g} ms, {study.STEPS:,} "
        f"steps a slope, soil alone and without output: one slope {one};\n"
        f"{study.SLOPES} slopes on {time.cores} core{'s' if time.cores > 1 else ''} "
        f"{_minutes(time.study)}, {way}"
    )


def _minutes(seconds: float) -> str:
    return f"{seconds / 60:.1f} min"


def _aligned(rows: Sequence[Sequence[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        for row in rows
    )
