"""What was measured, as a picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from .machine import Limits
from .output import OutputCost
from .results import Results
from .speed import Measurement

_PLAIN = "0.45"
_PARTS = ("#2171b5", "#6baed6", "#41ab5d", "#f7a35c", "#d94801", "0.85")


def figure(results: Results) -> Figure:
    """Speed against size, variants, where the time goes, and the machine."""
    made = Figure(figsize=(11.0, 7.6), layout="constrained")
    axes = made.subplots(2, 2)
    standard = [m for m in results.speeds if m.case == m.case.standard]
    _sizes(axes[0, 0], standard)
    _variants(axes[0, 1], _compared(results.speeds))
    _time(axes[1, 0], results.output)
    _machine(axes[1, 1], results.machine)
    return made


def _sizes(ax: Axes, standard: Sequence[Measurement]) -> None:
    """Speed of the standard case against its size."""
    by_threads = {m.case.threads: m.points for m in standard}
    for number, threads in enumerate(by_threads):
        of = [m for m in standard if m.case.threads == threads]
        speed = np.array([[m.median, m.slowest, m.fastest] for m in of]).T / 1e6
        ax.errorbar(
            [m.points for m in of],
            speed[0],
            [speed[0] - speed[1], speed[2] - speed[0]],
            fmt="o-",
            color=f"C{number}",
            capsize=3,
            label=_threads(threads),
        )
    first = [m for m in standard if m.case.threads == min(by_threads)]
    plain = [m.plain / 1e6 for m in first]
    ax.plot([m.points for m in first], plain, "s--", color=_PLAIN, label="plain loop, 1 thread")
    ax.set_xscale("log")
    ax.set_xticks([m.points for m in first], [f"{m.points / 1e3:.0f}k" for m in first])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.set(xlabel="points", ylabel="M point-steps/s", title="speed, median and extremes")
    ax.set_ylim(0, 1.35 * max(m.fastest for m in standard) / 1e6)
    ax.grid(alpha=0.3)
    ax.legend(loc="upper right", ncols=min(3, len(by_threads) + 1), fontsize="small")


def _compared(speeds: Sequence[Measurement]) -> list[Measurement]:
    """The variants, after the standard case that they are compared with."""
    variants = [m for m in speeds if m.case != m.case.standard]
    of = {m.case.standard for m in variants}
    return [m for m in speeds if m.case in of] + variants


def _variants(ax: Axes, compared: Sequence[Measurement]) -> None:
    """Speed of the standard case and its variants."""
    names = [_name(m) for m in compared]
    bars = ax.barh(names, [m.median / 1e6 for m in compared], color="C0")
    labels = [
        f"{m.median / 1e6:.1f}: {m.ratio:.1f} x plain loop"
        + ("" if m.peak_share is None else f", {100 * m.peak_share:.0f} % of peak")
        for m in compared
    ]
    ax.bar_label(bars, labels, padding=3, fontsize="small")
    ax.invert_yaxis()
    ax.set_xlim(0, 2.4 * max((m.median / 1e6 for m in compared), default=1.0))
    ax.set(xlabel="M point-steps/s")
    if compared:
        first = compared[0]
        ax.set_title(f"{first.points:,} points, {_threads(first.case.threads)}")


def _name(m: Measurement) -> str:
    case = m.case
    changed = [
        case.shape if case.shape != case.standard.shape else "",
        case.scheme if case.scheme != case.standard.scheme else "",
        "single precision" if case.precision == "single" else "",
        "averaged strains" if case.volumetric_strain == "cell_average" else "",
        "ledger" if case.ledger else "",
        f"{100 * case.stones:.0f} % stones" if case.stones else "",
    ]
    return ", ".join(filter(None, changed)) or f"standard ({case.shape})"


def _time(ax: Axes, costs: Sequence[OutputCost]) -> None:
    """Shares of the wall time of a run."""
    names = [_threads(cost.threads) for cost in costs]
    left = np.zeros(len(costs))
    for part, colour in zip(costs[0].parts, _PARTS, strict=True):
        shares = np.array([100 * cost.parts[part] for cost in costs])
        bars = ax.barh(names, shares, left=left, height=0.5, color=colour, label=part)
        labels = [f"{share:.0f}" if share >= 4 else "" for share in shares]
        ax.bar_label(bars, labels, label_type="center", fontsize="small")
        left += shares
    ax.invert_yaxis()
    ax.set_xlim(0, 100)
    ax.set(xlabel="share of the wall time (%)")
    ax.set_title(f"a run of {costs[0].points:,} points with output")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=len(_PARTS), fontsize="small")


def _machine(ax: Axes, limits: Sequence[Limits]) -> None:
    """Reading speeds by level of memory; the multiply-adds in the legend."""
    levels = list(limits[0].reading)
    width = 0.8 / len(limits)
    for number, one in enumerate(limits):
        places = np.arange(len(levels)) + (number - (len(limits) - 1) / 2) * width
        label = f"{_threads(one.threads)}: {one.multiply_add / 1e9:.0f} GFLOP/s multiply-add"
        heights = [rate / 1e9 for rate in one.reading.values()]
        bars = ax.bar(places, heights, 0.92 * width, color=f"C{number}", label=label)
        ax.bar_label(bars, fmt="%.0f", padding=2, fontsize="small")
    ax.set_xticks(range(len(levels)), levels)
    ax.set(ylabel="reading (GB/s)", title=f"the machine, {limits[0].instruction_set}")
    ax.margins(y=0.1)
    ax.legend(loc="upper right", fontsize="small")


def _threads(count: int) -> str:
    return f"{count} thread" + ("s" if count > 1 else "")
