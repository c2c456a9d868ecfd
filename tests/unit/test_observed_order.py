"""Orders of convergence of problems with known answers, also where a grid crosses the exact
value."""

from __future__ import annotations

import numpy as np
import pytest

from gimpslope.studies.verify import inclusion, pushed_disk
from gimpslope.studies.verify.order import observed_order


@pytest.mark.parametrize("sign", [1, -1])
def test_order_of_errors_of_one_sign(sign: int) -> None:
    assert observed_order(sign * 0.4, sign * 0.1) == pytest.approx(2.0)


def test_no_order_where_the_exact_value_is_met() -> None:
    assert observed_order(0.0, 0.1) is None and observed_order(0.1, 0.0) is None


COUNTS, ERRORS = (4, 8, 16), (0.04, -0.01, -0.005)
ORDERS = [None, None, pytest.approx(1.0)]


def test_disk_that_acts_larger_and_then_smaller_than_it_is() -> None:
    disk = inclusion.DISKS[0]
    taken = {(disk.label, n): [1 + e] for n, e in zip(COUNTS, ERRORS, strict=True)}
    checks = inclusion.check_size(disk, COUNTS, taken)
    assert [check.order for check in checks[::2]] == ORDERS


def test_load_that_falls_below_the_exact_one() -> None:
    disk, exact = pushed_disk.RIGID, pushed_disk.factor(1.0)
    none, rows = np.zeros(0), np.ones(pushed_disk.ROWS)
    pushes = {
        (disk.label, n): [pushed_disk.Push(none, (exact + e) * rows, none, none)]
        for n, e in zip(COUNTS, ERRORS, strict=True)
    }
    checks = pushed_disk.check_limits(disk, COUNTS, pushes)
    assert [check.order for check in checks[::2]] == ORDERS
