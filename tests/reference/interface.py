"""Soil that may slide along a rigid stone: Coulomb friction without tension at nodes it holds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .bodies import Body, Whole, cross, quarter_turn

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

TOUCH = 0.1  # largest gap, cells
NO_SLOPE = 1e-3
ROUNDING = 1e-12
SETTLINGS, FEWEST_ROUNDS, MOST_ROUNDS = 30, 5, 80
APART, SLIPPING, STUCK, WELDED = range(4)


@dataclass
class Face:
    """At each node: the normal of a stone's surface (n_nodes, 2), whether there is one, and whether
    soil and stone touch there."""

    normal: Array
    known: Mask
    touching: Mask


def face(stone: tuple[Array, Array], soil: tuple[Array, Array]) -> Face:
    """From the shares (n_nodes,) of the nodes' cells that stone and soil fill, and their gradients
    a cell (n_nodes, 2): the normal down the steeper one of both (Nairn 2013)."""
    downhill = np.array([-stone[1], soil[1]])  # from the stone into the soil
    steep = np.hypot(downhill[..., 0], downhill[..., 1])
    steepest = steep.max(axis=0)
    known = steepest > NO_SLOPE
    chosen = np.where((steep[1] > steep[0])[:, None], downhill[1], downhill[0])
    normal = chosen / np.where(known, steepest, 1.0)[:, None]
    gap = sum(
        beyond_edge(share, (slope * normal).sum(axis=1))
        for share, slope in zip((stone[0], soil[0]), downhill, strict=True)
    )
    return Face(normal, known, ~known | (gap <= TOUCH))


def beyond_edge(share: Array, slope: Array) -> Array:
    """Distance (n,) in cells from a node to the edge of a half-plane with that share of the node's
    cell and that slope: the root of (share of a half-plane) / (its slope) = share / slope."""
    ratio = share / np.where(slope > NO_SLOPE, slope, 1.0)
    outside = 1 - 2 * ratio
    inside = np.sqrt(ratio**2 + 2) - ratio - 1
    found = np.where(ratio <= 0.5, outside, inside)
    return np.asarray(np.where(slope > NO_SLOPE, found, np.where(share > 0.5, -1.0, 1.0)))


def before_strain(meeting: Array, normal: Array, soil: Array, stone: Array) -> Array:
    """Velocities (k, 2) of soil that touches the stone, which has velocities of its own there: not
    into it, nor off it or along it where it was held so in the step before."""
    off = np.sum((soil - stone) * normal, axis=1)
    across = quarter_turn(normal)
    along = np.sum((soil - stone) * across, axis=1)
    v = soil - np.where((meeting != APART) | (off < 0), off, 0.0)[:, None] * normal
    v = v - np.where(meeting == STUCK, along, 0.0)[:, None] * across
    return np.where((meeting == WELDED)[:, None], stone, v)


class Interface:
    """A stone and the k nodes of soil around it: place (k, 2), normal, meeting (k,), mass (k,), and
    the velocity (k, 2) that the soil has without the stone."""

    def __init__(
        self,
        body: Body,
        whole: Whole,
        place: Array,
        normal: Array,
        meeting: Array,
        mass: Array,
        free: Array,
    ) -> None:
        self.body, self.whole = body, whole
        self.normal, self.meeting, self.mass, self.free = normal, meeting.copy(), mass, free
        arm = place - body.centre
        self.place = place
        self.motion_at = np.zeros((len(place), 2, 3))  # velocity there from (vx, vy, spin)
        self.motion_at[:, 0, 0] = self.motion_at[:, 1, 1] = 1.0
        self.motion_at[:, :, 2] = quarter_turn(arm)
        self.inertia = np.diag([body.mass, body.mass, body.inertia])
        self.taken = np.zeros((len(place), 2))
        self.slip = np.zeros(len(place))  # its direction along the surface where soil slips
        self.settle()

    def settle(self) -> None:
        """The impulses that the soil takes, for the present motion of the whole with those that it
        has taken so far; `unsettled` is what they leave, as a speed of the stone."""
        motion = np.append(self.whole.velocity, self.whole.spin)
        self.alone = motion + np.linalg.solve(self.inertia, self._sum(self.taken))
        soil_alone = float(self.mass @ (self.free**2).sum(axis=1))
        nothing = ROUNDING**2 * (self._energy(self.alone) + soil_alone)
        rounds, self.unsettled = FEWEST_ROUNDS, 0.0
        settled = self._settle_at_once(motion, nothing)
        while not settled and rounds <= MOST_ROUNDS:
            settled = self._settle_in_turn(rounds, nothing) == 0
            settled = settled or self._settle_at_once(self._moved(), nothing)
            rounds *= 2
        if not settled:
            self.unsettled = self._settle_in_turn(MOST_ROUNDS, nothing)
        result = self._moved()
        self.whole.velocity, self.whole.spin = result[:2], float(result[2])

    def _settle_at_once(self, motion: Array, nothing: float) -> bool:
        """Newton's method on a function that is linear for given meetings, with steps halved as
        long as they leave more than there was; whether it finds the motion."""
        start, step, share, least = motion, np.zeros(3), 1.0, np.inf
        for settling in range(SETTLINGS):
            same = self._meet(motion)
            left = self._energy(motion - self._moved())
            if left <= nothing or (settling > 0 and share == 1.0 and same):
                return True
            if left < least:
                start, step, share, least = motion, self._target() - motion, 1.0, left
            else:
                share /= 2
            motion = start + share * step
        return False

    def _settle_in_turn(self, rounds: int, nothing: float) -> float:
        """The impulse of one node after the other that meets the law if all others stay: inelastic
        along the normal, and across it as much friction as is needed or can be had. From none, for
        those of Newton's method may have added energy. The change by the last round, as a speed of
        the stone."""
        self.taken = np.zeros_like(self.taken)
        flexible, across = np.linalg.inv(self.inertia), quarter_turn(self.normal)
        for _ in range(rounds):
            before = self._moved()
            for k, at in enumerate(self.motion_at):
                self.taken[k] = 0.0
                apart = self.free[k] - at @ self._moved()
                yields = np.eye(2) / self.mass[k] + at @ flexible @ at.T
                frame = np.array([self.normal[k], across[k]])
                if self.meeting[k] == WELDED:
                    self.taken[k] = -np.linalg.solve(yields, apart)
                    continue
                pushed, self.meeting[k], self.slip[k] = self._met(
                    frame @ apart, frame @ yields @ frame.T
                )
                self.taken[k] = pushed @ frame
            left = self._energy(before - self._moved())
        return 0.0 if left <= nothing else float(np.sqrt(left / self.body.mass))

    def _met(self, apart: Array, yields: Array) -> tuple[Array, int, float]:
        """Impulse, meeting and slip of a node, along and across the normal: from its velocity
        without the impulse, and the matrix by which that changes with it. Soil that runs in and
        does not slip either way sticks."""
        rough = self.body.friction
        assert rough is not None
        if apart[0] >= 0:
            return np.zeros(2), APART, 0.0
        for slip in (1.0, -1.0):
            along = np.array([1.0, -slip * rough])
            pushing = yields[0] @ along
            impulse = -apart[0] / pushing * along
            if pushing > 0 and slip * (apart + yields @ impulse)[1] > 0:
                return impulse, SLIPPING, slip
        return -np.linalg.solve(yields, apart), STUCK, 0.0

    def _energy(self, motion: Array) -> float:
        """Twice the kinetic energy of the stone."""
        return float(motion @ self.inertia @ motion)

    def _meet(self, motion: Array) -> bool:
        """The impulses at a motion of the stone; whether soil meets it and slips as before."""
        apart = self.free - self.motion_at @ motion
        meeting = self._meeting(apart)
        slip = np.where(meeting == SLIPPING, np.sign(cross(self.normal, apart)), 0.0)
        same = bool((meeting == self.meeting).all() and (slip == self.slip).all())
        self.meeting, self.slip = meeting, slip
        self.taken = -np.einsum("kij,kj->ki", self._answer(), apart)
        return same

    def _moved(self) -> Array:
        """The stone's motion with the impulses."""
        return np.asarray(self.alone - np.linalg.solve(self.inertia, self._sum(self.taken)))

    def _target(self) -> Array:
        """The motion whose impulses lead to it, if the meetings stay."""
        answer, at = self._answer(), self.motion_at
        matrix = self.inertia + np.einsum("kia,kij,kjb->ab", at, answer, at)
        given = self.inertia @ self.alone + self._sum(np.einsum("kij,kj->ki", answer, self.free))
        return np.asarray(np.linalg.solve(matrix, given))

    def velocity(self) -> Array:
        """Of the soil after the impulses, (k, 2)."""
        return np.asarray(self.free + self.taken / self.mass[:, None])

    def rubbed(self, before: Array, after: Array, stone_before: Array) -> float:
        """What friction takes, J/m: its impulse times the mean slip, along the surface."""
        across = quarter_turn(self.normal)
        slip = (before + after - stone_before - self.whole.velocity_at(self.place)) / 2
        work = -np.sum(self.taken * across, axis=1) * np.sum(slip * across, axis=1)
        return float(work[self.meeting == SLIPPING].sum())

    def _sum(self, impulses: Array) -> Array:
        return np.asarray(np.einsum("kia,ki->a", self.motion_at, impulses))

    def _meeting(self, apart: Array) -> Array:
        into = -np.sum(apart * self.normal, axis=1)
        along = np.abs(cross(self.normal, apart))
        rough = self.body.friction
        assert rough is not None
        met = np.where(into <= 0, APART, np.where(along > rough * into, SLIPPING, STUCK))
        return np.asarray(np.where(self.meeting == WELDED, WELDED, met))

    def _answer(self) -> Array:
        """The matrices (k, 2, 2) that turn the approach of the soil into the impulse it takes."""
        across, rough = quarter_turn(self.normal), self.body.friction
        assert rough is not None
        pushed = self.normal - self.slip[:, None] * rough * across
        slipping = np.einsum("ki,kj->kij", pushed, self.normal)
        factor = np.where((self.meeting == SLIPPING)[:, None, None], slipping, np.eye(2))
        factor = np.where((self.meeting == APART)[:, None, None], 0.0, factor)
        return np.asarray(self.mass[:, None, None] * factor)
