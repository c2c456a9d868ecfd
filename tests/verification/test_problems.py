"""Every problem with a known answer, solved quickly, holds."""

from __future__ import annotations

import pytest
from matplotlib.figure import Figure

from gimpslope.studies import verify


@pytest.mark.parametrize("name", verify.NAMES)
def test_problem(name: str) -> None:
    problem = verify.problem(name)
    assert problem.name == name
    outcome = problem.run(False)
    assert outcome.checks
    assert isinstance(outcome.figure, Figure) and outcome.figure.axes
    for check in outcome.checks:
        assert check.why
        assert check.holds, f"{check.quantity}: {check.got} is not in [{check.low}, {check.high}]"
