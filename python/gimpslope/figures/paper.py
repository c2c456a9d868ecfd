"""Values of the paper that stand beside those of runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

Paper = Mapping[str, Mapping[str, float]]
"""Values by the names of runs, and for each by the keys of a run's summary."""


def of_runs(paper: Paper | None, names: Iterable[str]) -> Paper:
    """The values of each run; none where the paper gives none.

    Raises `ValueError` for values by a name that no run has.
    """
    names, given = list(names), paper or {}
    for name in given:
        if name not in names:
            raise ValueError(
                f"reference must be by the names of the runs, {', '.join(map(repr, names))}, "
                f"got {name!r}"
            )
    return {name: given.get(name, {}) for name in names}
