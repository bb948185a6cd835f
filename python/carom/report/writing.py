"""Writing ``report.html``."""

from __future__ import annotations

from pathlib import Path

from carom.io import layout
from carom.io.atomic import write_whole
from carom.io.sparing import spare_file
from carom.report.page import page
from carom.report.source import read_source

GENERATOR = '<meta name="generator" content="carom report'
"""By which a report is recognised."""


def write_report(
    directory: str | Path, *, out: str | Path | None = None, force: bool = False
) -> Path:
    """Write the report of a results directory and return its path.

    Parameters
    ----------
    directory
        Results directory, also of a run that failed, was interrupted, or still goes on.
    out
        File to write; by default ``report.html`` in the directory.
    force
        Whether a file is replaced that is there already and is not the directory's own report.

    Raises
    ------
    InputError
        The directory holds no results, or the file would be overwritten.
    """
    directory = Path(directory)
    return write_page(page(read_source(directory)), directory, out=out, force=force)


def write_page(
    text: str, directory: Path, *, out: str | Path | None = None, force: bool = False
) -> Path:
    """Write a page about a directory and return its path; see `write_report`."""
    own = directory / layout.REPORT
    file = own if out is None else Path(out)
    spare_file(file, force=force or (_is_same(file, own) and _is_report(file)))
    write_whole(file, text.encode())
    return file


def _is_same(file: Path, own: Path) -> bool:
    return file.is_file() and own.is_file() and file.samefile(own)


def _is_report(file: Path) -> bool:
    with file.open(encoding="utf-8", errors="replace") as opened:
        return GENERATOR in opened.read(2_000)
