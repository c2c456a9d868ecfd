"""Model no more than is needed: the cheapest run for an error that is asked for."""

from .estimate import Estimate
from .plan import Answer, Plan, plan
from .quantities import DEFAULT, QUANTITIES
from .target import Target

__all__ = ["DEFAULT", "QUANTITIES", "Answer", "Estimate", "Plan", "Target", "plan"]
