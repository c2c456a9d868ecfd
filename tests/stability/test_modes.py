"""Every mode of failure, measured quickly: what should fail does, and the default does not."""

from __future__ import annotations

import pytest
from matplotlib.figure import Figure

from gimpslope.studies import stability


@pytest.mark.parametrize("name", stability.NAMES)
def test_mode(name: str) -> None:
    mode = stability.mode(name)
    assert mode.name == name
    assert mode.source and mode.advice and mode.mechanism.count(".") >= 3
    found = mode.run(False)
    assert isinstance(found.figure, Figure) and found.figure.axes
    assert found.fails and found.stands
    for check in found.checks:
        assert check.why
        assert check.holds, f"{check.quantity}: {check.got} is not in [{check.low}, {check.high}]"
