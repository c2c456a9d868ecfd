"""Results as JSON that any reader takes: numbers that are not finite become null."""

from __future__ import annotations

import json
import math
from typing import Any


def dumps(data: Any) -> str:
    """`data` (mappings, sequences, numbers, text) as JSON text with a line break at its end."""
    return json.dumps(_plain(data), indent=2, allow_nan=False) + "\n"


def _plain(data: Any) -> Any:
    if isinstance(data, dict):
        return {name: _plain(value) for name, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(value) for value in data]
    if isinstance(data, float):
        return float(data) if math.isfinite(data) else None
    return data
