"""Stones that do not deform, in a velocity field of their own.

A stone holds nodes by the share of their cells that it fills; with these it is one rigid body that
takes up the forces of the soil there, unless soil may slide along it, and that walls and other
stones push. Its own points give the
grid nothing and take nothing from it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from .shapes import weights
from .walls import SIDES, Wall

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

HELD_SHARE = 0.0774  # of a cell, or of the largest share where that is below one
SPREAD = 1e-3  # at a wall: by how much of its distance to the side a place counts as nearer
SWEEPS, MOST_SWEEPS = 30, 300
STILL = 1e-6  # cells a step
SEEN = 0.1  # gap of stones at which a contact begins to be watched, cells
SURROUND = 1.5  # distance of the points that tell its normal, cells
_SIGNS = np.array([-1.0, 1.0])


@dataclass
class Rigid:
    """The material of a rigid stone, kg/m3, and its friction along soil, which otherwise sticks to
    it, and along other stones, degrees."""

    density: float
    friction: float | None = None
    mutual_friction: float = 0.0


class Body:
    """A stone: the indices `of` its points, its shape, where it is, and what has pushed it.

    centre (2,), m; angle, radians; velocity (2,), m/s; spin, radians a second; impulse (2,) of all
    but gravity, N s/m; angular_impulse, N m s/m.
    """

    def __init__(
        self,
        of: NDArray[np.int64],
        position: Array,
        velocity: Array,
        mass: Array,
        volume: Array,
        half_length: Array,
        material: Rigid,
    ) -> None:
        self.friction = None if material.friction is None else np.tan(np.radians(material.friction))
        self.mutual_friction = float(np.tan(np.radians(material.mutual_friction)))
        self.of, self.point_mass = of, mass[of]
        self.volume, self.half_length = volume[of], half_length[of]
        self.mass = float(self.point_mass.sum())
        self.centre = self.point_mass @ position[of] / self.mass
        self.offset = position[of] - self.centre
        of_places = float(np.sum(self.point_mass[:, None] * self.offset**2))
        self.inertia = of_places + float(np.sum(self.point_mass[:, None] * self.half_length**2) / 3)
        reach = np.hypot(*self.offset.T) + np.hypot(*self.half_length.T)
        self.radius = float(reach.max())
        self.angle = 0.0
        self.velocity = self.point_mass @ velocity[of] / self.mass
        turn = self.point_mass @ cross(self.offset, velocity[of])
        self.spin = float(turn / of_places) if of_places > 0 else 0.0
        self.impulse, self.angular_impulse = np.zeros(2), 0.0

    def arms(self) -> Array:
        """From the centre to its points as they are."""
        cosine, sine = np.cos(self.angle), np.sin(self.angle)
        return self.offset @ np.array([[cosine, sine], [-sine, cosine]])

    def points(self) -> tuple[Array, Array]:
        """Places and velocities of its points."""
        place = self.centre + self.arms()
        return place, self.velocity_at(place)

    def velocity_at(self, place: Array) -> Array:
        return self.velocity + self.spin * quarter_turn(place - self.centre)

    def energy(self) -> float:
        """Kinetic, J/m."""
        return (self.mass * float(self.velocity @ self.velocity) + self.inertia * self.spin**2) / 2

    def stop(self) -> None:
        """What ends its motion counts as an impulse."""
        self.impulse = self.impulse - self.mass * self.velocity
        self.angular_impulse -= self.inertia * self.spin
        self.velocity, self.spin = np.zeros(2), 0.0

    def follow(
        self,
        whole: "Whole",
        dt: float,
        gravity: Array,
        full_gravity: Array,
        body_force: Array,
        drag: tuple[Array, float],
    ) -> tuple[float, float, float]:
        """Move as the whole does. Returns the energy that its surroundings give it, the work of
        body forces and of the part of gravity that a ramp holds back, and that of damping.

        body_force (n, 2) is that of its points, N/m; drag a force, N/m, and its moment.
        """
        velocity = whole.velocity_at(self.centre)
        moved, turned = dt * velocity, dt * whole.spin
        given = float(
            body_force.sum(axis=0) @ moved + cross(self.arms(), body_force).sum() * turned
        )
        damped = float(drag[0] @ moved) + drag[1] * turned
        before = self.energy()
        self.impulse = self.impulse + self.mass * (velocity - self.velocity - dt * gravity)
        self.angular_impulse += self.inertia * (whole.spin - self.spin)
        self.velocity, self.spin = velocity, whole.spin
        self.centre, self.angle = self.centre + moved, self.angle + turned
        gain = self.energy() - before - self.mass * float(gravity @ moved) - given - damped
        return gain, given + self.mass * float((gravity - full_gravity) @ moved), damped


class Whole:
    """A body and the nodes it holds as one, with their momentum and angular momentum.

    Of the nodes place and momentum (k, 2) and mass (k,); of the body momentum (2,) and angular
    momentum about its centre, with what all forces add to them.
    """

    def __init__(
        self, body: Body, momentum: Array, turn: float, place: Array, mass: Array, of_nodes: Array
    ) -> None:
        self.mass = body.mass + float(mass.sum())
        self.centre = (body.mass * body.centre + mass @ place) / self.mass
        arms, own = place - self.centre, body.centre - self.centre
        self.inertia = body.inertia + body.mass * float(own @ own) + float(mass @ (arms**2).sum(1))
        self.velocity = (momentum + of_nodes.sum(axis=0)) / self.mass
        turn = turn + float(cross(own, momentum) + cross(arms, of_nodes).sum())
        self.spin = turn / self.inertia

    def velocity_at(self, place: Array) -> Array:
        return self.velocity + self.spin * quarter_turn(place - self.centre)

    def push(self, place: Array, impulse: Array) -> None:
        self.velocity = self.velocity + impulse / self.mass
        self.spin += float(cross(place - self.centre, impulse)) / self.inertia


def shares(
    bodies: Sequence[Body],
    shape: str,
    lines: tuple[Array, Array],
    cell: float,
    walls: Sequence[Wall],
) -> tuple[Array, Array]:
    """The share of each node's cell that each body fills, (n_bodies, n_nodes), and its gradient a
    cell, (n_bodies, n_nodes, 2)."""
    share, slope = [], []
    for body in bodies:
        s, sx, sy = weights(shape, body.points()[0], body.half_length, lines, cell, walls)
        share.append(body.volume @ s / cell**2)
        slope.append(-np.stack([body.volume @ sx, body.volume @ sy], axis=1) / cell)
    return np.array(share), np.array(slope)


def least_share(share: Array) -> Array:
    """The share from which on each body holds a node, (n_bodies, 1)."""
    return np.asarray(HELD_SHARE * np.minimum(share.max(axis=1, keepdims=True), 1.0))


def held_nodes(share: Array, allowed: Mask) -> Mask:
    """The nodes that each body holds; of several bodies the one with the largest share may."""
    largest = share.argmax(axis=0) == np.arange(len(share))[:, None]  # the first one on a tie
    return np.asarray((share >= least_share(share)) & largest & allowed)


def near_walls(nodes: Array, walls: Sequence[Wall], cell: float) -> Mask:
    """Nodes on or beyond a wall, which no body holds."""
    near = np.zeros(len(nodes), bool)
    for (axis, into), (kind, _, position) in zip(SIDES, walls, strict=True):
        near |= (kind != "free") & (into * (nodes[:, axis] - position) >= -1e-9 * cell)
    return near


@dataclass
class Contact:
    """Where a body meets a wall or the `other` body; the normal (2,) points away from these."""

    body: int
    other: int | None
    normal: Array
    place: Array
    closing: float  # the speed that would close the gap in the step
    still: float  # a speed that moves nothing in the step
    friction: float
    pushed: float = 0.0
    rubbed: float = 0.0


def stone_contacts(bodies: Sequence[Body], cell: float, dt: float) -> Iterator[Contact]:
    """Contacts of bodies, where points of them lie next to each other."""
    for a, b in combinations(range(len(bodies)), 2):
        between = np.hypot(*(bodies[a].centre - bodies[b].centre))
        if between <= bodies[a].radius + bodies[b].radius + SEEN * cell:
            yield from _contacts_of(a, b, bodies, cell, dt)


def _contacts_of(
    a: int, b: int, bodies: Sequence[Body], cell: float, dt: float
) -> Iterator[Contact]:
    places, others = bodies[a].points()[0], bodies[b].points()[0]
    size, other_size = (np.sqrt(bodies[i].half_length.prod(axis=1)) for i in (a, b))
    friction = min(bodies[i].mutual_friction for i in (a, b))
    for place, half in zip(places, size, strict=True):
        k = int(np.hypot(*(others - place).T).argmin())
        between, middle = place - others[k], (place + others[k]) / 2
        both = half + other_size[k]
        if between @ between > (both + SEEN * cell) ** 2 + both**2:
            continue
        around = max(SURROUND * cell, float(np.hypot(*between)))
        near, opposite = (of[np.hypot(*(of - middle).T) <= around] for of in (places, others))
        line = shortest_between(near, opposite)
        normal = line / np.hypot(*line)
        gap = float(between @ normal) - both
        if gap <= SEEN * cell and abs(cross(normal, between)) <= both:
            yield Contact(a, b, normal, middle, max(gap, 0.0) / dt, STILL * cell / dt, friction)


def shortest_between(a: Array, b: Array) -> Array:
    """From b to a, the shortest line between the convex hulls of points a (n, 2) and b (m, 2) that
    lie apart: it begins or ends at one of these, and ends on a chord of the others."""
    lines = np.concatenate([_to_chords(a, b), -_to_chords(b, a)])
    return np.asarray(lines[np.hypot(*lines.T).argmin()])


def _to_chords(points: Array, others: Array) -> Array:
    """From the chords of the others, which are points too, the shortest line to each point."""
    first, second = others[:, None], others[None]
    chord = second - first
    square = (chord**2).sum(axis=-1)
    offset = points[:, None, None] - first
    share = (offset * chord).sum(axis=-1) / np.where(square > 0, square, 1.0)
    lines = offset - np.clip(share, 0.0, 1.0)[..., None] * chord
    return np.asarray(lines.reshape(-1, 2))


def wall_contacts(
    number: int, body: Body, walls: Sequence[Wall], cell: float, dt: float
) -> Iterator[Contact]:
    """Contacts of a body with the walls near it, one to either side of its centre."""
    for (axis, into), (kind, friction, position) in zip(SIDES, walls, strict=True):
        away = into * (position - body.centre[axis])
        if kind == "free" or away - body.radius > cell:
            continue
        arms = body.arms()
        arms[:, axis] += into * body.half_length[:, axis]
        along = arms[:, 1 - axis]
        arms[:, 1 - axis] += np.where(along > 0, 1.0, -1.0) * body.half_length[:, 1 - axis]
        gap, along = away - into * arms[:, axis], arms[:, 1 - axis]
        rank = gap - SPREAD * np.abs(along)
        for side in (along <= 0, along > 0):
            if not side.any() or rank[side].min() >= 2 * cell:
                continue
            k = np.flatnonzero(side)[rank[side].argmin()]
            normal = np.zeros(2)
            normal[axis] = -into
            most = {"fixed": 1e300, "coulomb": friction, "roller": 0.0}[kind]
            closing, still = max(gap[k], 0.0) / dt, STILL * cell / dt
            yield Contact(number, None, normal, body.centre + arms[k], closing, still, most)


def resolve(
    contacts: Sequence[Contact],
    wholes: Sequence[Whole],
    settle: Callable[[int], None] = lambda body: None,
) -> None:
    """Impulses by which no body runs into what it touches: sequential iteration (Catto 2005).

    The same algorithm as the kernel's, whose result after so many sweeps, or more while the last
    one has moved something, is part of the method: at each contact in turn the impulse along the
    normal that leaves no closing speed beyond the one that closes the gap, of which the sum may not
    pull; then the one across that ends the sliding, of which the sum is at most the friction
    coefficient times the other. Between the sweeps each body that touches something settles with
    the soil that slides along it.
    """
    touching = sorted({b for c in contacts for b in (c.body, c.other) if b is not None})
    last, still = 0.0, min((contact.still for contact in contacts), default=0.0)
    for sweep in range(MOST_SWEEPS):
        if sweep >= SWEEPS and last <= still:
            break
        for body in touching if sweep else ():
            settle(body)
        last = 0.0
        for contact in contacts:
            sides = [(1.0, wholes[contact.body])]
            if contact.other is not None:
                sides.append((-1.0, wholes[contact.other]))
            speed, gain = _along(sides, contact.place, contact.normal)
            pushed = max(0.0, contact.pushed - (speed + contact.closing) / gain)
            _apply(sides, contact.place, (pushed - contact.pushed) * contact.normal)
            last = max(last, abs(pushed - contact.pushed) * gain)
            contact.pushed = pushed
            if contact.friction == 0:
                continue
            tangent = quarter_turn(contact.normal)
            speed, gain = _along(sides, contact.place, tangent)
            most = contact.friction * pushed
            rubbed = min(most, max(-most, contact.rubbed - speed / gain))
            _apply(sides, contact.place, (rubbed - contact.rubbed) * tangent)
            last = max(last, abs(rubbed - contact.rubbed) * gain)
            contact.rubbed = rubbed


def _along(
    sides: Sequence[tuple[float, Whole]], place: Array, direction: Array
) -> tuple[float, float]:
    """Relative speed at a contact along a direction, and what a unit impulse adds to it."""
    speed = sum(sign * float(whole.velocity_at(place) @ direction) for sign, whole in sides)
    gain = sum(
        1 / whole.mass + float(cross(place - whole.centre, direction)) ** 2 / whole.inertia
        for _, whole in sides
    )
    return speed, gain


def _apply(sides: Sequence[tuple[float, Whole]], place: Array, impulse: Array) -> None:
    for sign, whole in sides:
        whole.push(place, sign * impulse)


def cross(a: Array, b: Array) -> Array:
    """z of a x b for vectors (..., 2) in the plane."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def quarter_turn(a: Array) -> Array:
    """z x a for vectors (..., 2) in the plane."""
    return np.asarray(a[..., ::-1] * _SIGNS)
