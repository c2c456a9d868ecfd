"""A ring is twisted to and fro: every circle of it turns by its own angle.

alpha(R, t) = A sin(pi t / T) (1 - 32 s^2 + 256 s^4) for s = R - 1 from -1/4 to 1/4 m, where the
turn and its slope vanish (generalized vortex: Kamojjala, Brannon, Sadeghirad and Guilkey 2015, Eng.
Comput. 31). With gamma = R d alpha / dR and w = d alpha / dt a Jaumann law gives s_rt = G sin gamma
and s_tt = -s_rr = G (1 - cos gamma), which takes the force

    b_r = -R w^2 + (G / rho) (gamma' sin gamma + 2 (1 - cos gamma) / R)
    b_t = R dw/dt - (G / rho) (gamma' cos gamma + 2 sin gamma / R).

It is a thousand times the inertia, so what the grid misses of it would set a free ring turning: the
ring lies in a square of the same material, at rest, with its sides held. A point at an edge takes
the share of the force that its domain has in the ring. Beyond a gamma of 60 degrees (A = 0.149) the
law is not elliptic: G is less than half the difference of the main stresses. Well below that a
share of PIC is needed, lest the noise of points that cross cells grow. Start values are given at
their own times, as in the manufactured solution in a square.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

import gimpslope as gs

from ..._check import FloatArray
from ...method import Shape
from ..check import Check
from .problem import Outcome, Problem

MATERIAL = gs.Elastic(density=1000.0, young=1e6, poisson=0.3)
SHEAR = MATERIAL.shear_modulus  # G, Pa
AMPLITUDE, PERIOD = 0.1, 1.0  # A, rad, and T, s
HALF_WIDTH, HALF_SIDE, HOLE = 0.25, 1.375, 0.5  # of the ring, the square, and a hole in it, m
SHAPES: dict[Shape, str] = {"linear": "linear", "ugimp": "uGIMP", "cpgimp": "cpGIMP, stretch"}


def run(full: bool) -> Outcome:
    """The error of each shape function on finer and finer grids."""
    cells = [8, 16, 32] if full else [8, 16]
    twists = {shape: [twist(n, shape) for n in cells] for shape in SHAPES}
    errors = {shape: np.array([one.error for one in ones]) for shape, ones in twists.items()}
    orders = {shape: float(np.log2(error[-2] / error[-1])) for shape, error in errors.items()}
    worst = [one.worst for one in twists["cpgimp"]]
    at_edge = float(np.log2(worst[-2] / worst[-1]))
    checks = [
        Check.near(
            "cpGIMP, stretch: order of the RMS error, last halving",
            expected=2.0,
            got=orders["cpgimp"],
            within=0.2,
            why="second order in h; 0.2 for the next one on a ring of 4 to 16 cells",
            order=orders["cpgimp"],
        ),
        Check.at_least(
            "cpGIMP, stretch: order of the largest error of a point, last halving",
            bound=1.0,
            got=at_edge,
            why="at the edges, where the force jumps within a cell: 1 to 2",
            order=at_edge,
        ),
        Check.at_least(
            "uGIMP: order of the RMS error, last halving",
            bound=1.0,
            got=orders["ugimp"],
            why="no volume changes, so domains of the first size nearly fit: it converges",
            order=orders["ugimp"],
        ),
        Check.at_most(
            "linear: order of the RMS error, last halving",
            bound=0.5,
            got=orders["linear"],
            why="points cross more edges on finer grids: no convergence",
            order=orders["linear"],
        ),
    ]
    return Outcome(checks, draw(cells, errors, {shape: ones[-1] for shape, ones in twists.items()}))


class Twist(NamedTuple):
    """Largest root-mean-square error of the places in a period and largest of a point, m (infinite
    where the run fails), and the points' radius (m) and turn (degrees) at half time."""

    error: float
    worst: float
    radius: FloatArray
    turn: FloatArray


def twist(cells: int, shape: Shape) -> Twist:
    """The ring through one period."""
    spacing = 0.5 / cells
    side = np.arange(spacing / 2 - HALF_SIDE, HALF_SIDE, spacing)
    place = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    place = place[np.hypot(*place.T) > HOLE]
    inside = np.abs(np.hypot(*place.T) - 1) < HALF_WIDTH + spacing / 2
    ring = Ring(place[inside], spacing)
    steps = int(np.ceil(PERIOD * MATERIAL.wave_speed * cells / 0.4))
    step = PERIOD / steps

    def everywhere(values: FloatArray) -> FloatArray:
        """Zero outside the ring."""
        whole = np.zeros((len(place), values.shape[1]))
        whole[inside] = values
        return whole

    volume = np.full(len(place), spacing**2)
    solver = gs.Solver(
        gs.Points(
            position=place,
            half_length=np.full_like(place, spacing / 2),
            volume=volume,
            mass=volume * MATERIAL.density,
            material=np.zeros(len(place), dtype=np.int32),
        ),
        [MATERIAL],
        cell=1 / cells,
        walls=gs.Walls(gs.Fixed(), gs.Fixed(), gs.Fixed(), gs.Fixed()),
        wall_positions=(-HALF_SIDE, HALF_SIDE, -HALF_SIDE, HALF_SIDE),
        velocity=everywhere(ring.velocity(-step / 2)),
        stress=everywhere(ring.stress(-step)),
        method=gs.Method(
            shape=shape,
            domain_update="stretch" if shape == "cpgimp" else None,
            alpha=0.1,
            time_step=step,
        ),
    )
    error, worst, turn = 0.0, 0.0, np.zeros(len(ring.radius))
    try:
        for n in range(steps):
            solver.body_force = everywhere(ring.force(n * step))
            solver.step()
            if n % 10 == 9:
                off = np.hypot(*(solver.position[inside] - ring.place((n + 1) * step)).T)
                error = max(error, float(np.sqrt((off**2).mean())))
                worst = max(worst, float(off.max()))
            if n == steps // 2:
                x, y = solver.position[inside].T
                turn = np.degrees(np.angle((x + 1j * y) * np.exp(-1j * ring.angle)))
    except gs.Diverged:
        error = worst = np.inf
    return Twist(error, worst, ring.radius, turn)


class Ring:
    """The closed form at points of the ring, which lie at `place` (n, 2) when it is not twisted."""

    def __init__(self, place: FloatArray, spacing: float) -> None:
        self.radius, self.angle = np.hypot(*place.T), np.arctan2(place[:, 1], place[:, 0])
        s = np.clip(self.radius - 1, -HALF_WIDTH, HALF_WIDTH)
        slope, bend = -64 * s + 1024 * s**3, -64 + 3072 * s**2
        self.turn = 1 - 32 * s**2 + 256 * s**4  # alpha, gamma and gamma' over the swing
        self.shear, self.bend = self.radius * slope, slope + self.radius * bend
        self.share = np.clip((HALF_WIDTH - np.abs(self.radius - 1)) / spacing + 0.5, 0, 1)

    def along(self, radial: FloatArray, tangential: FloatArray, time: float) -> FloatArray:
        """Vectors (n, 2) with these components at a time."""
        angle = self.angle + self.turn * swing(time)
        cosine, sine = np.cos(angle), np.sin(angle)
        return np.column_stack(
            [radial * cosine - tangential * sine, radial * sine + tangential * cosine]
        )

    def place(self, time: float) -> FloatArray:
        """m."""
        return self.along(self.radius, 0 * self.radius, time)

    def velocity(self, time: float) -> FloatArray:
        """m/s."""
        rate = self.turn * AMPLITUDE * np.pi / PERIOD * np.cos(np.pi * time / PERIOD)
        return self.along(0 * rate, self.radius * rate, time)

    def stress(self, time: float) -> FloatArray:
        """xx, yy, zz, xy, Pa."""
        shear = self.shear * swing(time)
        double = 2 * (self.angle + self.turn * swing(time))
        across, along = SHEAR * np.sin(shear), SHEAR * (1 - np.cos(shear))
        xx = -along * np.cos(double) - across * np.sin(double)
        xy = -along * np.sin(double) + across * np.cos(double)
        return np.column_stack([xx, -xx, 0 * xx, xy])

    def force(self, time: float) -> FloatArray:
        """A unit of mass, m/s2."""
        stiffness = SHEAR / MATERIAL.density
        shear, bend, radius = self.shear * swing(time), self.bend * swing(time), self.radius
        rate = self.turn * AMPLITUDE * np.pi / PERIOD * np.cos(np.pi * time / PERIOD)
        gain = -self.turn * (np.pi / PERIOD) ** 2 * swing(time)
        sine, cosine = np.sin(shear), np.cos(shear)
        radial = -radius * rate**2 + stiffness * (bend * sine + 2 * (1 - cosine) / radius)
        tangential = radius * gain - stiffness * (bend * cosine + 2 * sine / radius)
        return self.along(self.share * radial, self.share * tangential, time)


def swing(time: float) -> float:
    """Angle of the middle of the ring, rad."""
    return AMPLITUDE * float(np.sin(np.pi * time / PERIOD))


def draw(cells: list[int], errors: dict[Shape, FloatArray], finest: dict[Shape, Twist]) -> Figure:
    """How far the circles turn, and the error against the cells."""
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    turn, error = figure.subplots(1, 2)
    for shape, one in finest.items():
        turn.plot(one.radius, one.turn, ".", markersize=2, label=SHAPES[shape])
    radius = np.linspace(1 - HALF_WIDTH, 1 + HALF_WIDTH, 201)
    exact = Ring(np.column_stack([radius, 0 * radius]), 1.0).turn * np.degrees(AMPLITUDE)
    turn.plot(radius, exact, "k-", linewidth=0.8, label="exact")
    turn.set(xlabel="radius (m)", ylabel="turn at half time (degrees)", ylim=(-0.5, 13))
    turn.legend(loc="upper right", title=f"{cells[-1]} cells a metre", markerscale=3)
    for shape, mark in zip(SHAPES, "^so", strict=True):
        error.loglog(cells, errors[shape] / AMPLITUDE, f"{mark}-", ms=4, label=SHAPES[shape])
    error.loglog(cells, 3 / np.square(cells), "k:", linewidth=0.8, label="second order")
    error.set(xlabel="cells a metre", ylabel="largest RMS error / A (m)")
    low, high = min(map(np.min, errors.values())), max(map(np.max, errors.values()))
    error.set_ylim(0.2 * low / AMPLITUDE, 10 * high / AMPLITUDE)
    error.set_xticks(cells, [str(n) for n in cells])
    error.xaxis.set_minor_locator(NullLocator())
    error.legend(loc="upper right", ncols=2)
    return figure


PROBLEM = Problem("vortex", "Generalized vortex", run)
