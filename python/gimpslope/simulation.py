"""A slope through its stages: gravity grows, the slope settles, it is let go, it slides."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from os import PathLike

from . import _check
from .materials import Deformable
from .method import Method
from .method_warning import warn_at_end, warn_at_start
from .recorder import Recorder
from .recording import Recording
from .rest import Rest
from .run import Run
from .scene import Scene
from .setup import Setup
from .solver import Solver
from .stages import Stages

_LARGEST_SHARE = 0.5


class NotSettledError(RuntimeError):
    """The slope did not come to rest within the time that its settling stage allows."""


def simulate(
    scene: Scene,
    duration: float | None = None,
    *,
    method: Method | None = None,
    stages: Stages | None = None,
    output: str | PathLike[str] = "run.h5",
    overwrite: bool = False,
    energy_interval: float = Recording.energy_interval,
    snapshot_interval: float = Recording.snapshot_interval,
    snapshot_times: Sequence[float] = (),
    progress: bool = True,
) -> Run:
    """Simulate a slope from its unloaded state until the slide ends, and write the run file.

    Parameters
    ----------
    scene : what is simulated
    duration : of the slide, s; that of the stages where left out
    method : how the motion is computed; `Method()` where left out
    stages : the loading stages; those of the reference study where left out
    output : the run file
    overwrite : replace a file of that name; without it a file that is not empty is refused
    energy_interval : between rows of energy, s, > 0
    snapshot_interval : between snapshots of the slide, s, > 0
    snapshot_times : further times of snapshots, s, >= 0; those after the duration are left out
    progress : show a progress bar

    Raises
    ------
    TypeError, ValueError, FileExistsError
        If a parameter is refused; nothing is written then.
    NotSettledError
        If the slope is not at rest when its settling stage ends.
    Diverged
        If the motion is no longer finite or outruns the grid.

    Warns (`MethodWarning`) of a run that enters a region where its method is known to fail.

    After any error, Ctrl-C included, the file holds what was computed and says how it ended. A run
    that diverged ends with its last row and snapshot, for the state after them is torn.
    """
    stages = Stages() if stages is None else _check.instance("stages", stages, Stages, "Stages")
    if duration is not None:
        stages = replace(stages, slide=replace(stages.slide, duration=duration))
    method = Method() if method is None else method
    recording = Recording(
        energy_interval=energy_interval,
        snapshot_interval=snapshot_interval,
        snapshot_times=snapshot_times,
    )
    setup = Setup(scene, method, stages, recording)
    return setup.simulate(output, overwrite=overwrite, progress=progress)


class Simulation:
    """The stages of one slope: load, settle, release, slide. `solver` is the state."""

    def __init__(self, setup: Setup) -> None:
        self.setup = _check.instance("setup", setup, Setup, "a Setup")
        self.scene, self.stages = setup.scene, setup.stages
        self.solver = Solver.of(setup.scene, setup.method, elastic=True)

    def run(self, recorder: Recorder) -> Run:
        """All stages, one after the other, recorded; with a `MethodWarning` where the method is
        known to fail."""
        warn_at_start(self.setup, self.solver)
        with recorder:
            self.load(recorder)
            self.settle(recorder)
            self.release(recorder)
            self.slide(recorder)
        warn_at_end(self.setup, self.solver)
        return Run(recorder.path)

    def load(self, recorder: Recorder) -> None:
        """Gravity grows linearly; all materials are elastic."""
        ramp, settling = self.stages.gravity.ramp, self.stages.settling
        if settling.courant is not None:
            self.solver.set_step("courant", self._with_blend(settling.courant))
        self.solver.set_gravity(0.0, -self.scene.gravity, ramp)
        self.solver.set_damping(*settling.to_core())
        recorder.start("gravity", ramp)
        while self.solver.time < ramp:
            recorder.advance(ramp)

    def settle(self, recorder: Recorder) -> None:
        """Damping brings the slope to rest.

        With a ratio the kinetic energy must stay below its share of the potential energy for as
        long as a pressure wave needs to cross the scene twice: at a single moment it may be zero in
        full swing. The potential energy is that of the start, above the bottom of the outline.
        """
        settling = self.stages.settling
        start = self.solver.time
        window = self._crossing_time() if settling.ratio is not None else 0.0
        potential = self._first_potential()
        recorder.start("settling", settling.limit)
        if settling.unbalanced is not None:  # what was left while gravity grew does not count
            self.solver.set_damping(*settling.to_core())
        calm_since, ratio = start, math.inf
        while self.solver.time - calm_since < window or not self._balanced():
            if self.solver.time - start >= settling.limit:
                raise NotSettledError(self._unrest(ratio, window))
            row = recorder.advance(math.inf, rows=1)
            ratio = row["kinetic"] / potential
            if settling.ratio is not None and ratio > settling.ratio:
                calm_since = self.solver.time
        self.settling = {
            "settling_time": self.solver.time - start,
            "settling_ratio": ratio,
            "settling_unbalanced": self._unbalanced(),
        }
        if settling.unbalanced is not None:
            self.solver.stop()

    def release(self, recorder: Recorder) -> None:
        """Strength takes its true value; stresses beyond it return at once; the clock starts."""
        solver = self.solver
        solver.set_damping()
        solver.set_gravity(0.0, -self.scene.gravity)
        solver.reset_clock()
        solver.set_materials(self.scene.materials)
        if self.stages.settling.courant is not None:
            solver.set_step(*self.setup.method.step)
        released = solver.release_stress()
        recorder.release(released, **self.settling)

    def slide(self, recorder: Recorder) -> None:
        """The slope slides, for its duration or until it rests."""
        slide = self.stages.slide
        recorder.start("slide", slide.duration)
        rest = Rest(slide, lambda: self.solver.position) if slide.rest_ratio > 0 else None
        while self.solver.time < slide.duration:
            row = recorder.advance(slide.duration, rows=None if rest is None else 1)
            if rest is not None and rest.reached(row):
                recorder.detail = f"at rest after {self.solver.time:.6g} s"
                return
        recorder.detail = f"slid for {self.solver.time:.6g} s"

    def _with_blend(self, courant: float) -> float:
        """The Courant number, or a smaller one at which the next step has half a share of PIC."""
        solver = self.solver
        kind, value = self.setup.method.blend
        if kind == "alpha" or value == 0:  # it does not grow with the step
            return courant
        longest = _LARGEST_SHARE / solver.alpha * solver.time_step
        return min(courant, longest / solver.stable_time_step)

    def _unbalanced(self) -> float:
        weight = float(self.scene.gravity * self.scene.points.mass.sum())
        return self.solver.unbalanced_force / weight

    def _balanced(self) -> bool:
        wanted = self.stages.settling.unbalanced
        return wanted is None or self._unbalanced() < wanted

    def _unrest(self, ratio: float, window: float) -> str:
        settling = self.stages.settling
        what = []
        if settling.ratio is not None:
            what.append(
                f"kinetic over potential energy, {ratio:.3g} now, has not stayed below ratio = "
                f"{settling.ratio} for {window:.3g} s, in which a wave crosses the scene twice"
            )
        if settling.unbalanced is not None:
            what.append(
                f"unbalanced forces over weight, {self._unbalanced():.3g} now, must be below "
                f"unbalanced = {settling.unbalanced}"
            )
        return f"not at rest after settling for limit = {settling.limit} s: {'; '.join(what)}"

    def _crossing_time(self) -> float:
        left, bottom, right, top = self.scene.outline.bounds
        materials = self.scene.materials
        slowest = min(m.wave_speed for m in materials if isinstance(m, Deformable))
        return 2 * math.hypot(right - left, top - bottom) / slowest

    def _first_potential(self) -> float:
        points = self.scene.points
        heights = points.position[:, 1] - self.scene.outline.bounds[1]
        return float(self.scene.gravity * points.mass @ heights)
