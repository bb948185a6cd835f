"""A study over the values that it varied."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.plot.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, figure

CURVES = (
    ("energy_final", "final energy [J]"),
    ("friction", "friction [J]"),
    ("peak_force", "peak force [N]"),
    ("contact_time", "time in contact [s]"),
)
"""Column of the table and label of each diagram."""

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
    numeric = all(isinstance(one[first], NUMBER) for one in rows)
    ticks = {word: n for n, word in enumerate(dict.fromkeys(_word(one[first]) for one in rows))}
    curves = dict.fromkeys(tuple(_word(one[key]) for key in others) for one in rows)
    with figure(height=5.0) as picture:
        diagrams = picture.subplots(2, 2, sharex=True).ravel()
        for (column, label), axes in zip(CURVES, diagrams, strict=True):
            for number, curve in enumerate(curves):
                mine = [
                    (one[first] if numeric else ticks[_word(one[first])], one[column])
                    for one in completed
                    if tuple(_word(one[key]) for key in others) == curve and one[column] is not None
                ]
                axes.plot(
                    *zip(*sorted(mine), strict=True) if mine else ([], []),
                    "o-",
                    markersize=4,
                    color=COLOURS[number % len(COLOURS)],
                    label=_curve(others, curve),
                )
            axes.set_ylabel(label)
            axes.margins(x=0.03)
        for axes in diagrams[2:]:
            axes.set_xlabel(first, parse_math=False)
            if not numeric:
                axes.set_xticks(list(ticks.values()), list(ticks))
        picture.suptitle(title, parse_math=False, x=0.02, ha="left", fontsize=11)
        if others:
            _legend(picture, diagrams[0])
    return picture


def _curve(keys: Sequence[str], values: Sequence[str]) -> str:
    pairs = zip(keys, values, strict=True)
    return ", ".join(f"{key.rpartition('.')[2]} = {value}" for key, value in pairs)


def _legend(picture: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    shown = list(itertools.islice(zip(handles, labels, strict=True), 12))
    picture.legend(*zip(*shown, strict=True), loc="outside right center")


def _word(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)
