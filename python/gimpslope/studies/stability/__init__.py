"""The atlas of where methods fail: one module a mode, each measured against theory."""

from __future__ import annotations

from typing import TypeAlias

from ..checked import Catalogue, Checked
from .mode import Findings, Mode, Table

NAMES = (
    "step_limit",
    "cell_crossing",
    "fracture",
    "stretched_domains",
    "null_space",
    "small_masses",
    "spin",
    "cones",
    "apex",
    "locking",
    "blend",
    "energy_drift",
    "single_precision",
    "near_stones",
    "localisation",
)
"""All modes of failure: of shape functions and schemes first, then of the soil, then of a run."""

__all__ = ["MODES", "NAMES", "Findings", "Mode", "Surveyed", "Table", "mode", "survey"]

Surveyed: TypeAlias = Checked[Mode, Findings]

MODES = Catalogue[Mode, Findings](__name__, "mode", NAMES, full=True)
mode = MODES.named
survey = MODES.check
