"""What steps cost: processor time, on which other work on the machine tells least."""

from __future__ import annotations

import time
from types import TracebackType
from typing import Self


class Stopwatch:
    """Core-seconds spent in its `with` blocks: processor time of all threads of this process."""

    def __init__(self) -> None:
        self.core_seconds = 0.0

    def __enter__(self) -> Self:
        self._start = time.process_time()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.core_seconds += time.process_time() - self._start
