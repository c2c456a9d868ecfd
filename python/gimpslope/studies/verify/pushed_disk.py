"""A disk pushed sideways through weightless clay takes N c D a metre (Randolph & Houlsby 1984).

Geotechnique 34, 613: N = pi + 2 d + 2 cos d + 4 (cos(d/2) + sin(d/2)), where sin d is the share
of the cohesion c that the interface takes. That is 2 pi + 4 sqrt(2) = 11.94, exactly, for a disk
that is welded to the clay, as here; for a smooth one it is 6 + pi = 9.14, and 9.20 an upper bound
(Martin & Randolph 2006, Geotechnique 56, 141).

The clay slips along the disk, but on a grid not nearer than in the middle of the cell outside of
the last nodes that move with the disk. Those of a rigid one lie up to e^(-1/2) cells outside of its
flat edge, those of a deformable one up to one cell, and up to a cell less by chance. So the disk
acts e^(-1/2) or 1 cell wider a side in the mean, half a cell more or less.

The disk is so heavy that it keeps its speed, and what it loses of its momentum is the load. The
clay is under a pressure that does not make it yield but would keep a smooth disk in touch.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import gimpslope as gs

from ..._check import FloatArray
from ..check import Check
from .order import observed_order
from .problem import Outcome, Problem

COHESION, PRESSURE = 10e3, 200e3  # Pa
CLAY = gs.DruckerPrager(2000.0, 280e6, 0.4, friction=0, cohesion=COHESION)
DIAMETER, WALL = 1.0, 2.0  # m; from the middle of the disk to the walls
CROSSING = DIAMETER / np.sqrt(CLAY.shear_modulus / CLAY.density)  # of the disk by a shear wave, s
PATH, DURATION, RAMP = 1.2e-3, 20 * CROSSING, 2 * CROSSING  # m, s, s
ROWS = 30  # of the load, each the mean over a share of the path
DENSITY = 1e6 * CLAY.density
PLACES = ((0.0, 0.0), (0.4, 0.2), (0.6, 0.9), (0.2, 0.7))  # of the middle, cells off a node

Strain = Literal["point", "cell_average"]


class Disk(NamedTuple):
    """A disk, the share of c that its interface takes, and how far outside of a flat edge the last
    nodes lie that move with it, cells."""

    label: str
    material: gs.Material
    roughness: float
    reach: float


RIGID = Disk("rigid", gs.Rigid(DENSITY), 1.0, np.exp(-0.5))
# The mean volume strain of a cell lets a far stiffer disk press on the clay around it.
STIFF = Disk("deformable", gs.Elastic(DENSITY, 100 * CLAY.young, CLAY.poisson), 1.0, 1.0)
DISKS = (RIGID, STIFF)


class Push(NamedTuple):
    """Path (m) and load / (c D) by rows; places (m from the disk) and plastic strain in the end."""

    path: FloatArray
    load: FloatArray
    places: FloatArray
    strain: FloatArray

    @property
    def limit(self) -> float:
        return float(self.load[-ROWS // 5 :].mean())

    @property
    def gain(self) -> float:
        """Share by which the load grows in the last third."""
        third = self.load[-ROWS // 3 :]
        half = len(third) // 2
        return float(third[half:].mean() / third[:half].mean() - 1)


def run(full: bool) -> Outcome:
    """Four and eight cells a diameter, in full also sixteen and more places of the disk."""
    counts, places = ((4, 8, 16), PLACES) if full else ((4, 8), PLACES[:1])
    pushes = {
        (disk.label, count): [push(disk, count, place) for place in places]
        for disk in DISKS
        for count in counts
    }
    checks = [check for disk in DISKS for check in check_limits(disk, counts, pushes)]
    finest = counts[-1]
    locked = {disk.label: push(disk, finest, PLACES[0], "point") for disk in DISKS}
    for disk in DISKS:
        checks += check_locking(disk, finest, pushes[disk.label, finest][0], locked[disk.label])
    checks += check_rate(4, pushes[RIGID.label, 4][0])
    return Outcome(checks, draw(pushes, locked, counts))


def factor(roughness: float) -> float:
    """Randolph & Houlsby (1984)."""
    delta = np.arcsin(roughness)
    corner = np.cos(delta / 2) + np.sin(delta / 2)
    return float(np.pi + 2 * delta + 2 * np.cos(delta) + 4 * corner)


def check_limits(
    disk: Disk, counts: tuple[int, ...], pushes: dict[tuple[str, int], list[Push]]
) -> list[Check]:
    """The limit load on each grid, and how much wider the disk acts."""
    checks: list[Check] = []
    exact, before, order = factor(disk.roughness), math.inf, None
    for count in counts:
        at = f"{disk.label}, h = D/{count}, places: {len(pushes[disk.label, count])}"
        load = float(np.mean([one.limit for one in pushes[disk.label, count]]))
        wider = (load / exact - 1) * count / 2
        if checks:
            order = observed_order(before - exact, load - exact)
        checks += [
            Check(
                f"{at}: load / (c D)",
                exact,
                load,
                min(exact, as_wide(disk, count, -0.5)),
                as_wide(disk, count, 0.5),
                "from the exact disk to one as wide as it may act by where it slips",
                order,
            ),
            Check.near(
                f"{at}: acts wider a side by, cells",
                expected=disk.reach,
                got=wider,
                within=0.5,
                why="slips in the middle of the cell outside of the nodes that move with the disk",
            ),
        ]
        before = load
    return checks


def as_wide(disk: Disk, count: int, side: float) -> float:
    """Load / (c D) of a disk that acts wider by its reach and so many cells, on either side."""
    return factor(disk.roughness) * (1 + 2 * (disk.reach + side) / count)


def check_locking(disk: Disk, count: int, cured: Push, locked: Push) -> list[Check]:
    at = f"{disk.label}, h = D/{count}"
    return [
        Check.at_least(
            f"{at}: load / (c D), point",
            bound=as_wide(disk, count, 0.5),
            got=locked.limit,
            why="locks: above any limit load, that of the disk as wide as it may act included",
        ),
        Check.at_most(
            f"{at}: gain of the load in the last third, cell average, share",
            bound=0.01,
            got=cured.gain,
            why="a limit load: flat but for its swing, 1 %",
        ),
        Check.at_least(
            f"{at}: gain of the load in the last third, point, share",
            bound=0.01,
            got=locked.gain,
            why="locks: no limit load, it goes on rising, by more than that",
        ),
    ]


def check_rate(count: int, found: Push) -> list[Check]:
    """Neither inertia nor viscosity add to the load."""
    slow = push(RIGID, count, PLACES[0], slower=2.0)
    blended = push(RIGID, count, PLACES[0], alpha=0.01)
    # Viscosity of the blend, see `gimpslope.Method`, at a step of 0.4 h / wave speed, in a band one
    # cell wide that shears by the speed of the disk.
    cell = DIAMETER / count
    nu = 0.01 * gs.kernel.second_moment("ugimp", cell / 4, cell=cell) * CLAY.wave_speed / 0.4 / cell
    viscous = nu * CLAY.density * PATH / DURATION / cell
    return [
        Check.near(
            f"rigid, h = D/{count}: load at half the speed, share",
            expected=1.0,
            got=slow.limit / found.limit,
            within=0.005,
            why="slow: twenty shear waves cross the disk meanwhile; half of the 1 % of its swing",
        ),
        Check.near(
            f"rigid, h = D/{count}: a blend of alpha = 0.01 adds, share",
            expected=viscous / COHESION,
            got=blended.limit / found.limit - 1,
            within=viscous / COHESION,
            why="its viscosity in a slip band of one cell, over c; all others have alpha = 0",
        ),
    ]


def push(
    disk: Disk,
    count: int,
    place: tuple[float, float],
    strain: Strain = "cell_average",
    *,
    slower: float = 1.0,
    alpha: float = 0.0,
) -> Push:
    """Push a disk of so many cells along PATH, in a square box with fixed walls."""
    cell = DIAMETER / count
    cells = round(2 * WALL / cell)
    along = (np.arange(2 * cells) + 0.5) * cell / 2
    lattice = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    middle = WALL + cell * np.array(place)
    inside = np.hypot(*(lattice - middle).T) < DIAMETER / 2
    volume = np.full(len(lattice), cell**2 / 4)
    walls = gs.Walls(gs.Fixed(), gs.Fixed(), gs.Fixed(), gs.Fixed())
    solver = gs.Solver(
        gs.Points(
            position=lattice,
            half_length=np.full_like(lattice, cell / 4),
            volume=volume,
            mass=volume * np.where(inside, disk.material.density, CLAY.density),
            material=inside.astype(np.int32),
            stone=np.where(inside, 0, -1),
        ),
        [CLAY, disk.material],
        cell=cell,
        walls=walls,
        wall_positions=(0.0, cells * cell, 0.0, cells * cell),
        stress=np.tile([-PRESSURE, -PRESSURE, -PRESSURE, 0.0], (len(lattice), 1)),
        method=gs.Method(alpha=alpha, volumetric_strain=strain),
    )
    duration, ramp, start = slower * DURATION, slower * RAMP, solver.position[inside, 0].mean()
    solver.body_force = np.where(inside[:, None], [PATH / duration / ramp, 0.0], 0.0)
    solver.advance_to(ramp)
    solver.body_force = np.zeros_like(lattice)
    mass = solver.mass[inside]
    times = np.linspace(ramp, duration + ramp / 2, ROWS + 1)
    momentum, path = np.empty((2, ROWS + 1))
    for row, time in enumerate(times):
        solver.advance_to(time)
        momentum[row] = mass @ solver.velocity[inside, 0]
        path[row] = solver.position[inside, 0].mean() - start
    return Push(
        (path[1:] + path[:-1]) / 2,
        -np.diff(momentum) / np.diff(times) / COHESION / DIAMETER,
        solver.position - middle,
        solver.plastic_strain,
    )


def draw(
    pushes: dict[tuple[str, int], list[Push]], locked: dict[str, Push], counts: tuple[int, ...]
) -> Figure:
    """Load against path, load against the cell, and where the clay has flowed."""
    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    curve, grids, flow = figure.subplots(1, 3, width_ratios=(1.2, 1.2, 1))
    cells = np.linspace(0.0, 1.1 / counts[0], 2)
    for number, disk in enumerate(DISKS):
        colour, exact = f"C{number}", factor(disk.roughness)
        for style, label, one in (
            ("-", f"{disk.label}, cell average", pushes[disk.label, counts[-1]][0]),
            ("--", f"{disk.label}, point", locked[disk.label]),
        ):
            curve.plot(one.path * 1e3, one.load, style, color=colour, label=label)
        for count in counts:
            limits = [one.limit / exact for one in pushes[disk.label, count]]
            grids.plot(np.full(len(limits), 1 / count), limits, "o", color=colour)
        low, high = (1 + 2 * (disk.reach + side) * cells for side in (-0.5, 0.5))
        grids.fill_between(
            cells, low, high, color=colour, alpha=0.2, linewidth=0, label=f"{disk.label}, expected"
        )
    for exact in {factor(disk.roughness) for disk in DISKS}:
        curve.axhline(exact, color="k", linewidth=0.8, label=f"exact, {exact:.2f}")
    curve.set(xlabel="path (mm)", ylabel="load / (c D)", xlim=(0, None), ylim=(0, None))
    curve.set_title(f"h = D/{counts[-1]}")
    curve.legend(loc="lower right", fontsize="small")
    grids.set(xlabel="h / D", ylabel="load / exact", xlim=(0, cells[-1]), ylim=(0.9, None))
    grids.axhline(1.0, color="k", linewidth=0.8)
    grids.legend(loc="upper left")
    _map(flow, pushes[RIGID.label, counts[-1]][0], DIAMETER / counts[-1])
    return figure


def _map(ax: Axes, found: Push, cell: float) -> None:
    """Plastic strain, a point a pixel, in parts of what yields."""
    strain = found.strain / (COHESION / CLAY.shear_modulus / np.sqrt(3))
    columns, rows = np.round(2 * (found.places - found.places.min(axis=0)) / cell).astype(int).T
    pixels = np.full((rows.max() + 1, columns.max() + 1), np.nan)
    pixels[rows, columns] = strain
    (left, bottom), (right, top) = found.places.min(axis=0), found.places.max(axis=0)
    extent = (left - cell / 4, right + cell / 4, bottom - cell / 4, top + cell / 4)
    image = ax.imshow(pixels, origin="lower", extent=extent, vmin=0, vmax=20, cmap="viridis")
    angle = np.linspace(0, 2 * np.pi, 200)
    ax.plot(DIAMETER / 2 * np.cos(angle), DIAMETER / 2 * np.sin(angle), "w-", linewidth=1)
    ax.set(xlabel="x (m)", ylabel="y (m)", title="rigid")
    ax.figure.colorbar(image, ax=ax, label="plastic strain / yield strain", extend="max")


PROBLEM = Problem("pushed_disk", "Disk pushed through clay", run)
