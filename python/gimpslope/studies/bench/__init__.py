"""The speed of the kernel on slope A: against the plain loop, against what the machine can do at
most, and where the time goes."""

from . import guard, report
from .cases import SLOPE_A, Case
from .plan import SIZES, Plan
from .results import Results, run
from .speed import Measurement

__all__ = ["SIZES", "SLOPE_A", "Case", "Measurement", "Plan", "Results", "guard", "report", "run"]
