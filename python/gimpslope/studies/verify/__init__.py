"""Problems with known answers: one module each, which reads like the problem statement."""

from __future__ import annotations

from typing import TypeAlias

from ..check import Check
from ..checked import Catalogue, Checked
from .problem import Outcome, Problem

NAMES = (
    "column",
    "bar",
    "manufactured",
    "vortex",
    "shear",
    "wave",
    "disks",
    "inclusion",
    "cantilever",
    "translation",
    "biaxial",
    "return_mapping",
    "sliding_block",
    "aluminium_bars",
    "column_collapse",
    "footing",
    "pushed_disk",
    "safety_factor",
)
"""All problems: elastic ones first, then plastic and frictional ones."""

__all__ = ["NAMES", "PROBLEMS", "Check", "Outcome", "Problem", "Solved", "problem", "solve"]

Solved: TypeAlias = Checked[Problem, Outcome]

PROBLEMS = Catalogue[Problem, Outcome](__name__, "problem", NAMES, full=False)
problem = PROBLEMS.named
solve = PROBLEMS.check
