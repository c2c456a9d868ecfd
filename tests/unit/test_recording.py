"""When rows and snapshots are due."""

from __future__ import annotations

import pytest

from gimpslope.recording import Recording


@pytest.mark.parametrize("duration", [2 / 3, 1 / 3, 0.6, 1.0, 0.1 + 0.2])
def test_the_last_snapshot_is_at_the_end_exactly(duration: float) -> None:
    times = Recording(snapshot_interval=0.2).times(duration)
    assert times[-1] == duration
    assert times[:-1] == [round(0.2 * k, 12) for k in range(len(times) - 1)]
    assert duration - times[-2] > 1e-9


def test_further_times_are_put_in_order_once() -> None:
    recording = Recording(snapshot_interval=0.5, snapshot_times=(1.6, 0.5, 0.3, 99.0))
    assert recording.times(2.0) == [0.0, 0.3, 0.5, 1.0, 1.5, 1.6, 2.0]


def test_times_of_rows_do_not_drift() -> None:
    recording = Recording(energy_interval=0.1)
    assert [recording.row_time(0.0, k) for k in (1, 3, 10)] == [0.1, 0.3, 1.0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"energy_interval": 0}, "energy_interval must be a finite number > 0, got 0"),
        ({"snapshot_interval": -1}, "snapshot_interval must be a finite number > 0, got -1"),
        ({"snapshot_times": (-0.5,)}, r"snapshot_times must be numbers >= 0, got -0\.5"),
    ],
)
def test_refusals(options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Recording(**options)  # type: ignore[arg-type]
