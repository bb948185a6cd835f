"""Changing an HDF5 file so that a process that is killed on the way leaves no torn file behind.

The HDF5 library rewrites parts of a file in place. Here it works on an overlay in memory; what has
changed then goes into a journal beside the file, and from there into the file. Whoever finds a
whole journal does the second part again, whoever finds another throws it away: the file is as it
was before the change, or after it.
"""

from __future__ import annotations

import errno
import hashlib
import io
import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import h5py

from carom.errors import InputError
from carom.io.layout import JOURNAL

PAGE = 4096
"""What is kept of a change is whole pages of this size [bytes]."""

_MAGIC = b"carom journal 1\n"
_HEADER = struct.Struct("<QQ32s")  # size of the file, number of pages, SHA-256 of the pages
_NUMBER = struct.Struct("<Q")


@contextmanager
def changed(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file for a change that happens as a whole or not at all.

    Raises
    ------
    OSError
        There is no room for the change; the file is as it was.
    """
    recover(path)
    with path.open("rb") as file:
        overlay = _Overlay(file)
        with h5py.File(overlay, "r+") as hdf5:
            yield hdf5
        size, pages = overlay.changes()
    journal = _journal(path)
    before = path.stat().st_size
    try:
        journal.write_bytes(_packed(size, pages))
        _reserve(path, size)
    except OSError as error:
        os.truncate(path, before)
        journal.unlink(missing_ok=True)
        error.filename = error.filename or str(path)
        raise
    _apply(path, size, pages)
    journal.unlink()


@contextmanager
def going_on(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file of a run that goes on, for a change as `changed` makes it.

    Raises
    ------
    InputError
        The file is not there, or is damaged.
    """
    try:
        with changed(path) as file:
            yield file
    except (KeyError, OSError) as error:
        if isinstance(error, OSError) and error.errno == errno.ENOSPC:
            raise
        raise InputError(
            f"{path}: cannot be gone on with: {error}; start again with --force"
        ) from error


def shorter(path: Path, there: int, wanted: int) -> InputError:
    """Return the error of a file that has less than its checkpoint knows of."""
    return InputError(
        f"{path}: has {there} frames, its checkpoint knows of {wanted}: results were changed; "
        "start again with --force"
    )


def recover(path: Path) -> None:
    """Bring a change to an end that was journalled, or forget one that was not."""
    journal = _journal(path)
    if not journal.exists():
        return
    if (unpacked := _unpacked(journal.read_bytes())) is not None:
        _apply(path, *unpacked)
    journal.unlink()


def _journal(path: Path) -> Path:
    return path.with_name(path.name + JOURNAL)


def _reserve(path: Path, size: int) -> None:
    """Take the room that a file is going to need before anything in it is changed."""
    with path.open("r+b") as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size)


def _apply(path: Path, size: int, pages: dict[int, bytes]) -> None:
    with path.open("r+b") as file:
        for number, page in sorted(pages.items()):
            file.seek(number * PAGE)
            file.write(page[: size - number * PAGE])
        file.truncate(size)


def _packed(size: int, pages: dict[int, bytes]) -> bytes:
    body = b"".join(_NUMBER.pack(number) + page for number, page in pages.items())
    return _MAGIC + _HEADER.pack(size, len(pages), hashlib.sha256(body).digest()) + body


def _unpacked(data: bytes) -> tuple[int, dict[int, bytes]] | None:
    """Return size and pages of a journal; None of what is not a whole one."""
    start = len(_MAGIC) + _HEADER.size
    if not data.startswith(_MAGIC) or len(data) < start:
        return None
    size, count, digest = _HEADER.unpack_from(data, len(_MAGIC))
    body = data[start:]
    entry = _NUMBER.size + PAGE
    if len(body) != count * entry or hashlib.sha256(body).digest() != digest:
        return None
    entries = (body[k : k + entry] for k in range(0, len(body), entry))
    return size, {_NUMBER.unpack_from(e)[0]: e[_NUMBER.size :] for e in entries}


class _Overlay(io.RawIOBase):
    """A file whose changes are kept aside, in pages."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._size = file.seek(0, io.SEEK_END)
        self._pages: dict[int, bytearray] = {}
        self._place = 0

    def changes(self) -> tuple[int, dict[int, bytes]]:
        """Return the size of the changed file, and the pages that changed by their numbers."""
        return self._size, {number: bytes(page) for number, page in self._pages.items()}

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        start = {io.SEEK_SET: 0, io.SEEK_CUR: self._place, io.SEEK_END: self._size}[whence]
        self._place = start + offset
        return self._place

    def tell(self) -> int:
        return self._place

    def truncate(self, size: int | None = None) -> int:
        self._size = self._place if size is None else size
        return self._size

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        view = memoryview(buffer).cast("B")
        count = max(0, min(len(view), self._size - self._place))
        done = 0
        while done < count:
            number, offset = divmod(self._place + done, PAGE)
            part = min(PAGE - offset, count - done)
            page = self._pages.get(number) or self._original(number)
            view[done : done + part] = page[offset : offset + part]
            done += part
        self._place += count
        return count

    def write(self, data: memoryview) -> int:  # type: ignore[override]
        view = memoryview(data).cast("B")
        done = 0
        while done < len(view):
            number, offset = divmod(self._place + done, PAGE)
            part = min(PAGE - offset, len(view) - done)
            if number not in self._pages:
                self._pages[number] = bytearray(self._original(number))
            self._pages[number][offset : offset + part] = view[done : done + part]
            done += part
        self._place += done
        self._size = max(self._size, self._place)
        return done

    def _original(self, number: int) -> bytes:
        self._file.seek(number * PAGE)
        return self._file.read(PAGE).ljust(PAGE, b"\0")
