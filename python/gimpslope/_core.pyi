"""The compiled kernel."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

class Diverged(RuntimeError):
    step: int
    time: float
    point: int

class Material:
    def __init__(
        self,
        density: float,
        young: float,
        poisson: float,
        law: str = ...,
        friction: float = ...,
        cohesion: float = ...,
        dilation: float = ...,
        cone: str = ...,
        tension_cutoff: float = ...,
    ) -> None: ...
    @property
    def bulk_modulus(self) -> float: ...
    @property
    def shear_modulus(self) -> float: ...
    @property
    def wave_speed(self) -> float: ...
    @property
    def tension_limit(self) -> float: ...
    @property
    def cone_coefficients(self) -> tuple[float, float, float]: ...

class Solver:
    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        half_length: ArrayLike,
        mass: ArrayLike,
        volume: ArrayLike,
        material: ArrayLike,
        materials: Sequence[Material],
        *,
        cell: float,
        origin: tuple[float, float],
        walls: Sequence[tuple[str, float, float]],
        shape: str = ...,
        domain_update: str = ...,
        volume_update: str = ...,
        volumetric_strain: str = ...,
        scheme: str = ...,
        blend: tuple[str, float] = ...,
        time_step: tuple[str, float] = ...,
        precision: str = ...,
        threads: int = ...,
        allow_unstable: bool = ...,
        ledger: bool = ...,
        instruction_set: str = ...,
    ) -> None: ...
    def advance(self, steps: int = ...) -> None: ...
    def advance_to(self, time: float) -> None: ...
    def set_gravity(self, x: float, y: float, ramp: float = ...) -> None: ...
    def set_damping(self, local: float = ..., kinetic: bool = ...) -> None: ...
    def set_time_step(self, kind: str, value: float) -> None: ...
    def set_materials(self, materials: Sequence[Material]) -> None: ...
    def release_stress(self) -> float: ...
    def reset_clock(self) -> None: ...
    def energies(self) -> dict[str, float]: ...
    def ledger(self) -> dict[str, float]: ...
    def get(self, name: str) -> NDArray[np.float64]: ...
    def set(self, name: str, values: ArrayLike) -> None: ...
    def view(self, name: str) -> NDArray[np.float64]: ...
    def material(self) -> NDArray[np.int32]: ...
    def numbers(self) -> NDArray[np.int32]: ...
    @property
    def time(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def size(self) -> int: ...
    @property
    def threads(self) -> int: ...
    @property
    def instruction_set(self) -> str: ...
    @property
    def time_step(self) -> float: ...
    @property
    def stable_time_step(self) -> float: ...
    @property
    def alpha(self) -> float: ...
    @property
    def bytes(self) -> int: ...
    @property
    def seconds(self) -> dict[str, float]: ...

class Plain:
    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        half_length: ArrayLike,
        mass: ArrayLike,
        volume: ArrayLike,
        material: ArrayLike,
        materials: Sequence[Material],
        *,
        cell: float,
        origin: tuple[float, float],
        walls: Sequence[tuple[str, float, float]],
        blend: tuple[str, float],
        time_step: tuple[str, float],
        volume_update: str = ...,
        gravity: tuple[float, float],
        margin: int,
        instruction_set: str = ...,
    ) -> None: ...
    def advance(self, steps: int) -> None: ...
    def get(self, name: str) -> NDArray[np.float64]: ...
    @property
    def time(self) -> float: ...

class Machine:
    def __init__(self, *, threads: int, bytes: int, instruction_set: str = ...) -> None: ...
    def multiply_add(self, rounds: int) -> int: ...
    def read(self, passes: int) -> int: ...

courant_limit: float
has_threads: bool

def instruction_sets() -> list[str]: ...
def shapes() -> list[str]: ...
def shape_functions(
    shape: str,
    position: ArrayLike,
    half_length: ArrayLike,
    cell: float,
    origin: tuple[float, float],
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]: ...
def return_mapping(
    material: Material, stress: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
def update_stress(
    material: Material,
    stress: ArrayLike,
    velocity_gradient: ArrayLike,
    time_step: float,
    steps: int = ...,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
