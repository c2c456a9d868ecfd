"""A run file opened for analysis: energy, speed, plastic zone, displacement, surface and stones."""

from __future__ import annotations

from html import escape
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import analysis
from ._check import FloatArray
from .analysis import LEAST_BAND, PLASTIC_THRESHOLD, REST_SHARE, ROUGHNESS_LENGTH
from .run_file import Moment, RunFile
from .snapshot import MaxDisplacement
from .summary import readable, summarise

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def open(path: str | PathLike[str]) -> Run:
    """The run in the file at `path`, whether it has ended, was stopped or is still being written.

    Raises
    ------
    FileNotFoundError, ValueError
        If there is no such file, or it is not a run file of a known format.
    """
    return Run(path)


class Run(RunFile):
    """A run file opened for analysis.

    The time of a method is in s since the trigger, "peak" for the moment of the largest kinetic
    energy so far, and None for the end; the snapshot nearest to it is taken, and a time before the
    first or after the last snapshot refused with `ValueError`. The functions of
    `gimpslope.analysis` say more of what the methods give.
    """

    @property
    def summary(self) -> dict[str, float | int | None]:
        """The main results, as `summarise` computes them from the data written so far."""
        return summarise(self)

    def phases(self, share: float = REST_SHARE) -> analysis.Phases:
        """When the slide is fastest (peak) and from when on it rests (rest), s.

        It rests when the kinetic energy stays at or below `share` of its largest. What the run has
        not reached is None.
        """
        return analysis.phases_of(self.energy, share)

    def fastest(self, time: Moment | None = None) -> analysis.FastestPoint:
        """The fastest point at `time`: its number, place (m) and speed (m/s)."""
        return analysis.fastest_point(self.state(time))

    def fastest_ever(self) -> analysis.FastestPoint:
        """The fastest point of all snapshots: when (s), its number, place (m) and speed (m/s).

        `energy.max_speed` has the largest speed of every row, but not whose it is.
        """
        return analysis.fastest_of(self.snapshots())

    def displacement(self, time: Moment | None = None) -> FloatArray:
        """Displacement (x, y) since the trigger at `time`, m, shape (n, 2)."""
        return self.state(time).displacement

    def max_displacement(
        self, time: Moment | None = None, *, percentile: float = 100.0
    ) -> MaxDisplacement:
        """Largest displacement at `time` in all, sideways (|u_x|) and up or down (|u_y|), m.

        With a `percentile`, %, what that part of the mass does not exceed.
        """
        return analysis.max_displacement(self.state(time), percentile)

    def plastic_strain(self, time: Moment | None = None) -> FloatArray:
        """Equivalent plastic strain of each point at `time`, shape (n,), as `Snapshot` defines."""
        return self.state(time).plastic_strain

    def plastic_zone(
        self, time: Moment | None = None, threshold: float = PLASTIC_THRESHOLD
    ) -> npt.NDArray[np.bool_]:
        """Which points are soil with an equivalent plastic strain above a threshold, shape (n,)."""
        return analysis.plastic_zone(self.state(time), threshold)

    def plastic_share(
        self, time: Moment | None = None, threshold: float = PLASTIC_THRESHOLD
    ) -> analysis.PlasticShare:
        """Share of the mass of soil, and of stones, whose plastic strain is above a threshold."""
        return analysis.plastic_share(self.state(time), threshold)

    def plastic_bands(
        self,
        time: Moment | None = None,
        threshold: float = PLASTIC_THRESHOLD,
        *,
        least: float = LEAST_BAND,
    ) -> analysis.Bands:
        """Connected regions of plastic soil on the cells of the grid, and what they go around.

        `len` counts them; regions of an area below `least`, m2, are left out.
        """
        return analysis.plastic_bands(
            self.state(time),
            self.scene.cell,
            origin=self.scene.origin,
            threshold=threshold,
            least=least,
        )

    def run_out(self, time: Moment | None = None, *, percentile: float = 100.0) -> float:
        """How far the toe has moved to the right since the trigger, m.

        With a `percentile`, %, how far the place has up to which that part of the mass lies.
        """
        return analysis.run_out(self.state(time), percentile)

    def surface(
        self, time: Moment | None = None, *, width: float | None = None
    ) -> analysis.Surface:
        """Height of the slope over columns of a `width`, m; None: of two cells of the grid.

        Narrower columns miss the topmost points where the slope is drawn out.
        `surface().roughness()` tells how uneven it is.
        """
        width = 2 * self.scene.cell if width is None else width
        return analysis.surface_of(self.state(time), width, left=self.scene.origin[0])

    def stone_motion(self) -> analysis.StoneMotion:
        """Translation, rotation and deformation of each stone over the snapshots."""
        return analysis.stone_motion(self.snapshots(), len(self.scene.stones))

    def stone_outlines(self, time: Moment | None = None) -> list[FloatArray]:
        """The outline of each stone at `time`, corners (k, 2), m."""
        return analysis.stone_outlines(self.scene, self.state(time))

    def plot_energy(self, ax: Axes | None = None) -> Axes:
        """Kinetic energy of the slide against time."""
        return self.energy.plot(ax)

    def plot_speed(
        self, time: Moment, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the speed at `time`; its colours end at `largest` (m/s) where given."""
        from . import figures

        return figures.speed(self, time, ax, largest=largest)

    def plot_plastic_zone(
        self, time: Moment, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the equivalent plastic strain at `time`."""
        from . import figures

        return figures.plastic_zone(self, time, ax, largest=largest)

    def plot_displacement(
        self, time: Moment | None = None, ax: Axes | None = None, *, largest: float | None = None
    ) -> Axes:
        """Map of the displacement since the trigger at `time`."""
        from . import figures

        return figures.displacement(self, time, ax, largest=largest)

    def plot_shape(self, time: Moment | None = None, ax: Axes | None = None) -> Axes:
        """Soil and stones at `time`, and the outline that they started from."""
        from . import figures

        return figures.shape(self, time, ax)

    def plot_surface(
        self,
        time: Moment | None = None,
        ax: Axes | None = None,
        *,
        length: float = ROUGHNESS_LENGTH,
    ) -> Axes:
        """Profile of the surface at `time`, its roughness over a length (m), and the outline."""
        from . import figures

        outline = self.scene.outline.vertices
        return figures.surfaces({"": self.surface(time)}, ax, length=length, outline=outline)

    def __repr__(self) -> str:
        return f"<Run {self.path.name!r}: {self.status}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{name.replace('_', ' ')}</th><td>{value}</td></tr>"
            for name, value in readable(self.summary).items()
        )
        title = escape(f"{self.path.name}: {self.status}")
        return f"<table><caption>{title}</caption>{rows}</table>"
