"""Curves of the runs of a study over the values that it varied."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.display.colours import BLACK, BLUE, GREEN, ORANGE, PURPLE
from carom.plot.style import figure

ROUND_OFF = 1e-9
"""Differences that are no result, in sizes of the quantity; of an energy, of the largest energy."""

FLAT = 0.05
"""What an axis shows above and below values that do not differ, in the same sizes."""

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK)

NUMBER = int | float


@dataclass(frozen=True)
class Diagram:
    """What one diagram shows.

    Parameters
    ----------
    column
        Column of the table.
    label
        What its axis is called.
    unit
        What values are divided by.
    size
        Size of the quantity, in units of the table, beside which round-off is no difference; 0
        where there is none.
    """

    column: str
    label: str
    unit: float = 1.0
    size: float = 0.0


def curves_figure(
    title: str,
    keys: Sequence[str],
    rows: Sequence[Mapping[str, Any]],
    shown: Sequence[Mapping[str, Any]],
    drawn: Sequence[Diagram],
) -> Figure:
    """Draw diagrams of the runs over the first key; the others tell the curves apart.

    Parameters
    ----------
    title
        What the picture is headed with.
    keys
        The keys that were varied.
    rows
        The rows of the table, which say what was varied.
    shown
        Those that have points, with the columns that are drawn.
    drawn
        The diagrams, two in a row.
    """
    first, *others = keys
    ticks = _ticks_of(first, rows)
    curves = dict.fromkeys(_curve_of(one, others) for one in rows)
    height = -(-len(drawn) // 2)
    with figure(height=2.5 * height) as picture:
        diagrams = picture.subplots(height, 2, sharex=True).ravel()
        for diagram, axes in zip(drawn, diagrams, strict=False):
            for number, curve in enumerate(curves):
                mine = [
                    (
                        ticks[_word(one[first])] if ticks else one[first],
                        one[diagram.column] / diagram.unit,
                    )
                    for one in shown
                    if _curve_of(one, others) == curve and one[diagram.column] is not None
                ]
                axes.plot(
                    *zip(*sorted(mine), strict=True) if mine else ([], []),
                    "o-",
                    markersize=4,
                    color=COLOURS[number % len(COLOURS)],
                    label=_title_of(others, curve),
                )
            axes.set_ylabel(diagram.label)
            axes.margins(x=0.03)
            axes.ticklabel_format(axis="y", useOffset=False)  # +2.799e6 above is not read
            _keep_flat(axes, diagram.size / diagram.unit)
        for axes in diagrams[len(drawn) :]:
            axes.set_visible(False)
        for axes in diagrams[-2:]:
            axes.set_xlabel(first, parse_math=False)
            if ticks:
                axes.set_xticks(list(ticks.values()), list(ticks))
        picture.suptitle(title, parse_math=False, x=0.02, ha="left", fontsize=11)
        if others:
            _legend(picture, diagrams[0])
    return picture


def _keep_flat(axes: Axes, size: float) -> None:
    """Draw values that differ by round-off as what they are: the same.

    Left to itself an axis spans what it is given, be it 1e-15 of the value. Where all is zero there
    is no size, and nothing to magnify.
    """
    values = [value for line in axes.lines for value in np.asarray(line.get_ydata(), dtype=float)]
    if not values or max(values) - min(values) > ROUND_OFF * size or not size:
        return
    middle = (max(values) + min(values)) / 2
    axes.set_ylim(middle - FLAT * size, middle + FLAT * size)


def _ticks_of(key: str, rows: Sequence[Mapping[str, Any]]) -> dict[str, int]:
    """Return where the values of a key that are no numbers are drawn; nothing if all are."""
    if all(isinstance(one[key], NUMBER) for one in rows):
        return {}
    return {text: n for n, text in enumerate(dict.fromkeys(_word(one[key]) for one in rows))}


def _curve_of(row: Mapping[str, Any], keys: Sequence[str]) -> tuple[str, ...]:
    """Return the values of some keys, by which a row belongs to a curve."""
    return tuple(_word(row[key]) for key in keys)


def _title_of(keys: Sequence[str], values: Sequence[str]) -> str:
    """Return what a curve is called."""
    pairs = zip(keys, values, strict=True)
    return ", ".join(f"{key.rpartition('.')[2]} = {value}" for key, value in pairs)


def _legend(picture: Figure, axes: Axes) -> None:
    """Say beside the diagrams which curve is which."""
    handles, labels = axes.get_legend_handles_labels()
    shown = list(itertools.islice(zip(handles, labels, strict=True), 12))
    picture.legend(*zip(*shown, strict=True), loc="outside right center")


def _word(value: object) -> str:
    """Return a value that was varied as it is written."""
    return value if isinstance(value, str) else json.dumps(value, default=str)
