"""The solver: material points on a background grid, stepped by the compiled kernel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _check, _core
from ._check import FloatArray
from .ledger import Ledger
from .materials import Material
from .method import Method
from .rigid_stones import RigidStones, Unsettled
from .scene import Points, Scene
from .walls import Free, Walls

Diverged = _core.Diverged

_MOST_STEPS = 2**62
_ALL_FREE = Walls(Free(), Free(), Free(), Free())


class Energies(NamedTuple):
    """Energies a metre out of the plane, J/m, and the speed of the fastest point, m/s."""

    kinetic: float
    potential: float
    elastic: float
    max_speed: float


class Solver:
    """Material points and their stepping; `Solver.of(scene, method)` makes one from a scene.

    Arrays go in and come out in the order in which the points were given, as copies: to change one,
    set it whole. The kernel keeps its
    points sorted by cell: `view` and `numbers` show them as they lie in memory.

    A step of the scheme "usf" takes its strains from the velocities at its start, so velocities
    belong to half a step before the positions, stresses and volumes to a whole step before; with
    "usl" and "musl" velocities belong to half a step before all else. For second order in the step,
    give them so.

    Parameters
    ----------
    points : the material points
    materials : those that `points.material` counts
    cell : side of a grid cell, m
    walls : conditions on the four sides; free where left out
    wall_positions : x of the left and right, y of the bottom and top wall, m, on grid lines;
        needed with walls
    origin : a node of the grid (x, y), m
    velocity : m/s, shape (n, 2); at rest where left out
    stress : xx, yy, zz, xy, tension positive, Pa, shape (n, 4); zero where left out
    gravity : acceleration (x, y), m/s2
    method : how the motion is computed
    instruction_set : one of `gimpslope.kernel.instruction_sets()`; the fastest where left out

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong type, shape or range, or the time step is above the stable
        limit and the method does not allow that.
    """

    def __init__(
        self,
        points: Points,
        materials: Sequence[Material],
        *,
        cell: float,
        walls: Walls = _ALL_FREE,
        wall_positions: npt.ArrayLike | None = None,
        origin: npt.ArrayLike = (0.0, 0.0),
        velocity: npt.ArrayLike | None = None,
        stress: npt.ArrayLike | None = None,
        gravity: npt.ArrayLike = (0.0, 0.0),
        method: Method | None = None,
        instruction_set: str = "",
    ) -> None:
        _check.instance("walls", walls, Walls, "Walls")
        if wall_positions is None and walls != _ALL_FREE:
            raise ValueError(f"wall_positions must be given with walls, got None with {walls}")
        positions = (0.0,) * 4 if wall_positions is None else wall_positions
        method = Method() if method is None else method
        _check.instance("method", method, Method, "a Method")
        n = len(_check.instance("points", points, Points, "Points"))
        at_rest = np.zeros((n, 2))
        self._core = _core.Solver(
            points.position,
            at_rest if velocity is None else _check.array("velocity", velocity, (n, 2)),
            points.half_length,
            points.mass,
            points.volume,
            points.material,
            _to_core(materials),
            cell=_check.positive("cell", cell),
            origin=tuple(_check.array("origin", origin, (2,)).tolist()),
            stone=points.stone,
            walls=walls.to_core(_check.array("wall_positions", positions, (4,)).tolist()),
            instruction_set=_check.instance("instruction_set", instruction_set, str, "a name"),
            **method.of(materials).to_core(),
        )
        self._core.set_gravity(*_check.array("gravity", gravity, (2,)).tolist())
        if stress is not None:
            self.stress = np.asarray(stress)

    @classmethod
    def of(
        cls,
        scene: Scene,
        method: Method | None = None,
        *,
        elastic: bool = False,
        instruction_set: str = "",
    ) -> Solver:
        """The points of a scene at rest, under its full gravity.

        With `elastic` the materials are without their yield surfaces, as they are until a slope is
        let go.
        """
        _check.instance("scene", scene, Scene, "a Scene")
        _check.flag("elastic", elastic)
        return cls(
            scene.points,
            [m.elastic() for m in scene.materials] if elastic else scene.materials,
            cell=scene.cell,
            walls=scene.walls,
            wall_positions=scene.wall_positions,
            origin=scene.origin,
            gravity=(0.0, -scene.gravity),
            method=(Method() if method is None else method).of(scene.materials),
            instruction_set=instruction_set,
        )

    def step(self) -> None:
        """Take one step."""
        self._core.advance(1)

    def advance(self, steps: int) -> None:
        """Take `steps` steps. Other Python threads run meanwhile, but this solver is theirs only
        when the call has returned (`RuntimeError` before that); Ctrl-C stops it within a second.

        Raises
        ------
        Diverged
            If a point would move by more than half a cell in one step, or is no longer finite.
            The error names step, time, point and the likely cause. The state is torn then, and no
            step can follow.
        """
        if _check.whole("steps", steps, 0) > _MOST_STEPS:
            raise ValueError(f"steps must be at most {_MOST_STEPS}, got {steps}")
        self._core.advance(steps)

    def advance_to(self, time: float) -> None:
        """Step until `time` (s). With a Courant number the last steps are shortened to end there;
        with a fixed step the first one that reaches it is the last. Raises as `advance` does."""
        self._core.advance_to(_check.finite("time", time))

    def advance_through(self, times: npt.ArrayLike) -> None:
        """Step to each of the times (s, shape (k,), growing) in turn, as `advance_to` does, and
        keep a row of energies there for `take_rows`.

        A time that is not ahead when its turn comes has no row. Raises as `advance_to` does, and
        keeps the rows of before.
        """
        wanted = _check.array("times", times, ("k",))
        if (np.diff(wanted) <= 0).any():
            raise ValueError(f"times must grow, got {wanted}")
        self._core.advance_through(wanted)

    def take_rows(self) -> dict[str, npt.NDArray[Any]]:
        """The rows kept since they were last taken, by column, each of shape (k,): time (s), step,
        those of `Energies`, with a ledger those of `Ledger` (J/m), and with rigid stones
        `rigid_stones`, the states of `RigidStones`, shape (k, m, 9)."""
        rows: dict[str, npt.NDArray[Any]] = self._core.take_rows()
        return rows

    def set_gravity(self, x: float, y: float, ramp: float = 0.0) -> None:
        """Acceleration (x, y), m/s2, which grows linearly over the first `ramp` seconds."""
        self._core.set_gravity(
            _check.finite("x", x), _check.finite("y", y), _check.not_negative("ramp", ramp)
        )

    def set_damping(self, local: float = 0.0, kinetic: bool = False) -> None:
        """Damping: `local` takes that share, in [0, 1), of each nodal force against the node's
        velocity (Cundall 1987); `kinetic` sets all velocities to zero whenever the kinetic energy
        has passed a peak."""
        self._core.set_damping(_check.finite("local", local), _check.flag("kinetic", kinetic))

    def set_step(self, kind: str, value: float) -> None:
        """The time step from now on, as `Method.step` has it: "courant" and a number, or "fixed"
        and s. Refuses what a method refuses."""
        self._core.set_time_step(kind, _check.finite("value", value))

    def stop(self) -> None:
        """Set all velocities to zero; the ledger books it as damping."""
        self._core.stop()

    def set_materials(self, materials: Sequence[Material]) -> None:
        """Replace the materials, one for each of before; the stresses stay as they are, and so do
        volume strains that the method left to the materials of the start."""
        self._core.set_materials(_to_core(materials))

    def release_stress(self) -> float:
        """Return all stresses to the yield surfaces; the elastic energy released, J/m."""
        return self._core.release_stress()

    def reset_clock(self) -> None:
        """Set time, steps, plastic strain and ledger to zero."""
        self._core.reset_clock()

    def energies(self) -> Energies:
        """Kinetic, potential (under full gravity, zero at the origin of the coordinates) and
        elastic energy, J/m, and the largest speed, m/s."""
        return Energies(**self._core.energies())

    @property
    def ledger(self) -> Ledger:
        """Where the energy went since the clock was last set to zero, J/m.

        Raises `ValueError` unless the method keeps a ledger.
        """
        return Ledger(**self._core.ledger())

    @property
    def rigid_stones(self) -> RigidStones:
        """The stones of rigid material as they are now."""
        return RigidStones(self._core.body_numbers(), self._core.bodies()[0])

    @property
    def unsettled(self) -> dict[str, Unsettled]:
        """Impulses on rigid stones that did not settle since the clock was last set to zero:
        "interfaces", those of soil that slides along stones, and "contacts", those of stones that
        touch each other or walls."""
        return {name: Unsettled(*found) for name, found in self._core.unsettled().items()}

    def values(self, name: str, *, single: bool = False) -> npt.NDArray[np.floating[Any]]:
        """A field by the name of its property, such as "velocity", in the order in which the points
        were given; rounded to 32 bits with `single`."""
        return self._core.get_single(name) if single else self._core.get(name)

    def view(self, name: str) -> FloatArray:
        """A field in storage order without a copy, read-only: it shows the present state for as
        long as it lives, and the order changes whenever the kernel sorts its points. `numbers`
        says which points they are.

        Names: position, velocity, body_force (n, 2); stress (n, 4); volume, mass, plastic_strain
        (n,); half_length (n, 2), with shape "ugimp" or "cpgimp"; deformation_gradient (n, 4) as
        xx, xy, yx, yy, with shape "cpgimp" and domain_update "stretch" or "deformation_diagonal";
        affine (n, 4), with transfer "apic".
        """
        return self._core.view(name)

    @property
    def numbers(self) -> npt.NDArray[np.int32]:
        """Place in the given order of each stored point, shape (n,); a view as of `view`."""
        return self._core.numbers()

    @property
    def position(self) -> FloatArray:
        """m, shape (n, 2)."""
        return self._core.get("position")

    @position.setter
    def position(self, values: npt.ArrayLike) -> None:
        self._set("position", values, 2)

    @property
    def velocity(self) -> FloatArray:
        """m/s, shape (n, 2)."""
        return self._core.get("velocity")

    @velocity.setter
    def velocity(self, values: npt.ArrayLike) -> None:
        self._set("velocity", values, 2)

    @property
    def stress(self) -> FloatArray:
        """xx, yy, zz, xy, tension positive, Pa, shape (n, 4)."""
        return self._core.get("stress")

    @stress.setter
    def stress(self, values: npt.ArrayLike) -> None:
        self._set("stress", values, 4)

    @property
    def body_force(self) -> FloatArray:
        """Force a unit of mass at each point beside gravity, N/kg = m/s2, shape (n, 2).

        It stays as it is until it is set anew, also while the points move; set before each step, it
        may follow any law in space and time. Zero unless set.
        """
        return self._core.get("body_force")

    @body_force.setter
    def body_force(self, values: npt.ArrayLike) -> None:
        self._set("body_force", values, 2)

    @property
    def affine(self) -> FloatArray:
        """B of Jiang and others 2015, the moment of the nodes' velocity about each point, xx, xy,
        yx, yy (velocity by arm), m2/s, shape (n, 4); with transfer "apic" alone.

        The angular momentum of a point is m (x v_y - y v_x + B_yx - B_xy). Setting velocities sets
        it to zero.
        """
        return self._core.get("affine")

    @affine.setter
    def affine(self, values: npt.ArrayLike) -> None:
        self._set("affine", values, 4)

    @property
    def volume(self) -> FloatArray:
        """Area in the plane, m2, > 0, shape (n,).

        Setting it changes the wave speed, against which a fixed time step is not checked anew, and
        with cpGIMP by the jacobian the domains.
        """
        return self._core.get("volume")

    @volume.setter
    def volume(self, values: npt.ArrayLike) -> None:
        self._core.set("volume", _check.array("volume", values, (len(self),)))

    @property
    def mass(self) -> FloatArray:
        """kg/m, shape (n,)."""
        return self._core.get("mass")

    @property
    def density(self) -> FloatArray:
        """kg/m3, shape (n,)."""
        density: FloatArray = self.mass / self.volume
        return density

    @property
    def plastic_strain(self) -> FloatArray:
        """Equivalent plastic strain, the sum of sqrt(2/3 de_p:de_p) of the deviatoric increments,
        >= 0, shape (n,)."""
        return self._core.get("plastic_strain")

    @plastic_strain.setter
    def plastic_strain(self, values: npt.ArrayLike) -> None:
        self._core.set("plastic_strain", _check.array("plastic_strain", values, (len(self),)))

    @property
    def half_length(self) -> FloatArray:
        """Half-lengths of the GIMP domains, m, shape (n, 2)."""
        return self._core.get("half_length")

    @property
    def material(self) -> npt.NDArray[np.int32]:
        """Index into the materials, shape (n,)."""
        return self._core.material()

    @property
    def time(self) -> float:
        """s."""
        return self._core.time

    @property
    def steps(self) -> int:
        """Steps taken since the clock was set to zero."""
        return self._core.steps

    @property
    def time_step(self) -> float:
        """The next time step, s."""
        return self._core.time_step

    @property
    def stable_time_step(self) -> float:
        """The largest step that is stable in the present state, s: cell over wave speed.

        Contiguous domains add up to bilinear finite elements with lumped masses, whose frequencies
        in plane strain are at most omega = 2 c / h; the limit is 2 / omega. A step that was
        accepted is kept, also when the soil loosens and its wave speed grows.
        """
        return self._core.stable_time_step

    @property
    def alpha(self) -> float:
        """Share of PIC in the next step; 1 with any transfer but "flip"."""
        return self._core.alpha

    @property
    def unbalanced_force(self) -> float:
        """The sum of the sizes of the forces, those of walls included, that were left at the nodes
        and on rigid stones, with moments on these over their radii, when kinetic damping last
        stopped all motion, N/m; infinite before."""
        return self._core.unbalanced_force

    @property
    def threads(self) -> int:
        """Number of threads."""
        return self._core.threads

    @property
    def instruction_set(self) -> str:
        """The instruction set the kernel runs on."""
        return self._core.instruction_set

    @property
    def bytes(self) -> int:
        """Memory of points and grid, bytes."""
        return self._core.bytes

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in the "stress" and the "move" sweep over the points, in the passes
        over the "nodes", and in the "sort" of the points, s."""
        spent: dict[str, float] = self._core.seconds
        return spent

    def __len__(self) -> int:
        return self._core.size

    def __repr__(self) -> str:
        return f"<Solver of {len(self)} points at {self.time:.6g} s after {self.steps} steps>"

    def _set(self, name: str, values: npt.ArrayLike, components: int) -> None:
        self._core.set(name, _check.array(name, values, (len(self), components)))


def _to_core(materials: Sequence[Material]) -> list[_core.Material]:
    if not isinstance(materials, Sequence) or isinstance(materials, str):
        raise TypeError(f"materials must be a sequence of materials, got {materials!r}")
    for number, material in enumerate(materials):
        _check.instance(f"materials[{number}]", material, Material, "a material")
    return [material.to_core() for material in materials]
