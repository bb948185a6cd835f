"""A study over the values that it varied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from carom.display.time_unit import time_unit
from carom.sweep.curves import Diagram, curves_figure

CURVES = (
    ("energy_final", "final energy [J]"),
    ("friction", "work of friction [J]"),
    ("peak_force", "peak force [N]"),
    ("contact_time", "time in contact"),
)
"""Column of the table and label of each diagram; times are told in the unit that suits them."""

OF_IMPACTS = (
    ("restitution", "restitution"),
    ("tangential_restitution", "tangential restitution"),
)
"""Those of studies in which something bounced."""

ENERGIES = ("energy_initial", "energy_final", "friction", "plastic")
"""Columns that one energy is compared with the others of."""


def sweep_figure(title: str, keys: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw figures of the runs over the first key; the others tell the curves apart.

    Parameters
    ----------
    title
        What the picture is headed with.
    keys
        The keys that were varied.
    rows
        The rows of the table; runs that failed are left out.
    """
    completed = [one for one in rows if one["status"] == "completed"]
    unit = time_unit(_largest(completed, ["contact_time"]))
    has_impacts = any(one.get("restitution") is not None for one in completed)
    drawn = []
    for column, label in (*CURVES, *(OF_IMPACTS if has_impacts else ())):
        size = _largest(completed, ENERGIES if column in ENERGIES else [column])
        if column == "contact_time":
            drawn.append(Diagram(column, f"{label} [{unit.symbol}]", unit.seconds, size))
        else:
            drawn.append(Diagram(column, label, size=size))
    return curves_figure(title, keys, rows, completed, drawn)


def _largest(rows: Sequence[Mapping[str, Any]], columns: Sequence[str]) -> float:
    """Return the largest size of the values in some columns, 0 where there are none."""
    values = (one.get(column) for one in rows for column in columns)
    return max((abs(value) for value in values if value is not None), default=0.0)
