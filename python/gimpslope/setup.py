"""All that a run is made from, in one piece that a run file or a scene file gives back."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING

from . import _check
from ._record import Record
from .method import Method
from .recording import Recording
from .scene import Scene
from .stages import Stages

if TYPE_CHECKING:
    from .run import Run


@dataclass(frozen=True)
class Setup(Record):
    """A scene, how its motion is computed, its stages, and what is recorded.

    Raises
    ------
    TypeError
        If one of them is of another class.
    """

    scene: Scene
    method: Method = Method()  # noqa: RUF009 (frozen)
    stages: Stages = Stages()  # noqa: RUF009 (frozen)
    recording: Recording = Recording()  # noqa: RUF009 (frozen)

    def __post_init__(self) -> None:
        _check.instance("scene", self.scene, Scene, "a Scene")
        _check.instance("method", self.method, Method, "a Method")
        _check.instance("stages", self.stages, Stages, "Stages")
        _check.instance("recording", self.recording, Recording, "a Recording")

    def simulate(
        self,
        output: str | PathLike[str] = "run.h5",
        *,
        overwrite: bool = False,
        progress: bool = True,
    ) -> Run:
        """Simulate it and write the run file, as `gimpslope.simulate` does."""
        from .recorder import Recorder
        from .simulation import Simulation

        simulation = Simulation(self)
        return simulation.run(Recorder(simulation, output, overwrite=overwrite, progress=progress))
