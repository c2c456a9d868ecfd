"""The run file: HDF5, format 3, readable with h5py alone.

Root attributes
    format = "gimpslope run", format_version, gimpslope_version, created (ISO 8601, UTC), status
    ("running", "finished", "interrupted" or "failed"), status_detail, instruction_set, threads,
    volumetric_strain ("point" or "cell_average": which of them was used, also where the method
    leaves it to the materials; not in files of older versions), process (machine and number of the
    one that writes);
    JSON text: scene, method, stages, recording, and at the end of the run summary and timing
    (wall_seconds spent stepping, processor_seconds of all threads in them, not in files of older
    versions, and point_steps).
/points
    the points at the start of the slide, in the order in which they were given; until the slide
    starts, those of the unloaded slope.
/energy
    one column a dataset, all of the same length, rows of all stages; with the columns of the ledger
    where the method keeps one, and with rigid stones their motion, rigid_stones.
/snapshots
    the slide at chosen times, first at its start; axis 0 is time; 32-bit but for the positions.
/final
    the same fields once, 64-bit; attribute time.
/trigger
    attributes energy_released (J/m), settling_time (s), settling_ratio (kinetic over potential),
    settling_unbalanced (unbalanced forces over weight when kinetic damping last stopped all motion,
    infinite where it did not; not in files of older versions).

Every dataset has the attributes units and description. The file is closed between flushes, and a
process killed at any moment leaves it readable to the last flush. A reading that meets a write of a
run that is still going may fail and succeeds when tried again; the functions here do so.
"""

from .layout import (
    ENERGY,
    FIELDS,
    FORMAT,
    FORMAT_VERSION,
    LEDGER,
    POINTS,
    RIGID_STONES,
    SETUP,
    SNAPSHOT_FIELDS,
    STAGES,
    STATUSES,
    Quantity,
)
from .process import still_writing
from .reader import (
    read_attributes,
    read_energy,
    read_final,
    read_ledger,
    read_points,
    read_rigid_stones,
    read_snapshot,
    read_snapshot_times,
    read_trigger,
)
from .writer import RunWriter

__all__ = [
    "ENERGY",
    "FIELDS",
    "FORMAT",
    "FORMAT_VERSION",
    "LEDGER",
    "POINTS",
    "RIGID_STONES",
    "SETUP",
    "SNAPSHOT_FIELDS",
    "STAGES",
    "STATUSES",
    "Quantity",
    "RunWriter",
    "read_attributes",
    "read_energy",
    "read_final",
    "read_ledger",
    "read_points",
    "read_rigid_stones",
    "read_snapshot",
    "read_snapshot_times",
    "read_trigger",
    "still_writing",
]
