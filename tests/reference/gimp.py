"""The material points and their step: update stress first (USF), last (USL), or last from the
velocities that the points bring back (MUSL)."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import ledger as accounts
from .bodies import (
    Body,
    Rigid,
    Whole,
    cross,
    held_nodes,
    near_walls,
    resolve,
    shares,
    stone_contacts,
    wall_contacts,
)
from .drucker_prager import (
    Material,
    elastic_increment,
    energy_density,
    moduli,
    return_mapping,
    rotate,
)
from .interface import APART, STUCK, WELDED, Interface, before_strain, face
from .ledger import Ledger
from .shapes import weights
from .walls import NO_MOTION, Wall, hold_momentum, hold_velocity

Array = NDArray[np.float64]


class Reference:
    """Plane-strain material points on a fixed grid; arguments as for the compiled solver.

    The state is in plain attributes that may be read and assigned: position, velocity (n, 2);
    stress (n, 4) as xx, yy, zz, xy; body_force (n, 2), m/s2; mass, volume, plastic_strain (n,);
    half_length (n, 2); ledger, J/m; deformation_gradient (n, 2, 2); materials; time. But for
    position and velocity of the points of rigid stones, which follow `bodies`, in the order of the
    stones' numbers. The grid reaches `margin` cells beyond the first positions; a point that leaves
    it is an error.
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
        self.position = np.array(position, float)
        self.velocity = np.array(velocity, float)
        self.half_length = np.array(half_length, float)
        self.mass = np.array(mass, float)
        self.volume = np.array(volume, float)
        self.material = np.array(material, int)
        self.materials = list(materials)
        n = len(self.position)
        self.stress = np.zeros((n, 4))
        self.plastic_strain = np.zeros(n)
        self.body_force = np.zeros((n, 2))
        self.deformation_gradient = np.tile(np.eye(2), (n, 1, 1))
        self.first_half_length = self.half_length.copy()
        self.first_volume = self.volume.copy()
        self.time = 0.0
        rigid = [i for i, material in enumerate(self.materials) if isinstance(material, Rigid)]
        self.rigid = np.isin(self.material, rigid)
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
        self.origin = np.asarray(origin)
        self.ledger = Ledger()
        self.scheme, self.blend, self.step_rule = scheme, blend, time_step
        self.transfer, self.order = transfer, order
        self.affine = np.zeros((n, 2, 2))  # B of APIC
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
        for material, of in self._deformable():
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
        before = self._elastic_energy()
        self.stress = self._return(self.stress)
        released = before - self._elastic_energy()
        self.ledger.plastic += released
        return released

    def _step(self) -> None:
        dt = self.time_step
        s, sx, sy = weights(
            self.shape, self.position, self.half_length, self.lines, self.cell, self.walls
        )
        if not np.allclose(s.sum(axis=1), 1.0, atol=1e-9):
            raise RuntimeError("a point has left the grid; make margin larger")

        soft_mass = np.where(self.rigid, 0.0, self.mass)
        mass = s.T @ soft_mass
        momentum = self._momentum(s)
        v_raw = _divide(momentum, mass)
        v = hold_velocity(v_raw, self.node_velocity, self.nodes, self.walls, self.cell)
        held, contacts = [], []
        if self.bodies:
            share, slope = shares(self.bodies, self.shape, self.lines, self.cell, self.walls)
            soil = (mass > 0) & ~near_walls(self.nodes, self.walls, self.cell)
            held = list(held_nodes(share, soil))
            contacts = list(stone_contacts(self.bodies, self.cell, dt))
        normals: dict[int, Array] = {}
        for number, (stone, of) in enumerate(zip(self.bodies, held, strict=True)):
            of_stone = stone.velocity_at(self.nodes)
            if stone.friction is None:
                v[of] = of_stone[of]
                continue
            soft = np.where(self.rigid, 0.0, self.volume) / self.cell**2
            of_soil = soft @ s, -np.stack([soft @ sx, soft @ sy], axis=1) * self.cell
            found = face((share[number], slope[number]), of_soil)
            of &= found.touching
            meeting = self.meeting[number]
            meeting[meeting == WELDED] = STUCK
            meeting[~found.known] = WELDED
            normals[number] = found.normal[of]
            v[of] = before_strain(meeting[of], normals[number], v_raw[of], of_stone[of])

        if self.scheme == "usf":
            self._strain(sx, sy, v, dt)
        internal = self._internal_force(sx, sy)
        share_of_gravity = 1.0 if self.ramp == 0 else min(1.0, (self.time + dt) / self.ramp)
        weight = mass[:, None] * self.gravity * share_of_gravity
        body = s.T @ (soft_mass[:, None] * self.body_force)
        force = internal + weight + body
        damping = -self.local_damping * np.abs(force) * np.sign(v)

        brought = momentum
        momentum = hold_momentum(
            momentum + dt * (force + damping), self.nodes, self.walls, self.cell
        )
        v_new = _divide(momentum, mass)
        wholes, drags, interfaces = [], [], {}
        for number, (stone, of) in enumerate(zip(self.bodies, held, strict=True)):
            given = stone.point_mass[:, None] * self.body_force[stone.of]
            pull = stone.mass * self.gravity * share_of_gravity
            pull = pull + given.sum(axis=0)
            turn = float(cross(stone.arms(), given).sum())
            along = of  # nodes that move with the stone
            if stone.friction is not None:
                along = of & (self.meeting[number] != APART)
            around = force[along].sum(axis=0)
            turn_around = float(cross(self.nodes[along] - stone.centre, force[along]).sum())
            drag = -self.local_damping * np.abs(pull + around) * np.sign(stone.velocity)
            drag_moment = float(-self.local_damping * abs(turn + turn_around) * np.sign(stone.spin))
            damping[along] = 0.0
            one = of  # with the stone
            if stone.friction is None:
                pull, turn = pull + around, turn + turn_around
            else:
                one = np.zeros_like(of)
            drags.append((drag, drag_moment))
            wholes.append(
                Whole(
                    stone,
                    stone.mass * stone.velocity + dt * (pull + drag),
                    stone.inertia * stone.spin + dt * (turn + drag_moment),
                    self.nodes[one],
                    mass[one],
                    brought[one],
                )
            )
            if stone.friction is not None:
                interfaces[number] = Interface(
                    stone,
                    wholes[-1],
                    self.nodes[of],
                    normals[number],
                    self.meeting[number, of],
                    mass[of],
                    v_raw[of] + dt * (force + damping)[of] / mass[of, None],
                )
            contacts += wall_contacts(number, stone, self.walls, self.cell, dt)
        resolve(contacts, wholes, lambda b: interfaces[b].settle() if b in interfaces else None)
        for number, (whole, of) in enumerate(zip(wholes, held, strict=True)):
            if number not in interfaces:
                v_new[of] = whole.velocity_at(self.nodes[of])
                continue
            interface, stone = interfaces[number], self.bodies[number]
            v_new[of] = interface.velocity()
            rubbed = interface.rubbed(v[of], v_new[of], stone.velocity_at(self.nodes[of]))
            self.ledger.friction += rubbed
            self.ledger.rigidity -= rubbed
            self.meeting[number] = APART
            self.meeting[number, of] = interface.meeting
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
            held=np.any(held, axis=0) if held else np.zeros(len(mass), bool),
            stress_first=self.scheme == "usf",
        )

        self.ledger.transfer += self._kinetic_energy_of_soil()
        self._take_velocity(s, mass, v_raw, v, v_new, dt)
        self.ledger.transfer -= self._kinetic_energy_of_soil()
        if self.scheme == "usl":
            self._strain_last(sx, sy, v_new, v_new, internal, dt)
        elif self.scheme == "musl":
            back = _divide(self._momentum(s), mass)
            back = hold_velocity(back, self.node_velocity, self.nodes, self.walls, self.cell)
            self._strain_last(sx, sy, back, v_new, internal, dt)
        self.position = self.position + dt * s @ v_new
        for stone, whole, drag_of in zip(self.bodies, wholes, drags, strict=True):
            taken, worked, damped = stone.follow(
                whole,
                dt,
                self.gravity * share_of_gravity,
                self.gravity,
                stone.point_mass[:, None] * self.body_force[stone.of],
                drag_of,
            )
            self.ledger.damping -= damped
            self.ledger.rigidity -= taken
            self.ledger.external += worked
        self._follow_bodies()
        self._update_domains()
        self._damp_kinetic()
        self.time += dt

    def _rigid_material(self, of: NDArray[np.bool_]) -> Rigid:
        """That of the points of a rigid stone."""
        material = self.materials[int(self.material[of][0])]
        assert isinstance(material, Rigid)
        return material

    def _deformable(self) -> Iterator[tuple[Material, NDArray[np.bool_]]]:
        """The deformable materials and their points."""
        for i, material in enumerate(self.materials):
            if not isinstance(material, Rigid):
                yield material, self.material == i

    def _follow_bodies(self) -> None:
        for body in self.bodies:
            self.position[body.of], self.velocity[body.of] = body.points()

    def _cell_mean(self, values: Array, cells: NDArray[np.int64]) -> Array:
        """Mean over the volume of the deformable points in the same cell."""
        mean = np.zeros_like(values)
        for cell in np.unique(cells[~self.rigid]):
            of = (cells == cell) & ~self.rigid
            mean[of] = np.average(values[of], weights=self.volume[of])
        return mean

    def _momentum(self, s: Array) -> Array:
        """That of the soil at the nodes, with its affine motion about each point."""
        brought = s.T @ (np.where(self.rigid, 0.0, self.mass)[:, None] * self.velocity)
        if self.transfer == "apic":
            arm, weighted = self._arms(s)
            around = self.affine @ np.linalg.pinv(weighted @ arm) @ weighted
            brought = brought + np.tensordot(self.mass, around, axes=1).T
        return np.asarray(brought)

    def _arms(self, s: Array) -> tuple[Array, Array]:
        """From each point to the nodes, (n, nodes, 2), and times their weights, (n, 2, nodes)."""
        arm = self.nodes[None] - self.position[:, None]
        return arm, np.swapaxes(s[:, :, None] * arm, 1, 2)

    def _take_velocity(
        self, s: Array, mass: Array, v_raw: Array, v: Array, v_new: Array, dt: float
    ) -> None:
        if self.transfer == "flip":
            alpha = self.alpha(dt)
            pic, flip = s @ v_new, self.velocity + s @ (v_new - v_raw)
            self.velocity = alpha * pic + (1 - alpha) * flip
        elif self.transfer == "apic":
            self.affine = np.swapaxes(self._arms(s)[1] @ v_new, 1, 2)
            self.velocity = s @ v_new
        else:
            to_nodes = np.where(mass > 0, 1 / np.where(mass > 0, mass, 1.0), 0.0)[:, None]
            at_walls = near_walls(self.nodes, self.walls, self.cell)
            for axis in (0, 1):
                held = at_walls & (v[:, axis] == 0)
                smooth = s @ np.where(held[:, None], 0.0, to_nodes * s.T * self.mass)  # S S+
                noise = np.linalg.matrix_power(np.eye(len(s)) - smooth, self.order)
                self.velocity[:, axis] -= noise @ self.velocity[:, axis]
            self.velocity = self.velocity + s @ (v_new - v)

    def _cells(self) -> NDArray[np.int64]:
        """A number for the cell of each point."""
        places = np.floor((self.position - self.origin) / self.cell)
        return np.unique(places, axis=0, return_inverse=True)[1].ravel()

    def _strain(self, sx: Array, sy: Array, v: Array, dt: float) -> Array:
        """Deform by the node velocities v; gives the strain increments (n, 2, 2)."""
        gradient = np.stack([sx @ v, sy @ v], axis=2)
        if self.volumetric_strain == "cell_average":
            trace = np.trace(gradient, axis1=1, axis2=2)
            change = (self._cell_mean(trace, self._cells()) - trace) / 2
            gradient = gradient + change[:, None, None] * np.eye(2)
        gradient[self.rigid] = 0.0
        self._deform(gradient, dt)
        return (gradient + np.swapaxes(gradient, 1, 2)) * dt / 2

    def _strain_last(
        self, sx: Array, sy: Array, v: Array, v_new: Array, internal: Array, dt: float
    ) -> None:
        """Deform by v after forces that belong to the stress before; v_new moves the points."""
        before = self.stress * self.volume[:, None]
        strain = self._strain(sx, sy, v, dt)
        late = _tensor(self.stress * self.volume[:, None] - before)[:, :2, :2]
        self.ledger.integration -= float(np.sum(late * strain))
        self.ledger.transfer += float(dt * np.sum(internal * (v - v_new)))

    def _internal_force(self, sx: Array, sy: Array) -> Array:
        sigma = _tensor(self.stress)[:, :2, :2]
        if self.volumetric_strain == "cell_average":
            mean = np.trace(sigma, axis1=1, axis2=2) / 2
            change = self._cell_mean(mean, self._cells()) - mean
            sigma = sigma + change[:, None, None] * np.eye(2)
        sigma = sigma * np.where(self.rigid, 0.0, self.volume)[:, None, None]
        return np.asarray(-(sx.T @ sigma[:, :, 0] + sy.T @ sigma[:, :, 1]))

    def _deform(self, velocity_gradient: Array, dt: float) -> None:
        """Volume, deformation gradient and stress from the velocity gradient (n, 2, 2)."""
        dilation = np.trace(velocity_gradient, axis1=1, axis2=2) * dt
        linear = self.volume_update == "linear"
        volume_before = self.volume
        self.volume = self.volume * (1 + dilation if linear else np.exp(dilation))
        self.deformation_gradient = (np.eye(2) + velocity_gradient * dt) @ self.deformation_gradient

        strain = np.zeros((len(self.mass), 3, 3))
        strain[:, :2, :2] = (velocity_gradient + np.swapaxes(velocity_gradient, 1, 2)) * dt / 2
        spin = (velocity_gradient[:, 1, 0] - velocity_gradient[:, 0, 1]) * dt / 2
        turned = rotate(_tensor(self.stress), spin)
        trial = turned.copy()
        for material, of in self._deformable():
            trial[of] += elastic_increment(material, strain[of])
        self.stress = self._return(_components(trial))
        for material, of in self._deformable():
            accounts.points(
                self.ledger,
                material,
                turned=turned[of],
                stress=_tensor(self.stress)[of],
                strain=strain[of],
                volume_before=volume_before[of],
                volume=self.volume[of],
            )

    def _return(self, stress: Array) -> Array:
        returned = stress.copy()
        for material, of in self._deformable():
            tensor, plastic_strain = return_mapping(material, _tensor(stress[of]))
            returned[of] = _components(tensor)
            self.plastic_strain[of] += plastic_strain
        return returned

    def _elastic_energy(self) -> float:
        energy = 0.0
        for material, of in self._deformable():
            energy += float(self.volume[of] @ energy_density(material, _tensor(self.stress[of])))
        return float(energy)

    def kinetic_energy(self) -> float:
        """J/m."""
        return self._kinetic_energy_of_soil() + sum(body.energy() for body in self.bodies)

    def _kinetic_energy_of_soil(self) -> float:
        of = ~self.rigid
        return float(np.sum(self.mass[of, None] * self.velocity[of] ** 2) / 2)

    def _update_domains(self) -> None:
        if self.shape != "cpgimp" or self.domain_update == "none":
            return
        f = self.deformation_gradient
        if self.domain_update == "jacobian":
            growth = np.sqrt(self.volume / self.first_volume)[:, None]
        elif self.domain_update == "stretch":
            squares, axes = np.linalg.eigh(np.swapaxes(f, 1, 2) @ f)
            stretch = axes * np.sqrt(squares)[:, None, :] @ np.swapaxes(axes, 1, 2)
            growth = np.diagonal(stretch, axis1=1, axis2=2)
        else:
            growth = np.diagonal(f, axis1=1, axis2=2)
        self.half_length = self.first_half_length * growth

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


def _tensor(stress: Array) -> Array:
    """(n, 4) as xx, yy, zz, xy -> (n, 3, 3)."""
    tensor = np.zeros((len(stress), 3, 3))
    tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = stress[:, 0], stress[:, 1], stress[:, 2]
    tensor[:, 0, 1] = tensor[:, 1, 0] = stress[:, 3]
    return tensor


def _components(tensor: Array) -> Array:
    """(n, 3, 3) -> (n, 4) as xx, yy, zz, xy."""
    return np.stack([tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2], tensor[:, 0, 1]], axis=1)
