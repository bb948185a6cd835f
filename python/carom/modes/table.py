"""The energy of modes over time, as a table."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from itertools import groupby
from operator import itemgetter
from pathlib import Path

import numpy as np

from carom.errors import InputError
from carom.modes.energies import ModalEnergies

HEADER = ("time", "body", "part", "frequency", "kinetic", "strain")
"""Titles of the columns; a part is ``rigid``, the number of a mode from 1, or ``rest``."""


def modes_csv(bodies: Iterable[ModalEnergies]) -> str:
    """Return a row for every part of the energy of every body at every time."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(HEADER)
    for one in bodies:
        for frame, time in enumerate(one.times.tolist()):
            rows.writerow((time, one.body, "rigid", 0.0, float(one.rigid[frame]), 0.0))
            parts = zip(one.frequencies, one.kinetic[frame], one.strain[frame], strict=True)
            for number, part in enumerate(parts, start=1):
                rows.writerow((time, one.body, number, *map(float, part)))
            rest = float(one.rest_kinetic[frame]), float(one.rest_strain[frame])
            rows.writerow((time, one.body, "rest", "", *rest))
    return text.getvalue()


def read_modes(path: Path) -> dict[str, ModalEnergies]:
    """Read a table back: the energies of every body by its name.

    Raises
    ------
    InputError
        The file is none of these.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        if tuple(header) != HEADER:
            raise ValueError(f"its first line is not {','.join(HEADER)}")
        bodies = groupby(rows, key=itemgetter(HEADER.index("body")))
        return {name: _of_rows(name, list(of_body)) for name, of_body in bodies}
    except (ValueError, IndexError, csv.Error) as error:
        raise InputError(f"{path}: no energies by modes of carom: {error}") from error


def _of_rows(name: str, rows: list[list[str]]) -> ModalEnergies:
    """Return the energies of a body by the rows of all times, which have the same parts."""
    parts = [row[2] for row in rows]
    each = parts.index("rest") + 1
    if parts != parts[:each] * (len(rows) // each):
        raise ValueError(f"the times of {name} have not all the same parts")
    times = np.array([row[0] for row in rows[::each]], dtype=np.float64)
    frequencies = np.array([row[3] for row in rows[1 : each - 1]], dtype=np.float64)
    values = np.array([row[4:6] for row in rows], dtype=np.float64)
    kinetic, strain = np.moveaxis(values.reshape(len(times), each, 2), 2, 0)
    return ModalEnergies(
        name,
        times,
        frequencies,
        rigid=kinetic[:, 0],
        kinetic=kinetic[:, 1:-1],
        strain=strain[:, 1:-1],
        rest_kinetic=kinetic[:, -1],
        rest_strain=strain[:, -1],
    )
