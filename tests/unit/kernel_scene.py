"""Small scenes for the compiled kernel: blocks of points and the arguments of its solver."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gimpslope import _core

Array = NDArray[np.float64]
Settings = Mapping[str, Any]

FREE = ("free", 0.0, 0.0)
SOIL = {
    "density": 2000.0,
    "young": 1e6,
    "poisson": 0.3,
    "law": "drucker_prager",
    "friction": 22.0,
    "cohesion": 1e3,
}
STONE = {"density": 2600.0, "young": 4e6, "poisson": 0.2}
CLAY = SOIL | {"density": 1800.0, "friction": 0.0, "cohesion": 3e3}

ARRAYS = ("position", "velocity", "half_length", "mass", "volume", "material")
OPTIONS = (
    "cell",
    "origin",
    "walls",
    "shape",
    "domain_update",
    "volume_update",
    "volumetric_strain",
    "scheme",
    "transfer",
    "order",
    "blend",
)


def block(
    columns: int,
    rows: int,
    *,
    cell: float = 0.5,
    corner: tuple[float, float] = (0.0, 0.0),
    jitter: float = 0.0,
    speed: float = 0.0,
    prestress: float = 0.0,
    seed: int = 0,
) -> dict[str, Any]:
    """Columns x rows points, two a cell and direction, with the soil's mass.

    Places vary by `jitter` of the spacing, velocities by `speed` m/s, stresses by `prestress` Pa.
    """
    random = np.random.default_rng(seed)
    spacing = cell / 2
    x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
    n = columns * rows
    place = np.column_stack([x.ravel(), y.ravel()])
    place += jitter * random.uniform(-0.5, 0.5, (n, 2))
    return {
        "position": np.asarray(corner) + spacing * place,
        "velocity": speed * random.standard_normal((n, 2)),
        "stress": prestress * random.standard_normal((n, 4)),
        "half_length": np.full((n, 2), spacing / 2),
        "mass": np.full(n, SOIL["density"] * spacing**2),
        "volume": np.full(n, spacing**2),
        "material": np.zeros(n, np.int32),
        "cell": cell,
        "origin": corner,
    }


def arguments(scene: Settings) -> dict[str, Any]:
    """The arguments that the compiled solver and its NumPy twin share, materials apart."""
    names = (*ARRAYS, *OPTIONS, "time_step")
    return {name: scene[name] for name in names if name in scene}


def solver(scene: Settings, **options: Any) -> _core.Solver:
    """The compiled solver of a scene, loaded and ready to step."""
    materials = [_core.Material(**given) for given in scene.get("materials", [SOIL])]
    unstable = scene.get("allow_unstable", False)
    given = {"walls": [FREE] * 4, "allow_unstable": unstable} | arguments(scene) | options
    result = _core.Solver(materials=materials, **given)
    for name in ("stress", "body_force"):
        if name in scene:
            result.set(name, scene[name])
    result.set_gravity(*scene.get("gravity", (0.0, 0.0, 0.0)))
    result.set_damping(*scene.get("damping", (0.0, False)))
    return result


def sliding(columns: int = 60, rows: int = 60) -> dict[str, Any]:
    """A column of soil with stones in it that spreads over a floor: a few thousand points."""
    scene = block(columns, rows, cell=0.5, jitter=0.2, speed=0.1)
    x, y = scene["position"].T
    return scene | {
        "material": (np.hypot(x % 4 - 2, y % 4 - 2) < 0.8).astype(np.int32),
        "materials": [SOIL, STONE],
        "walls": [("roller", 0.0, 0.0), FREE, ("coulomb", 0.2, 0.0), FREE],
        "gravity": (4.0, -9.81, 0.0),
        "blend": ("alpha", 0.01),
        "time_step": ("courant", 0.4),
    }
