"""The cost of output: slope A as a user runs it, against the same steps without a file.

The file is written where the system keeps temporary files.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from ...recorder import Recorder
from ...recording import Recording
from ...run import Run
from ...setup import Setup
from ...simulation import Simulation
from ...solver import Solver
from ...stages import Slide, Stages
from . import in_turn
from .cases import Case

DURATION = 10.0  # s, of slope A
SNAPSHOTS = 200  # in it
RECORDING = Recording(energy_interval=1e-3, snapshot_interval=DURATION / SNAPSHOTS)
SHARE = 0.1
"""Of that run, from its start, which is what is measured."""

_REPEATS = 3


@dataclass(frozen=True)
class OutputCost:
    """What output costs a run, in one pass with it and one without.

    Attributes
    ----------
    points, threads : of the run
    steps, snapshots, rows : taken and written
    share : of the wall time that is saved when the same steps are taken without output
    parts : shares of the wall time: stress, move, nodes, sort, output (what passes between the
        steps), and the rest
    """

    points: int
    threads: int
    steps: int
    snapshots: int
    rows: int
    share: float
    parts: dict[str, float]


def measure(case: Case) -> OutputCost:
    """Run a slope of the size, threads and method of a case, with and without output, in turn: the
    pass with the median share."""
    passes = sorted((_pass(case) for _ in range(_REPEATS)), key=lambda cost: cost.share)
    return passes[_REPEATS // 2]


def _pass(case: Case) -> OutputCost:
    scene = case.slope().scene
    stages = Stages(slide=Slide(SHARE * DURATION))
    simulation = Simulation(Setup(scene, case.method(), stages, RECORDING))
    solver = simulation.solver
    solver.set_materials(scene.materials)  # let go at once, without settling
    with TemporaryDirectory() as folder:
        recorder = Recorder(simulation, Path(folder) / "slope_a.h5", progress=False)
        before = solver.seconds
        with recorder:

            def slide(_: int) -> None:
                simulation.slide(recorder)
                recorder.flush()

            taken = in_turn.seconds(slide, 1)
            written = len(Run(recorder.path).times)
        run = Run(recorder.path)
        snapshots, rows = written, len(run.energy)
        stepping = float(run.attributes["timing"]["wall_seconds"])
    bare = in_turn.seconds(Solver.of(scene, case.method()).advance, solver.steps)
    spent = {part: seconds - before[part] for part, seconds in solver.seconds.items()}
    spent |= {"output": taken - stepping, "rest": stepping - sum(spent.values())}
    return OutputCost(
        points=len(solver),
        threads=case.threads,
        steps=solver.steps,
        snapshots=snapshots,
        rows=rows,
        share=1.0 - bare / taken,
        parts={name: seconds / taken for name, seconds in spent.items()},
    )
