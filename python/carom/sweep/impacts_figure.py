"""Coefficients of restitution, and where the energy went, over what a study varied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from carom.plot.style import figure
from carom.sweep.figure import COLOURS, curve_of, curve_title, legend, ticks_of, word

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
    first, *others = keys
    shown = [_with_kept(one) for one in rows if one["restitution"] is not None]
    ticks = ticks_of(first, rows)
    curves = dict.fromkeys(curve_of(one, others) for one in rows)
    energies = [entry for entry in ENERGIES if any(one[entry[0]] for one in shown)]
    drawn = (*COEFFICIENTS, *energies)
    with figure(height=2.5 * -(-len(drawn) // 2)) as picture:
        diagrams = picture.subplots(-(-len(drawn) // 2), 2, sharex=True).ravel()
        for (column, label), axes in zip(drawn, diagrams, strict=False):
            for number, curve in enumerate(curves):
                mine = [
                    (ticks[word(one[first])] if ticks else one[first], one[column])
                    for one in shown
                    if curve_of(one, others) == curve and one[column] is not None
                ]
                axes.plot(
                    *zip(*sorted(mine), strict=True) if mine else ([], []),
                    "o-",
                    markersize=4,
                    color=COLOURS[number % len(COLOURS)],
                    label=curve_title(others, curve),
                )
            axes.set_ylabel(label)
            axes.margins(x=0.03)
            axes.ticklabel_format(axis="y", useOffset=False)
        for axes in diagrams[len(drawn) :]:
            axes.set_visible(False)
        for axes in diagrams[-2:]:
            axes.set_xlabel(first, parse_math=False)
            if ticks:
                axes.set_xticks(list(ticks.values()), list(ticks))
        picture.suptitle(title, parse_math=False, x=0.02, ha="left", fontsize=11)
        if others:
            legend(picture, diagrams[0])
    return picture


def _with_kept(row: Mapping[str, Any]) -> dict[str, Any]:
    return {**row, "kept": row["vibration"] + row["strain"]}
