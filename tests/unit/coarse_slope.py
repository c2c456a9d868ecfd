"""Slope A on a coarse grid, for the tests of simulations."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gimpslope as gs
from gimpslope.recorder import Recorder
from gimpslope.simulation import Simulation
from gimpslope.studies import reference

SLOPE = reference.slope(cell=0.8)
METHOD = reference.method()
STAGES = gs.Stages(gs.Gravity(0.3), gs.Settling(ratio=1e-7), gs.Slide(duration=3.0))


def simulate(path: Path, **options: Any) -> gs.Run:
    """A run of the coarse slope, unless told otherwise."""
    given = {"scene": SLOPE, "method": METHOD, "stages": STAGES, "progress": False} | options
    return gs.simulate(output=path, **given)


def simulate_whole(path: Path) -> gs.Run:
    """All of it, with snapshots at times that lie on no interval, too."""
    return simulate(
        path, energy_interval=0.01, snapshot_interval=0.5, snapshot_times=(1.6, 0.123, 99.0)
    )


@contextmanager
def recording(simulation: Simulation, path: Path) -> Iterator[Recorder]:
    """A recorder with the defaults of `simulate`."""
    with Recorder(simulation, path, progress=False) as recorder:
        yield recorder
