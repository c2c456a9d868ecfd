"""Files and directories that a command is to write, checked before any work is done."""

from __future__ import annotations

import os
from pathlib import Path


def make_directory(option: str, path: str) -> None:
    """Make, before any work is done, the directory for what comes of it."""
    if not path or Path(path).is_file():
        raise ValueError(f"{option} must be a directory, got {path!r}")
    Path(path).mkdir(parents=True, exist_ok=True)


def make_empty_directory(option: str, path: str, *, overwrite: bool) -> None:
    """Make a directory in the same way, and refuse one that holds files unless it may."""
    make_directory(option, path)
    if os.listdir(path) and not overwrite:
        raise ValueError(
            f"{option} must be an empty directory unless --overwrite is given, got {path!r}"
        )


def check_file(option: str, path: str | None, ending: str = "") -> None:
    """Refuse, before any work is done, a file that could not be written after it, or has another
    ending than is wanted."""
    if path is None:
        return
    if not has_ending(path, ending):
        raise ValueError(f"{option} must be a file that ends in {ending}, got {path!r}")
    folder = Path(path).absolute().parent
    if Path(path).is_dir() or not folder.is_dir():
        raise ValueError(f"{option} must be a file in a directory that exists, got {path!r}")
    if not os.access(path if Path(path).exists() else folder, os.W_OK):
        raise ValueError(f"{option} must be a file that may be written, got {path!r}")


def has_ending(path: str, ending: str) -> bool:
    """Whether a path ends in ".h5", say, in capitals or not."""
    return path.lower().endswith(ending)
