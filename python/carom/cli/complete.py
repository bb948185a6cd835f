"""What the shell offers for the words of a command."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from carom.io import layout


def case_files(incomplete: str) -> Iterator[str]:
    """Yield the directories and case files that begin so."""
    for path in _beginning(incomplete):
        if path.is_dir():
            yield f"{path}/"
        elif path.suffix == ".toml":
            yield str(path)


def results(incomplete: str) -> Iterator[str]:
    """Yield the directories that begin so; those that hold results end without a slash."""
    for path in _beginning(incomplete):
        if path.is_dir():
            yield str(path) if (path / layout.CASE).exists() else f"{path}/"


def names(known: Iterable[str]) -> Callable[[str], list[str]]:
    """Return what offers these words."""
    return lambda incomplete: [name for name in known if name.startswith(incomplete)]


def _beginning(incomplete: str) -> list[Path]:
    """Return the paths that begin so, hidden ones only where that is asked for."""
    parent, _, start = incomplete.rpartition("/")
    directory = Path(parent or ("/" if incomplete.startswith("/") else "."))
    try:
        found = sorted(path for path in directory.iterdir() if path.name.startswith(start))
    except OSError:
        return []
    return [path for path in found if start.startswith(".") or not path.name.startswith(".")]
