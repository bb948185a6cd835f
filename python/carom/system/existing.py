"""What is there already is not replaced by a command that was not told to."""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path

from carom.errors import InputError

OF_NOBODY = frozenset({".DS_Store", ".gitignore", ".gitkeep", "Thumbs.db", "desktop.ini"})
"""Files that systems and version control leave in directories without being asked."""


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
    if leads_nowhere(file):
        raise InputError(f"{file}: is a link that leads nowhere; name another file")
    if os.path.lexists(file) and not force:
        raise InputError(f"{file}: is there already; give --force to replace it")
    parent = file.parent
    if os.path.lexists(parent) and not parent.is_dir() and not leads_nowhere(parent):
        raise InputError(f"{file}: {parent} is a file; name a directory that is there")
    if not parent.is_dir():
        raise InputError(f"{file}: there is no directory {parent}; make it first")
    if not os.access(parent, os.W_OK | os.X_OK):
        raise InputError(f"{file}: {parent} cannot be written to; name another directory")


def leads_nowhere(path: Path) -> bool:
    """Return whether a path is a link to nothing."""
    return path.is_symlink() and not path.exists()


def entries(directory: Path) -> set[str]:
    """Return the names in a directory that files are to be written into; none if it is not there.

    Raises
    ------
    InputError
        There is something else in its place, or it cannot be written to.
    """
    try:
        return _entries(directory)
    except OSError as error:
        raise InputError(
            f"{directory}: cannot be reached: {error.strerror or error}; choose another --out"
        ) from error


def _entries(directory: Path) -> set[str]:
    place = directory
    while not place.is_dir() and place != place.parent:
        if leads_nowhere(place):
            raise InputError(f"{place}: is a link that leads nowhere; choose another --out")
        if os.path.lexists(place):
            if place.is_dir():  # which another run has made since
                break
            raise InputError(f"{place}: is a file; choose another --out")
        place = place.parent
    if not os.access(place, os.R_OK | os.W_OK | os.X_OK):
        raise InputError(f"{place}: cannot be written to; choose another --out")
    return {path.name for path in directory.iterdir()} if place == directory else set()


def refuse_foreign(directory: Path, names: Collection[str], *, of: str) -> None:
    """Refuse a directory with files of others.

    Parameters
    ----------
    directory
        Where files are to be written.
    names
        What is there and is not known to be carom's.
    of
        What would be replaced without a word, such as "a carom run".

    Raises
    ------
    InputError
        There is something that is somebody's.
    """
    if foreign := sorted(set(names) - OF_NOBODY):
        raise InputError(
            f"{directory}: has a {foreign[0]} that is not of {of}; choose another --out"
        )


def make(directory: Path) -> None:
    """Make a directory to write into.

    Raises
    ------
    InputError
        It cannot be made.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:  # the latter of a character that no name has
        why = getattr(error, "strerror", None) or error
        raise InputError(f"{directory}: cannot be made: {why}; choose another --out") from error
