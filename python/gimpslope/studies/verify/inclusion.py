"""A rigid disk in an elastic plate that is pulled along x (Goodier 1933, J. Appl. Mech. 1, 39).

Kolosov's potentials (Muskhelishvili 1953) give displacements and stresses in plane strain:
2 mu (u + i v) = k f - z conj(f') - conj(g), sxx + syy = 4 Re f', syy - sxx + 2 i sxy =
2 (conj(z) f'' + g'), k = 3 - 4 nu. Around a disk of radius a in an endless plate under a pull S,
f = S/4 (z - 2/k a2/z) and g = -S/2 (z + (1 - k)/2 a2/z + a4/z3 / k), for then u + i v is zero at
|z| = a: where the disk is pulled the stress is S/2 (1 + 1/k + (1 + k)/2). In a square plate series
of z^n with odd n fit the disk and the free or pulled edges best.

What the disk takes from the compliance of the plate, and so from its elastic energy under a given
pull, grows as the square of its radius: it tells how large the disk acts. All nodes that a
deformable disk reaches hardly move against each other; the last ones lie up to a cell outside of
a flat edge, half a cell in the mean. A rigid one holds those up to e^(-1/2) cells outside, by a
rule that makes the soil around it right in the mean.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .order import observed_order
from .problem import Outcome, Problem

ComplexArray = npt.NDArray[np.complexfloating]

SOIL = gs.Elastic(density=1000.0, young=10e6, poisson=0.3)
RADIUS, EDGE, PULL = 1.0, 3.0, 100.0  # m; from the middle of the plate to its edges, m; Pa
KOLOSOV = 3 - 4 * SOIL.poisson
DURATION = 10 * EDGE / SOIL.wave_speed  # five times through the plate, s
PLACES = ((0.0, 0.0), (0.4, 0.2), (0.6, 0.9), (0.2, 0.7))  # of the middle, cells off a node
RING = (1.5, 2.0)  # where stresses are compared, radii: two cells off the disk and more
POLE = (1 + 1 / KOLOSOV + (1 + KOLOSOV) / 2) / 2


class Disk(NamedTuple):
    """A disk, and how much larger it acts: in the mean, at least and at most, cells."""

    label: str
    material: gs.Material
    larger: tuple[float, float, float]


HELD = math.exp(-0.5)
DISKS = (
    Disk("rigid", gs.Rigid(SOIL.density), (0.0, HELD - 1, HELD)),
    # As heavy as it is stiff, so that its waves are as slow as those of the soil.
    Disk("deformable", gs.Elastic(1e3 * SOIL.density, 1e3 * SOIL.young, 0.3), (0.5, 0.0, 1.0)),
)


class Plate(NamedTuple):
    """Elastic energy (J/m); of the soil around the disk: places (m from its middle) and stress."""

    energy: float
    places: FloatArray
    stress: FloatArray


class Field(NamedTuple):
    """Potentials around a disk in a plate: f and g are sums of coefficients times (z / scale)^n."""

    power: npt.NDArray[np.int64]
    scale: FloatArray
    f: FloatArray
    g: FloatArray

    @classmethod
    def around(cls, radius: float, edge: float, pull: float) -> Field:
        """Fit to a disk that does not move and to the forces f + z conj(f') + conj(g) = i S y."""
        disk = radius * np.exp(2j * np.pi * (np.arange(100) + 0.5) / 100)
        side = edge * np.cos(np.pi * (np.arange(50) + 0.5) / 50)
        plate = [side + 1j * edge, side - 1j * edge, edge + 1j * side, -edge + 1j * side]
        z = np.concatenate([disk, *plate])
        power = np.arange(-25, 26, 2)
        scale = np.where(power > 0, np.sqrt(2) * edge, radius)
        term = (z[:, None] / scale) ** power
        slope = z[:, None] * np.conj(power * term / z[:, None])
        kind = np.where(np.arange(len(z)) < len(disk), KOLOSOV, -1.0)[:, None]
        table = np.hstack([kind * term - slope, -np.conj(term)])
        given = np.where(np.arange(len(z)) < len(disk), 0.0, -1j * pull * z.imag)
        parts = np.vstack([table.real, table.imag]), np.concatenate([given.real, given.imag])
        f, g = np.split(np.linalg.lstsq(*parts, rcond=None)[0], 2)
        return cls(power, scale, f, g)

    def displacement(self, z: ComplexArray) -> ComplexArray:
        """u + i v, m."""
        term = (z[:, None] / self.scale) ** self.power
        slope = self.power * term / z[:, None] @ self.f
        both = KOLOSOV * term @ self.f - z * slope.conj() - (term @ self.g).conj()
        found: ComplexArray = both / (2 * SOIL.shear_modulus)
        return found

    def stress(self, places: FloatArray) -> FloatArray:
        """xx, yy and xy, Pa, (n, 3)."""
        z = places[:, 0] + 1j * places[:, 1]
        slope = self.power * (z[:, None] / self.scale) ** self.power / z[:, None]
        curve = (self.power - 1) * slope / z[:, None]
        half_sum = 2 * (slope @ self.f).real
        turned = z.conj() * (curve @ self.f) + slope @ self.g
        return np.column_stack([half_sum - turned.real, half_sum + turned.real, turned.imag])

    def energy(self, edge: float, pull: float) -> float:
        """Elastic energy of the plate, J/m: half the work of the pull, by Clapeyron."""
        middles = edge * ((np.arange(400) + 0.5) / 200 - 1)
        return float(2 * edge * pull * self.displacement(edge + 1j * middles).real.mean())


def run(full: bool) -> Outcome:
    """Four and eight cells a radius, in full also sixteen and more places of the disk."""
    counts, places = ((4, 8, 16), PLACES) if full else ((4, 8), PLACES[:1])
    exact = Field.around(RADIUS, EDGE, PULL)
    plain = {count: pull(SOIL, count) for count in counts}
    plates = {
        (disk.label, count): [pull(disk.material, count, place) for place in places]
        for disk in DISKS
        for count in counts
    }
    taken = {
        key: [take(plain[key[1]], plate, exact) for plate in found] for key, found in plates.items()
    }
    checks = [check_series()]
    for disk in DISKS:
        checks += check_size(disk, counts, taken)
        checks += check_stress(disk, counts, plates, exact)
    return Outcome(checks, draw(plates, taken, counts, exact))


def take(plain: Plate, plate: Plate, exact: Field) -> float:
    """What the disk takes from the energy of the plain plate, over the exact."""
    uniform = 2 * EDGE**2 * PULL**2 * (1 - SOIL.poisson**2) / SOIL.young
    return (plain.energy - plate.energy) / (uniform - exact.energy(EDGE, PULL))


def check_series() -> Check:
    far = 100.0
    found = Field.around(1.0, far, 1.0).stress(np.array([[1.0, 0.0]]))[0, 0]
    return Check.near(
        "series: stress where the disk is pulled, over that of the pull, plate of 100 disks",
        expected=POLE,
        got=float(found),
        within=10 / far**2,
        why="closed form of an endless plate; edges that far away matter by ten (a / L)2 at most",
    )


def check_size(
    disk: Disk, counts: tuple[int, ...], taken: dict[tuple[str, int], list[float]]
) -> list[Check]:
    checks: list[Check] = []
    mean, least, most = disk.larger
    before, order = math.inf, None
    for count in counts:
        found = taken[disk.label, count]
        at = f"{disk.label}, h = a/{count}, places: {len(found)}"
        share = float(np.mean(found))
        if checks:
            order = observed_order(before - 1, share - 1)
        checks += [
            Check(
                f"{at}: compliance that the disk takes, over exact",
                1.0,
                share,
                (1 + least / count) ** 2,
                (1 + most / count) ** 2,
                "as the square of the radius, which may act as large as the nodes that it holds",
                order,
            ),
            Check(
                f"{at}: acts larger by, cells",
                mean,
                (math.sqrt(share) - 1) * count,
                least,
                most,
                "the last nodes that it holds lie there, by chance, outside of a flat edge",
            ),
        ]
        before = share
    return checks


def check_stress(
    disk: Disk,
    counts: tuple[int, ...],
    plates: dict[tuple[str, int], list[Plate]],
    exact: Field,
) -> list[Check]:
    checks: list[Check] = []
    before, order = math.inf, None
    for count in counts:
        found = plates[disk.label, count]
        larger = Field.around(RADIUS * (1 + disk.larger[2] / count), EDGE, PULL)
        error = float(np.mean([difference(plate, exact) for plate in found]))
        if checks:
            order = observed_order(before, error)
        checks.append(
            Check.at_most(
                f"{disk.label}, h = a/{count}, places: {len(found)}: "
                "RMS error of the stress half a radius to one off the disk, over the pull",
                bound=difference(found[0]._replace(stress=larger.stress(found[0].places)), exact),
                got=error,
                why="that of a disk as much larger as it may act",
                order=order,
            )
        )
        before = error
    return checks


def difference(plate: Plate, exact: Field) -> float:
    """RMS over the components of the stress in RING, over the pull."""
    off = np.hypot(*plate.places.T) / RADIUS
    ring = (RING[0] < off) & (off < RING[1])
    error = plate.stress[ring] - exact.stress(plate.places[ring])
    return float(np.sqrt(np.mean(error**2)) / PULL)


def pull(disk: gs.Material, count: int, place: tuple[float, float] = (0.0, 0.0)) -> Plate:
    """Pull a plate with a disk of so many cells a radius until it rests.

    Kinetic damping stops all at once: the last step of each swing moves the points but does not
    strain them. So energies and stresses are right and displacements are not.
    """
    cell = RADIUS / count
    cells = round(2 * EDGE / cell)
    along = (np.arange(2 * cells) + 0.5) * cell / 2
    lattice = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    middle = EDGE + cell * np.array(place)
    inside = np.hypot(*(lattice - middle).T) < RADIUS
    volume = np.full(len(lattice), cell**2 / 4)
    solver = gs.Solver(
        gs.Points(
            position=lattice,
            half_length=np.full_like(lattice, cell / 4),
            volume=volume,
            mass=volume * np.where(inside, disk.density, SOIL.density),
            material=inside.astype(np.int32),
            stone=np.where(inside, 0, -1),
        ),
        [SOIL, disk],
        cell=cell,
        method=gs.Method(alpha=0.0),
    )
    across = lattice[:, 0] - EDGE
    side = np.where(np.abs(across) > EDGE - cell / 2, np.sign(across), 0.0)  # the outermost points
    solver.body_force = np.outer(side * PULL * (cell / 2) / solver.mass, [1.0, 0.0])
    solver.set_damping(kinetic=True)
    solver.advance_to(DURATION)
    soil = ~inside
    stress = solver.stress[soil][:, [0, 1, 3]]
    return Plate(solver.energies().elastic, lattice[soil] - middle, stress)


def draw(
    plates: dict[tuple[str, int], list[Plate]],
    taken: dict[tuple[str, int], list[float]],
    counts: tuple[int, ...],
    exact: Field,
) -> Figure:
    """Stress along the pull, how large the disks act, and a map of the stress."""
    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    along, grids, around = figure.subplots(1, 3, width_ratios=(1.2, 1.2, 1))
    finest = counts[-1]
    inverse = np.linspace(0.0, 1.1 / counts[0], 50)
    for number, disk in enumerate(DISKS):
        colour, plate = f"C{number}", plates[disk.label, finest][0]
        row = (np.abs(plate.places[:, 1]) < RADIUS / finest / 2) & (plate.places[:, 0] > 0)
        along.plot(
            plate.places[row, 0], plate.stress[row, 0] / PULL, ".", color=colour, label=disk.label
        )
        low, high = ((1 + larger * inverse) ** 2 for larger in disk.larger[1:])
        grids.fill_between(
            inverse, low, high, color=colour, alpha=0.2, linewidth=0, label=f"{disk.label}, bounds"
        )
        for count in counts:
            shares = taken[disk.label, count]
            grids.plot(np.full(len(shares), 1 / count), shares, "o", color=colour)
    x = np.linspace(RADIUS, EDGE, 200)
    line = exact.stress(np.column_stack([x, 0 * x]))[:, 0] / PULL
    along.plot(x, line, "k-", linewidth=0.8, label="exact")
    along.set(xlabel="x (m)", ylabel="stress xx / pull", ylim=(0, None), title=f"h = a/{finest}")
    along.legend()
    grids.axhline(1.0, color="k", linewidth=0.8)
    grids.set(xlabel="h / a", ylabel="compliance taken / exact", xlim=(0, inverse[-1]))
    grids.legend(loc="upper left")
    plate = plates[DISKS[0].label, finest][0]
    shade = around.scatter(
        *plate.places.T, c=plate.stress[:, 0] / PULL, s=40 / finest, marker="s", vmin=0, vmax=1.5
    )
    around.set(xlabel="x (m)", ylabel="y (m)", aspect="equal", title=DISKS[0].label)
    figure.colorbar(shade, ax=around, label="stress xx / pull", extend="both")
    return figure


PROBLEM = Problem("inclusion", "Rigid disk in a pulled plate", run)
