"""What is there already is not replaced by a command that was not told to."""

from __future__ import annotations

from pathlib import Path

from carom.errors import InputError


def spare_existing(file: Path, *, force: bool) -> None:
    """Refuse a file to write that is there, before anything is computed for it.

    Parameters
    ----------
    file
        File to write.
    force
        Whether one that is there is replaced.

    Raises
    ------
    InputError
        It is there and `force` does not say to replace it, or it cannot be there.
    """
    if file.is_dir():
        raise InputError(f"{file}: is a directory; name a file in it")
    if file.exists() and not force:
        raise InputError(f"{file}: is there already; give --force to replace it")
    if not file.parent.is_dir():
        raise InputError(f"{file}: there is no directory {file.parent}; make it first")
