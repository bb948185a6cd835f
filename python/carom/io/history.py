"""``history.csv``: one row of numbers per recorded time."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError


class HistoryWriter:
    """Writes the history row by row; what has been appended is on disk.

    Numbers are written as the shortest text that reads back as the same float, which takes at
    most 17 significant digits.

    Parameters
    ----------
    path
        File to write.
    columns
        Titles of the columns.
    size
        Size of a file that is there and goes on [bytes]: what it has beyond that is cut off.
        None starts a new one.
    """

    def __init__(self, path: Path, columns: Sequence[str], *, size: int | None = None) -> None:
        self._path = path
        if size is None:
            self._write([list(columns)], mode="w")
        else:
            cut(path, size)

    def append(self, rows: NDArray[np.float64]) -> None:
        """Add rows, shape [row_count, column_count]."""
        if len(rows):
            self._write(rows.tolist(), mode="a")

    def _write(self, rows: Sequence[Sequence[object]], *, mode: str) -> None:
        with self._path.open(mode, encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)


def cut(path: Path, size: int) -> None:
    """Shorten a file to a size that it had before [bytes].

    Raises
    ------
    InputError
        It is shorter already.
    """
    there = path.stat().st_size if path.exists() else 0
    if there < size:
        raise InputError(
            f"{path}: has {there} bytes, its checkpoint knows of {size}: results were changed; "
            "start again with --force"
        )
    os.truncate(path, size)


def read_history(path: str | Path) -> dict[str, NDArray[np.float64]]:
    """Read a history into one array per column, each of shape [row_count].

    A last line that a killed run left unfinished is passed over.

    Raises
    ------
    InputError
        The file is not a history.
    """
    try:
        with Path(path).open(encoding="utf-8", newline="") as file:
            lines = [line for line in file if line.endswith("\n")]
        columns, *rows = csv.reader(lines)
        if columns[:1] != ["time"]:
            raise ValueError('its first column is not "time"')
        values = np.array(rows, dtype=np.float64).reshape(len(rows), len(columns))
    except (ValueError, csv.Error) as error:
        raise InputError(f"{path}: not a history of carom: {error}") from error
    return {column: values[:, index] for index, column in enumerate(columns)}
