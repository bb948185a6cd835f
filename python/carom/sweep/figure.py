"""A study over the values that it varied."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.display.colours import BLACK, BLUE, GREEN, ORANGE, PURPLE
from carom.display.time_unit import time_unit
from carom.plot.style import figure

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

ROUND_OFF = 1e-9
"""Differences that are no result, in sizes of the quantity; of an energy, of the largest energy."""

FLAT = 0.05
"""What an axis shows above and below values that do not differ, in the same sizes."""

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK)

NUMBER = int | float


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
    first, *others = keys
    completed = [one for one in rows if one["status"] == "completed"]
    ticks = ticks_of(first, rows)
    curves = dict.fromkeys(curve_of(one, others) for one in rows)
    unit = time_unit(_largest(completed, ["contact_time"]))
    has_impacts = any(one.get("restitution") is not None for one in completed)
    drawn = (*CURVES, *(OF_IMPACTS if has_impacts else ()))
    with figure(height=2.5 * len(drawn) / 2) as picture:
        diagrams = picture.subplots(len(drawn) // 2, 2, sharex=True).ravel()
        for (column, label), axes in zip(drawn, diagrams, strict=True):
            for number, curve in enumerate(curves):
                mine = [
                    (
                        ticks[word(one[first])] if ticks else one[first],
                        one[column] / unit.seconds if column == "contact_time" else one[column],
                    )
                    for one in completed
                    if curve_of(one, others) == curve and one[column] is not None
                ]
                axes.plot(
                    *zip(*sorted(mine), strict=True) if mine else ([], []),
                    "o-",
                    markersize=4,
                    color=COLOURS[number % len(COLOURS)],
                    label=curve_title(others, curve),
                )
            axes.set_ylabel(f"{label} [{unit.symbol}]" if column == "contact_time" else label)
            axes.margins(x=0.03)
            axes.ticklabel_format(axis="y", useOffset=False)  # +2.799e6 above is not read
            size = _largest(completed, ENERGIES if column in ENERGIES else [column])
            _keep_flat(axes, size / (unit.seconds if column == "contact_time" else 1.0))
        for axes in diagrams[-2:]:
            axes.set_xlabel(first, parse_math=False)
            if ticks:
                axes.set_xticks(list(ticks.values()), list(ticks))
        picture.suptitle(title, parse_math=False, x=0.02, ha="left", fontsize=11)
        if others:
            legend(picture, diagrams[0])
    return picture


def _largest(rows: Sequence[Mapping[str, Any]], columns: Sequence[str]) -> float:
    """Return the largest size of the values in some columns, 0 where there are none."""
    values = (one.get(column) for one in rows for column in columns)
    return max((abs(value) for value in values if value is not None), default=0.0)


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


def ticks_of(key: str, rows: Sequence[Mapping[str, Any]]) -> dict[str, int]:
    """Return where the values of a key that are no numbers are drawn; nothing if all are."""
    if all(isinstance(one[key], NUMBER) for one in rows):
        return {}
    return {text: n for n, text in enumerate(dict.fromkeys(word(one[key]) for one in rows))}


def curve_of(row: Mapping[str, Any], keys: Sequence[str]) -> tuple[str, ...]:
    """Return the values of some keys, by which a row belongs to a curve."""
    return tuple(word(row[key]) for key in keys)


def curve_title(keys: Sequence[str], values: Sequence[str]) -> str:
    """Return what a curve is called."""
    pairs = zip(keys, values, strict=True)
    return ", ".join(f"{key.rpartition('.')[2]} = {value}" for key, value in pairs)


def legend(picture: Figure, axes: Axes) -> None:
    """Say beside the diagrams which curve is which."""
    handles, labels = axes.get_legend_handles_labels()
    shown = list(itertools.islice(zip(handles, labels, strict=True), 12))
    picture.legend(*zip(*shown, strict=True), loc="outside right center")


def word(value: object) -> str:
    """Return a value that was varied as it is written."""
    return value if isinstance(value, str) else json.dumps(value, default=str)
