"""``ledger.csv``: the energy books of every body and every pair over time."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.io.history import cut
from carom.ledger_terms import TERMS

COLUMNS = ("time", "entry", *(term.name for term in TERMS), "defect")
"""Time [s], the body or the pair ``a|b``, what happened since the start [J], and its defect.

A body or a pair has the terms of its books, the others are empty; a pair from its first touch on.
"""


class LedgerWriter:
    """Writes the ledger row by row; what has been appended is on disk.

    Parameters
    ----------
    path
        File to write.
    entry
        The name of a body or a pair by its number in the rows.
    size
        As of `HistoryWriter`.
    """

    def __init__(self, path: Path, entry: Callable[[int], str], *, size: int | None = None) -> None:
        self._path = path
        self._entry = entry
        if size is None:
            self._write([COLUMNS], mode="w")
        else:
            cut(path, size)

    def append(self, rows: NDArray[np.float64]) -> None:
        """Add rows, shape [row_count, column_count]; the entry is an index, NaN is left empty."""
        if len(rows):
            self._write([self._row(row) for row in rows.tolist()], mode="a")

    def _row(self, values: Sequence[float]) -> list[object]:
        time, entry, *terms = values
        cells = ["" if math.isnan(term) else term for term in terms]
        return [time, self._entry(int(entry)), *cells]

    def _write(self, rows: Sequence[Sequence[object]], *, mode: str) -> None:
        with self._path.open(mode, encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)


def read_ledger(path: str | Path) -> dict[str, dict[str, NDArray[np.float64]]]:
    """Read a ledger: the columns of every body and pair by title, NaN where it has none.

    Raises
    ------
    InputError
        The file is not a ledger.
    """
    columns = [column for column in COLUMNS if column != "entry"]
    try:
        with Path(path).open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(line for line in file if line.endswith("\n")))
        entries = {
            entry: [row for row in rows if row["entry"] == entry]
            for entry in dict.fromkeys(row["entry"] for row in rows)
        }
        return {
            entry: {
                column: np.array([float(row[column] or "nan") for row in own]) for column in columns
            }
            for entry, own in entries.items()
        }
    except KeyError as error:
        raise InputError(f"{path}: not a ledger of carom: it has no column {error}") from error
    except (ValueError, csv.Error) as error:
        raise InputError(f"{path}: not a ledger of carom: {error}") from error
