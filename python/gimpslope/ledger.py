"""The energy ledger: where every joule goes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from . import _check
from ._check import FloatArray
from .io import hdf5

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Ledger(NamedTuple):
    """What became of the energy since the clock was last set to zero, J/m.

    Kinetic, elastic and potential energy and `taken` add up to a constant but for rounding. That
    holds while the solver steps; what is set from outside (velocities, positions, stresses,
    volumes, materials, gravity) changes the constant.

    Attributes
    ----------
    plastic : work on plastic strains, with the stress after the return; and the elastic energy that
        `release_stress` releases
    friction : taken by Coulomb walls, and by rigid stones that soil slides along
    impact : what walls take at once of motion into them or off them, and, if they are fixed, along
    damping : taken by local and kinetic damping
    transfer : lost between points and grid: by the share of PIC, which smooths the velocities of
        points, and by the lumped masses of the nodes. With transfer "apic" the energy of the affine
        motion that points carry counts as transferred, for it is no part of the kinetic energy;
        with scheme "musl" what the forces do at the velocities that points bring back, too. With
        "xpic" it gives back what `impact` takes at every step of the motion of points near walls
    external : work of body forces, and of the part of gravity that its ramp still holds back
    hypoelastic : taken by the rate form of the elastic law, which stores energy a volume while
        volumes change; of either sign, and small where elastic strains are
    integration : residue of the finite time step; it swings at first order in the step
    rigidity : lost where rigid stones meet the soil that they hold, walls, and each other, but for
        their friction along soil
    """

    plastic: float
    friction: float
    impact: float
    damping: float
    transfer: float
    external: float
    hypoelastic: float
    integration: float
    rigidity: float

    @property
    def taken(self) -> float:
        """Sum of all entries less `external`: what the motion has lost, J/m."""
        return sum(self) - 2 * self.external


SINKS = (
    "plastic",
    "friction",
    "impact",
    "damping",
    "transfer",
    "rigidity",
    "hypoelastic",
    "integration",
)
"""The entries that take energy from the motion; the last two may have either sign."""


@dataclass(frozen=True, eq=False)
class LedgerRows:
    """Energies and ledger of one stage of a run, one array (k,) a column.

    Attributes
    ----------
    path : the run file
    time : s; in the slide from the trigger
    kinetic, potential, elastic : J/m, the state at that time
    plastic, friction, impact, damping, transfer, external, hypoelastic, integration, rigidity : as
        in `Ledger`, J/m; in the slide, `plastic` starts with the energy that the trigger releases
    """

    path: Path
    time: FloatArray
    kinetic: FloatArray
    potential: FloatArray
    elastic: FloatArray
    plastic: FloatArray
    friction: FloatArray
    impact: FloatArray
    damping: FloatArray
    transfer: FloatArray
    external: FloatArray
    hypoelastic: FloatArray
    integration: FloatArray
    rigidity: FloatArray

    def __len__(self) -> int:
        return len(self.time)

    @property
    def balance(self) -> FloatArray:
        """The sum that stays constant, J/m."""
        sinks: FloatArray = np.sum([getattr(self, name) for name in SINKS], axis=0)
        return self.kinetic + self.potential + self.elastic + sinks - self.external

    @property
    def turned_over(self) -> float:
        """The largest drop of the potential energy since the first row, J/m.

        Raises `ValueError` for a stage without rows, as `shares` and `plot` do.
        """
        self._refuse_empty()
        return float(self.potential[0] - self.potential.min())

    def shares(self) -> dict[str, float]:
        """Where the drop in potential energy went by the last row: parts of one.

        Keys: the entries of the ledger but for `external`, and the gains of kinetic and elastic
        energy, `kinetic` and `elastic`. With external work they add up to more or less than one.
        Raises `ValueError` where the potential energy has not dropped.
        """
        self._refuse_empty()
        dropped = float(self.potential[0] - self.potential[-1])
        if dropped <= 0:
            raise ValueError(f"the potential energy must have dropped, got a drop of {dropped} J/m")
        return {
            name: float(getattr(self, name)[-1] - getattr(self, name)[0]) / dropped
            for name in (*SINKS, "kinetic", "elastic")
        }

    def stage(self, name: str) -> LedgerRows:
        """The rows of another stage: "gravity", "settling" or "slide"."""
        return ledger_of(self.path, name)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Stacked areas of all energies against time, drawn into `ax` or a new figure."""
        from . import figures

        self._refuse_empty()
        return figures.ledger(self, ax)

    def _refuse_empty(self) -> None:
        if len(self) == 0:
            raise ValueError(f"the stage must have energy rows, got none in {str(self.path)!r}")


def ledger_of(path: Path, stage: str) -> LedgerRows:
    """The rows of one stage in the run file at `path`.

    Raises `ValueError` if the run kept no ledger.
    """
    number = hdf5.STAGES.index(_check.one_of("stage", stage, hdf5.STAGES))
    columns = hdf5.read_ledger(path)
    if not columns:
        raise ValueError(
            f"method must have kept a ledger, Method(ledger=True), got none in {str(path)!r}"
        )
    energies = hdf5.read_energy(path)
    count = min(len(energies["time"]), len(columns["plastic"]))
    rows = energies["stage"][:count] == number
    names = ("time", "kinetic", "potential", "elastic")
    everything = {name: energies[name] for name in names} | columns
    return LedgerRows(path, **{name: column[:count][rows] for name, column in everything.items()})
