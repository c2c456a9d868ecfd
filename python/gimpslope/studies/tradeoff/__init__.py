"""Error against core-seconds: every choice that `Method` offers, on problems whose answers are
known from elsewhere than our default, and which of them are worth their cost."""

from .measure import Measured, measured, missing, sweep
from .output import write
from .plan import Case, Plan, plan
from .problems import PROBLEMS

__all__ = [
    "PROBLEMS",
    "Case",
    "Measured",
    "Plan",
    "measured",
    "missing",
    "plan",
    "sweep",
    "write",
]
