"""Files that are whole or not there."""

from __future__ import annotations

import os
from pathlib import Path

from carom.io.layout import UNFINISHED


def write_whole(path: Path, data: bytes, *, durable: bool = False) -> None:
    """Put a file in place of another of its name, whole or not at all.

    Parameters
    ----------
    path
        File to write.
    data
        All of its contents.
    durable
        Whether to wait until the disk has it, so that it survives a power failure too.

    Raises
    ------
    OSError
        It could not be written; what was there before still is.
    """
    unfinished = path.with_name(path.name + UNFINISHED)
    try:
        with unfinished.open("wb") as file:
            file.write(data)
            if durable:
                file.flush()
                os.fsync(file.fileno())
        unfinished.replace(path)
    except OSError:
        unfinished.unlink(missing_ok=True)
        raise
    if durable:
        sync_names(path.parent)


def sync(path: Path) -> None:
    """Wait until the disk has what was written to a file."""
    with path.open("rb") as file:
        os.fsync(file.fileno())


def sync_names(directory: Path) -> None:
    """Wait until the disk has the names of the files in a directory."""
    if os.name != "posix":
        return  # elsewhere a directory cannot be opened
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
