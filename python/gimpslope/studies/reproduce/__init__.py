"""The whole reference study: its four slopes in both readings, its figures 3 to 8, a table and each
of its claims beside what the runs show, on one grid or several."""

from .plan import CELL, CELLS, REFINED, SEEDS, Plan, plan
from .study import Study, study, write

__all__ = ["CELL", "CELLS", "REFINED", "SEEDS", "Plan", "Study", "plan", "study", "write"]
