"""A rigid stone and the nodes that it holds, through a step."""

import numpy as np
from numpy.typing import NDArray

from .bodies import Body, Whole, cross
from .interface import APART, STUCK, WELDED, Interface, before_strain, face

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Held:
    """Of all nodes (n_nodes, 2) those `of` (n_nodes,) that the body holds; meeting (n_nodes,) is
    how soil along which it may slide met it in the last step, and is kept up to date."""

    def __init__(self, body: Body, nodes: Array, of: Mask, meeting: Array) -> None:
        self.body, self.nodes, self.of, self.meeting = body, nodes, of.copy(), meeting
        self.normal = np.zeros((int(of.sum()), 2))
        self.slides = body.friction is not None

    def touch(self, stone: tuple[Array, Array], soil: tuple[Array, Array]) -> None:
        """Leave those where soil does not touch the stone along which it may slide, by the shares
        of the nodes' cells that both fill, and their gradients."""
        found = face(stone, soil)
        self.of &= found.touching
        self.meeting[self.meeting == WELDED] = STUCK
        self.meeting[~found.known] = WELDED
        self.normal = found.normal[self.of]

    def before_strain(self, raw: Array) -> Array:
        """Velocities (k, 2) that the points are strained by, where soil alone had `raw`."""
        of_stone = self.body.velocity_at(self.nodes[self.of])
        if not self.slides:
            return of_stone
        return before_strain(self.meeting[self.of], self.normal, raw[self.of], of_stone)

    def with_stone(self) -> Mask:
        """The nodes that move with the stone."""
        return self.of & (self.meeting != APART) if self.slides else self.of

    def load(
        self, dt: float, weight: Array, given: Array, force: Array, local_damping: float
    ) -> None:
        """What its weight, the body forces `given` (n, 2) to its points, the `force` at the nodes
        and the damping of these, N/m, make of its momentum and angular momentum."""
        body, around = self.body, self.with_stone()
        pull = weight + given.sum(axis=0)
        turn = float(cross(body.arms(), given).sum())
        by_soil = force[around].sum(axis=0)
        turn_by_soil = float(cross(self.nodes[around] - body.centre, force[around]).sum())
        drag = -local_damping * np.abs(pull + by_soil) * np.sign(body.velocity)
        drag_moment = float(-local_damping * abs(turn + turn_by_soil) * np.sign(body.spin))
        if not self.slides:
            pull, turn = pull + by_soil, turn + turn_by_soil
        self.drag = drag, drag_moment
        self.momentum = body.mass * body.velocity + dt * (pull + drag)
        self.turn = body.inertia * body.spin + dt * (turn + drag_moment)

    def join(self, mass: Array, brought: Array, free: Array) -> None:
        """Stone and nodes as one body or, where soil may slide, as two that meet: nodes of a mass,
        with the momentum that the points brought, which alone would come to the velocity `free`."""
        one = np.zeros_like(self.of) if self.slides else self.of
        self.whole = Whole(
            self.body, self.momentum, self.turn, self.nodes[one], mass[one], brought[one]
        )
        self.interface: Interface | None = None
        if self.slides:
            of = self.of
            self.interface = Interface(
                self.body,
                self.whole,
                self.nodes[of],
                self.normal,
                self.meeting[of],
                mass[of],
                free[of],
            )

    def settle(self) -> None:
        """Soil that may slide takes what the stone's motion gives it."""
        if self.interface is not None:
            self.interface.settle()

    def part(self, before: Array) -> tuple[Array, float]:
        """Velocities (k, 2) of the nodes after the step, and what friction took, J/m, where the
        points were strained by `before` (n_nodes, 2)."""
        place = self.nodes[self.of]
        if self.interface is None:
            return self.whole.velocity_at(place), 0.0
        after = self.interface.velocity()
        rubbed = self.interface.rubbed(before[self.of], after, self.body.velocity_at(place))
        self.meeting[:] = APART
        self.meeting[self.of] = self.interface.meeting
        return after, rubbed
