"""The whole reference study: its four slopes in both readings, its figures 3 to 8, a table and each
of its claims beside what the runs show."""

from .study import SEEDS, Study, plan, study, write

__all__ = ["SEEDS", "Study", "plan", "study", "write"]
