"""Coefficients of restitution, and where the energy went, over what a study varied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from carom.sweep.curves import Diagram, curves_figure

COEFFICIENTS = (
    ("restitution", "restitution e"),
    ("tangential_restitution", "tangential restitution"),
)

ENERGIES = (
    ("kept", "vibration and strain [J]"),
    ("friction", "work of friction [J]"),
    ("plastic", "plastic work [J]"),
    ("viscous", "damping [J]"),
)


def impacts_figure(title: str, keys: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw one impact of every run over the first key; the others tell the curves apart.

    Energies that are zero in all runs are left out.

    Parameters
    ----------
    title
        What the picture is headed with.
    keys
        The keys that were varied.
    rows
        The rows of the table; runs without that impact are left out.
    """
    shown = [_with_kept(one) for one in rows if one["restitution"] is not None]
    energies = [entry for entry in ENERGIES if any(one[entry[0]] for one in shown)]
    drawn = [Diagram(column, label) for column, label in (*COEFFICIENTS, *energies)]
    return curves_figure(title, keys, rows, shown, drawn)


def _with_kept(row: Mapping[str, Any]) -> dict[str, Any]:
    return {**row, "kept": row["vibration"] + row["strain"]}
