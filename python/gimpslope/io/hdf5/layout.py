"""What a run file holds."""

from __future__ import annotations

from typing import Any, NamedTuple

from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]

FORMAT = "gimpslope run"
FORMAT_VERSION = 3
STAGES = ("gravity", "settling", "slide")
STATUSES = ("running", "finished", "interrupted", "failed")
SETUP = ("scene", "method", "stages", "recording")
JSON_ATTRIBUTES = {*SETUP, "summary", "timing"}


class Quantity(NamedTuple):
    """What a dataset holds: type, shape of one item (without the points), units, description."""

    dtype: str
    shape: tuple[int, ...]
    units: str
    description: str


POINTS = {
    "position": Quantity("f8", (2,), "m", "position (x, y) at the start of the slide"),
    "mass": Quantity("f8", (), "kg/m", "mass per metre out of the plane"),
    "volume": Quantity("f8", (), "m2", "volume per metre out of the plane at the start"),
    "half_length": Quantity("f8", (2,), "m", "half of the point's width and height"),
    "material": Quantity("i4", (), "1", "index into the attribute material_names"),
    "stone": Quantity("i4", (), "1", "number of the stone, -1 in the soil"),
}

ENERGY = {
    "stage": Quantity("u1", (), "1", "0 gravity, 1 settling, 2 slide"),
    "time": Quantity("f8", (), "s", "time; in the slide from the trigger"),
    "step": Quantity("i8", (), "1", "steps taken since the clock was last set to zero"),
    "kinetic": Quantity("f8", (), "J/m", "kinetic energy per metre out of the plane"),
    "potential": Quantity("f8", (), "J/m", "potential energy in gravity, zero at y = 0"),
    "elastic": Quantity("f8", (), "J/m", "elastic strain energy"),
    "max_speed": Quantity("f8", (), "m/s", "speed of the fastest point"),
}

LEDGER = {
    "plastic": Quantity("f8", (), "J/m", "plastic work, energy released at the trigger included"),
    "friction": Quantity("f8", (), "J/m", "work of friction along Coulomb walls"),
    "impact": Quantity("f8", (), "J/m", "taken by walls at once"),
    "damping": Quantity("f8", (), "J/m", "taken by local and kinetic damping"),
    "transfer": Quantity("f8", (), "J/m", "lost between points and grid"),
    "external": Quantity("f8", (), "J/m", "work of body forces and of the ramp of gravity"),
    "hypoelastic": Quantity("f8", (), "J/m", "taken by the rate form of the elastic law"),
    "integration": Quantity("f8", (), "J/m", "residue of the finite time step"),
    "rigidity": Quantity("f8", (), "J/m", "lost where rigid stones meet soil, walls, each other"),
}

RIGID_STONES = "rigid_stones"
RIGID_STATE = Quantity(
    "f8",
    (9,),
    "m, rad, m/s, rad/s, N s/m, N m s/m",
    "x and y of the centre, angle, velocity x and y, spin, and impulse x and y and angular impulse "
    "of all but gravity since the clock was last set to zero, of the stones in attribute number",
)

FIELDS = {
    "position": Quantity("f8", (2,), "m", "position (x, y)"),
    "velocity": Quantity("f8", (2,), "m/s", "velocity (x, y)"),
    "stress": Quantity("f8", (4,), "Pa", "stress (xx, yy, zz, xy), tension positive"),
    "plastic_strain": Quantity("f8", (), "1", "equivalent plastic strain since the trigger"),
    "volume": Quantity("f8", (), "m2", "volume per metre out of the plane"),
}

SNAPSHOT_FIELDS = {  # displacements are differences of positions, which keep all their digits
    name: quantity if name == "position" else quantity._replace(dtype="f4")
    for name, quantity in FIELDS.items()
}
