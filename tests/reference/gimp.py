"""The material points and their step: update stress first (USF), last (USL), or last from the
velocities that the points bring back (MUSL)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import ledger as accounts
from . import strain, transfer
from .bodies import (
    Body,
    Rigid,
    held_nodes,
    near_walls,
    resolve,
    shares,
    stone_contacts,
    wall_contacts,
)
from .drucker_prager import Material, moduli
from .held import Held
from .interface import APART
from .ledger import Ledger
from .points import Points
from .shapes import weights
from .walls import NO_MOTION, Wall, hold_momentum, hold_velocity

Array = NDArray[np.float64]


class Reference(Points):
    """Plane-strain material points on a fixed grid; arguments as for the compiled solver.

    Its state may be read and assigned, with ledger, J/m, and time; but for position and velocity of
    the points of rigid stones, which follow `bodies`, in the order of the stones' numbers. The grid
    reaches `margin` cells beyond the first positions; a point that leaves it is an error.
    """

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        half_length: ArrayLike,
        mass: ArrayLike,
        volume: ArrayLike,
        material: ArrayLike,
        materials: Sequence[Material | Rigid],
        stone: ArrayLike | None = None,
        *,
        cell: float,
        origin: tuple[float, float],
        walls: Sequence[Wall],
        shape: str,
        domain_update: str = "none",
        volume_update: str = "linear",
        volumetric_strain: str = "point",
        scheme: str = "usf",
        transfer: str = "flip",
        order: int = 1,
        blend: tuple[str, float],
        time_step: tuple[str, float],
        margin: int = 8,
    ) -> None:
        _check("shape", shape, "linear", "ugimp", "cpgimp", "quadratic_bspline")
        _check(
            "domain_update", domain_update, "none", "jacobian", "stretch", "deformation_diagonal"
        )
        _check("volume_update", volume_update, "linear", "exponential")
        _check("volumetric_strain", volumetric_strain, "point", "cell_average")
        _check("scheme", scheme, "usf", "usl", "musl")
        _check("transfer", transfer, "flip", "apic", "xpic")
        _check("blend", blend[0], "alpha", "viscosity", "relaxation_time")
        _check("time_step", time_step[0], "fixed", "courant")
        super().__init__(position, velocity, half_length, mass, volume, material, materials)
        self.time = 0.0
        n = len(self.position)
        number = np.full(n, -1) if stone is None else np.array(stone, int)
        square = np.repeat(np.sqrt(self.volume)[:, None] / 2, 2, axis=1)
        domain = self.half_length if "gimp" in shape else square
        self.bodies = [
            Body(
                np.flatnonzero(number == k),
                self.position,
                self.velocity,
                self.mass,
                self.volume,
                domain,
                self._rigid_material(number == k),
            )
            for k in np.unique(number[self.rigid])
        ]
        self._follow_bodies()

        self.cell, self.walls, self.shape = cell, list(walls), shape
        self.domain_update, self.volume_update = domain_update, volume_update
        self.volumetric_strain = volumetric_strain
        self.ledger = Ledger()
        self.scheme, self.blend, self.step_rule = scheme, blend, time_step
        self.transfer, self.order = transfer, order
        self.set_gravity(0.0, 0.0, 0.0)
        self.set_damping(0.0, False)

        low = np.floor((self.position.min(axis=0) - origin) / cell).astype(int) - margin
        high = np.ceil((self.position.max(axis=0) - origin) / cell).astype(int) + margin
        x = origin[0] + cell * np.arange(low[0], high[0] + 1)
        y = origin[1] + cell * np.arange(low[1], high[1] + 1)
        self.lines = (x, y)
        self.nodes = np.array([(a, b) for a in x for b in y])
        self.node_velocity = np.full_like(self.nodes, NO_MOTION)  # of the last step
        # how soil at the nodes met each stone in the last step
        self.meeting = np.full((len(self.bodies), len(self.nodes)), APART)

    def set_gravity(self, gx: float, gy: float, ramp: float) -> None:
        """Acceleration, m/s2, reached linearly over `ramp` seconds (0: at once)."""
        self.gravity, self.ramp = np.array([gx, gy]), ramp

    def set_damping(self, local: float, kinetic: bool) -> None:
        """Coefficient of local damping, and whether velocities are cleared at energy peaks."""
        self.local_damping, self.kinetic_damping = local, kinetic
        self.last_kinetic_energy = 0.0

    @property
    def time_step(self) -> float:
        """The step that comes next, s."""
        kind, value = self.step_rule
        if kind == "fixed":
            return value
        stiffness = np.zeros(len(self.mass))
        for material, of in self.deformable():
            _, shear, bulk = moduli(material)
            stiffness[of] = bulk + 4 * shear / 3
        wave = np.sqrt(stiffness * self.volume / self.mass).max()
        flow = np.linalg.norm(self.velocity, axis=1).max()
        return float(value * self.cell / (wave + flow))

    def alpha(self, dt: float) -> float:
        """Share of PIC in a step of dt."""
        kind, value = self.blend
        if kind == "alpha":
            return value
        if kind == "relaxation_time":
            return dt / value
        h = self.cell
        lp = {"linear": 0.0, "quadratic_bspline": h / 2}.get(
            self.shape, float(self.first_half_length.mean())
        )
        return value * dt / (h**2 * (1 / 6 + lp**2 / (3 * h**2)))

    def advance(self, steps: int) -> None:
        for _ in range(steps):
            self._step()

    def release_stress(self) -> float:
        """Return the present stress to the yield surface; elastic energy released, J/m."""
        released = strain.release(self)
        self.ledger.plastic += released
        return released

    def _step(self) -> None:
        dt = self.time_step
        s, sx, sy = weights(
            self.shape, self.position, self.half_length, self.lines, self.cell, self.walls
        )
        if not np.allclose(s.sum(axis=1), 1.0, atol=1e-9):
            raise RuntimeError("a point has left the grid; make margin larger")
        cells = None
        if self.volumetric_strain == "cell_average":
            corner = np.array([line[0] for line in self.lines])
            cells = strain.cell_numbers(self.position, corner, self.cell)

        mass = s.T @ self.soft_mass
        momentum = self._momentum(s)
        v_raw = _divide(momentum, mass)
        v = hold_velocity(v_raw, self.node_velocity, self.nodes, self.walls, self.cell)
        held = self._held(s, sx, sy, mass)
        for one in held:
            v[one.of] = one.before_strain(v_raw)

        if self.scheme == "usf":
            gradient = strain.velocity_gradient(self, sx, sy, v, cells)
            strain.deform(self, self.ledger, gradient, dt, self.volume_update)
        internal = strain.internal_force(self, sx, sy, cells)
        share_of_gravity = 1.0 if self.ramp == 0 else min(1.0, (self.time + dt) / self.ramp)
        weight = mass[:, None] * self.gravity * share_of_gravity
        body = s.T @ (self.soft_mass[:, None] * self.body_force)
        force = internal + weight + body
        damping = -self.local_damping * np.abs(force) * np.sign(v)

        brought = momentum
        momentum = hold_momentum(
            momentum + dt * (force + damping), self.nodes, self.walls, self.cell
        )
        v_new = _divide(momentum, mass)
        for one in held:
            pull = one.body.mass * self.gravity * share_of_gravity
            one.load(dt, pull, self._given(one.body), force, self.local_damping)
            damping[one.with_stone()] = 0.0
        contacts = list(stone_contacts(self.bodies, self.cell, dt))
        for number, one in enumerate(held):
            one.join(mass, brought, v_raw + _divide(dt * (force + damping), mass))
            contacts += wall_contacts(number, one.body, self.walls, self.cell, dt)
        resolve(contacts, [one.whole for one in held], lambda number: held[number].settle())
        for one in held:
            v_new[one.of], rubbed = one.part(v)
            self.ledger.friction += rubbed
            self.ledger.rigidity -= rubbed
        self.node_velocity = np.where(mass[:, None] > 0, v_new, NO_MOTION)
        accounts.nodes(
            self.ledger,
            places=self.nodes,
            walls=self.walls,
            cell=self.cell,
            dt=dt,
            mass=mass,
            raw=v_raw,
            before=v,
            after=v_new,
            internal=internal,
            weight=weight,
            full_weight=mass[:, None] * self.gravity,
            body=body,
            damping=damping,
            held=np.any([np.zeros(len(mass), bool), *(one.of for one in held)], axis=0),
            stress_first=self.scheme == "usf",
            points_keep=self.transfer == "xpic" and self.order > 1,
        )

        self.ledger.transfer += self.soft_kinetic_energy()
        self._take_velocity(s, mass, v_raw, v, v_new, dt)
        self.ledger.transfer -= self.soft_kinetic_energy()
        if self.scheme != "usf":
            back = v_new
            if self.scheme == "musl":
                back = _divide(self._momentum(s), mass)
                back = hold_velocity(back, self.node_velocity, self.nodes, self.walls, self.cell)
            gradient = strain.velocity_gradient(self, sx, sy, back, cells)
            strain.deform_last(self, self.ledger, gradient, dt, self.volume_update)
            self.ledger.transfer += float(dt * np.sum(internal * (back - v_new)))
        self.position = self.position + dt * s @ v_new
        for one in held:
            taken, worked, damped = one.body.follow(
                one.whole,
                dt,
                self.gravity * share_of_gravity,
                self.gravity,
                self._given(one.body),
                one.drag,
            )
            self.ledger.damping -= damped
            self.ledger.rigidity -= taken
            self.ledger.external += worked
        self._follow_bodies()
        if self.shape == "cpgimp" and self.domain_update != "none":
            self.half_length = strain.domains(self, self.domain_update)
        self._damp_kinetic()
        self.time += dt

    def _rigid_material(self, of: NDArray[np.bool_]) -> Rigid:
        """That of the points of a rigid stone."""
        material = self.materials[int(self.material[of][0])]
        assert isinstance(material, Rigid)
        return material

    def _held(self, s: Array, sx: Array, sy: Array, mass: Array) -> list[Held]:
        """The stones and the nodes that each holds, of those that have a mass."""
        if not self.bodies:
            return []
        share, slope = shares(self.bodies, self.shape, self.lines, self.cell, self.walls)
        allowed = (mass > 0) & ~near_walls(self.nodes, self.walls, self.cell)
        soft = self.soft_volume / self.cell**2
        of_soil = soft @ s, -np.stack([soft @ sx, soft @ sy], axis=1) * self.cell
        found = []
        for number, of in enumerate(held_nodes(share, allowed)):
            one = Held(self.bodies[number], self.nodes, of, self.meeting[number])
            if one.slides:
                one.touch((share[number], slope[number]), of_soil)
            found.append(one)
        return found

    def _given(self, body: Body) -> Array:
        """Body forces on the points of a stone (n, 2), N/m."""
        return np.asarray(body.point_mass[:, None] * self.body_force[body.of])

    def _follow_bodies(self) -> None:
        for body in self.bodies:
            self.position[body.of], self.velocity[body.of] = body.points()

    def _momentum(self, s: Array) -> Array:
        """That of the soil at the nodes."""
        brought = transfer.momentum(self, s)
        if self.transfer == "apic":
            brought = brought + transfer.affine_momentum(self, s, self.nodes)
        return brought

    def _take_velocity(
        self, s: Array, mass: Array, v_raw: Array, v: Array, v_new: Array, dt: float
    ) -> None:
        if self.transfer == "flip":
            transfer.take_blend(self, s, v_raw, v_new, self.alpha(dt))
        elif self.transfer == "apic":
            transfer.take_affine(self, s, self.nodes, v_new)
        else:
            held = near_walls(self.nodes, self.walls, self.cell)[:, None] & (v == 0)
            transfer.take_smooth(self, s, mass, held, v, v_new, self.order)

    def kinetic_energy(self) -> float:
        """J/m."""
        return self.soft_kinetic_energy() + sum(body.energy() for body in self.bodies)

    def _damp_kinetic(self) -> None:
        if not self.kinetic_damping:
            return
        energy = self.kinetic_energy()
        if energy < self.last_kinetic_energy:
            self.velocity, self.affine = np.zeros_like(self.velocity), np.zeros_like(self.affine)
            for body in self.bodies:
                body.stop()
            self.ledger.damping += energy
            energy = 0.0
        self.last_kinetic_energy = energy


def _check(name: str, value: str, *allowed: str) -> None:
    if value not in allowed:
        raise ValueError(f"{name} is {value!r}; allowed: {', '.join(allowed)}")


def _divide(momentum: Array, mass: Array) -> Array:
    """Node velocity; 0 where there is no mass."""
    return np.where(mass[:, None] > 0, momentum / np.where(mass > 0, mass, 1.0)[:, None], 0.0)
