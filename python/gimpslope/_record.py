"""Parameters as plain JSON data and back, so that a run file can tell exactly what was run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, ClassVar, Self

import numpy as np


@dataclass(frozen=True, eq=False)
class Record:
    """A frozen dataclass of parameters that turns into tagged plain data and back.

    The tag is the name of the class: `Elastic(...)` becomes `{"type": "Elastic", "density": ...}`.
    """

    _kinds: ClassVar[dict[str, type[Record]]] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        Record._kinds[cls.__name__] = cls

    def to_dict(self) -> dict[str, Any]:
        """This record as data that `json.dumps` takes, nested records included."""
        values = {field.name: _plain(getattr(self, field.name)) for field in fields(self)}
        return {"type": type(self).__name__, **values}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The record that `to_dict` turned into `data`, with every parameter checked anew.

        Raises `TypeError` or `ValueError` for a type that is unknown or not this one, for keys that
        are unknown or missing, and for whatever the record itself refuses.
        """
        if not isinstance(data, Mapping):
            raise TypeError(f"{cls.__name__} must be given as a mapping, got {data!r}")
        kind = cls._kinds.get(str(data.get("type")), Record)
        if kind is Record or not issubclass(kind, cls):
            raise ValueError(f"type must name a kind of {cls.__name__}, got {data.get('type')!r}")
        values = {key: _record(value) for key, value in data.items() if key != "type"}
        _check_keys(kind, values)
        return kind(**values)

    def _store(self, **values: object) -> None:
        """Put checked values in place of those given; for use while the record is being made."""
        for name, value in values.items():
            object.__setattr__(self, name, value)


def _plain(value: Any) -> Any:
    if isinstance(value, Record):
        return value.to_dict()
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray) else value


def _record(value: Any) -> Any:
    if isinstance(value, Mapping):
        return Record.from_dict(value)
    if isinstance(value, list):
        return tuple(_record(item) for item in value)
    return value


def _check_keys(kind: type[Record], values: Mapping[str, Any]) -> None:
    known = {field.name: field for field in fields(kind)}
    if unknown := sorted(set(values) - set(known)):
        raise ValueError(
            f"{kind.__name__} has no {', '.join(map(repr, unknown))}; "
            f"its keys are {', '.join(known) or 'none'}"
        )
    needed = {name for name, field in known.items() if field.default is MISSING}
    if missing := sorted(needed - set(values)):
        raise ValueError(f"{kind.__name__} needs {', '.join(map(repr, missing))}, which is missing")
