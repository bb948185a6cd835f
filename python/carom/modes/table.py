"""The energy of modes over time, as a table."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from carom.modes.split import ModalEnergies

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
