"""Changes to an HDF5 file that reach the disk in an order which is valid after every write.

HDF5 itself writes its structures in no useful order when it closes a file, so a process killed at
that moment can leave a file that cannot be read. Here the changes are kept in memory until HDF5 has
finished, then written so that nothing refers to what is not there yet: new space, the superblock
(which holds the length of the file), the chunk trees from the root down, data and object headers,
and last the group entries that make new objects visible. A failure before that, such as an
exception or a full disk, leaves the file as it was.

Only the lengths of several datasets that grow together are not changed in one go: stopped between
them, some are longer than others by what was being added, and the shortest tells what is complete.

The signatures are those of the HDF5 file format specification, version 3.0, section III.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import h5py

from ..interrupts import uninterrupted

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer, WriteableBuffer


@contextmanager
def change(path: Path) -> Iterator[h5py.File]:
    """Open the HDF5 file at `path` for appending; its changes are written when the block ends.

    The file is made when it does not exist or is empty. When the block raises, nothing is written.
    Ctrl-C and SIGTERM wait until then: HDF5 turns one that comes in its calls into another error.
    """
    with uninterrupted(), path.open("r+b" if path.exists() else "w+b", buffering=0) as disk:
        staged = _StagedFile(disk)
        mode = "r+" if staged.size else "w"
        with h5py.File(staged, mode, libver="earliest") as file:
            yield file
        staged.commit()


class _StagedFile(io.RawIOBase):
    """A file whose writes stay in memory, and are visible to its own reads, until `commit`."""

    def __init__(self, disk: io.FileIO) -> None:
        self._disk = disk
        self._disk_size = disk.seek(0, io.SEEK_END)
        self._pending: list[tuple[int, bytes]] = []
        self._pending_end = 0
        self._position = 0
        self.size = self._disk_size

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        start = {io.SEEK_SET: 0, io.SEEK_CUR: self._position, io.SEEK_END: self.size}[whence]
        self._position = start + offset
        return self._position

    def readinto(self, buffer: WriteableBuffer) -> int:
        view = memoryview(buffer).cast("B")
        start, stop = self._position, self._position + len(view)
        self._disk.seek(start)
        found = self._disk.readinto(view) or 0
        view[found:] = bytes(len(view) - found)
        for offset, data in self._pending:
            first, last = max(start, offset), min(stop, offset + len(data))
            if first < last:
                view[first - start : last - start] = data[first - offset : last - offset]
        self._position = stop
        return len(view)

    def write(self, data: ReadableBuffer) -> int:
        new = bytes(data)
        start, stop = self._position, self._position + len(new)
        if start < self._pending_end:
            self._pending = [
                piece for old in self._pending for piece in _outside(old, start, stop) if piece[1]
            ]
        self._pending.append((start, new))
        self._pending_end = max(self._pending_end, stop)
        self._position = stop
        self.size = max(self.size, stop)
        return len(new)

    def truncate(self, size: int | None = None) -> int:
        self.size = self._position if size is None else size
        return self.size

    def commit(self) -> None:
        """Write the pending changes to the disk in the order described above."""
        ordered = sorted(self._pending, key=lambda piece: _rank(piece, self._disk_size))
        new = [piece for piece in ordered if piece[0] >= self._disk_size]
        self._write_to_disk(new)
        self._disk.truncate(max(self.size, self._disk_size))
        self._write_to_disk(ordered[len(new) :])
        self._disk.truncate(self.size)
        self._pending, self._pending_end = [], 0

    def _write_to_disk(self, pieces: list[tuple[int, bytes]]) -> None:
        for offset, data in pieces:
            self._disk.seek(offset)
            rest = memoryview(data)
            while rest:
                rest = rest[self._disk.write(rest) :]


def _outside(piece: tuple[int, bytes], start: int, stop: int) -> list[tuple[int, bytes]]:
    """The parts of a piece of the file that lie outside of the bytes start:stop."""
    offset, data = piece
    if offset + len(data) <= start or stop <= offset:
        return [piece]
    return [(offset, data[: max(0, start - offset)]), (stop, data[stop - offset :])]


def _rank(piece: tuple[int, bytes], old_size: int) -> tuple[int, int]:
    """Where a piece stands in the order of writing; equal ranks keep HDF5's own order."""
    offset, data = piece
    if offset >= old_size:
        return 0, 0
    if offset == 0:
        return 1, 0
    if data.startswith(b"TREE"):
        of_chunks, level = data[4] == 1, data[5]
        return (2 if of_chunks else 4), -level
    if data.startswith(b"SNOD"):
        return 5, 0
    return 3, 0
