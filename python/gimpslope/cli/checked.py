"""A command that checks the cases of a catalogue."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from ..studies.checked import Case, Catalogue, Checked, Result
from .paths import make_directory

C = TypeVar("C", bound=Case[Any])
R = TypeVar("R", bound=Result)


def prepare(
    options: argparse.Namespace,
    catalogue: Catalogue[C, R],
    text: Callable[[Sequence[Checked[C, R]]], str],
    write: Callable[..., None],
    written: str,
) -> Callable[[], int]:
    """The command of the options `names`, `full` and `output`, which shows `text` of what it has
    checked; `write(checked, directory, full=...)` puts what is `written` into the directory."""
    names = options.names or catalogue.names
    for name in names:
        catalogue.named(name)
    if options.output is not None:
        make_directory("--output", options.output)

    def command() -> int:
        checked: list[Checked[C, R]] = []
        try:
            for one in catalogue.check(names, full=options.full):
                checked.append(one)
                print(one.line, file=sys.stderr, flush=True)
                if options.output is not None:
                    one.draw(options.output)
                    write(checked, options.output, full=options.full)
        finally:  # what is checked is shown, also when the rest is interrupted
            if checked:
                print(text(checked))
        if options.output is not None:
            print(f"{written} and figures: {options.output}{os.sep}")
        return 0 if all(one.holds for one in checked) else 1

    return command
