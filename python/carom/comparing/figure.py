"""Two runs in one picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from carom.comparing.comparison import Comparison
from carom.display.colours import BLUE, ORANGE
from carom.plot.style import figure, run_unit

ENERGIES = ("kinetic", "strain", "friction", "total")
"""What is drawn without being asked for."""

ROW = 2.2
"""Height of a diagram [inch]."""


def comparison_figure(comparison: Comparison, columns: Sequence[str] | None = None) -> Figure:
    """Draw columns of two runs over time: the first as a broad pale line, the second on it.

    Parameters
    ----------
    comparison
        Of the two.
    columns
        Titles of columns that both have; the energies if none are named.

    Raises
    ------
    InputError
        They have no column of a title.
    """
    drawn = list(columns) if columns else [c for c in ENERGIES if c in comparison.columns]
    for column in drawn:
        comparison.over_time(column)
    first, second = comparison.first, comparison.second
    unit = run_unit(max(first, second, key=lambda run: run.history["time"].max(initial=0.0)))
    names = _names(first.path.as_posix(), second.path.as_posix())
    with figure(height=ROW * len(drawn) + 0.4) as picture:
        diagrams = np.atleast_1d(picture.subplots(len(drawn), 1, sharex=True))
        for column, axes in zip(drawn, diagrams, strict=True):
            for run, name, style in (
                (first, names[0], {"color": BLUE, "linewidth": 4.0, "alpha": 0.4}),
                (second, names[1], {"color": ORANGE, "linewidth": 1.2}),
            ):
                axes.plot(
                    run.history["time"] / unit.seconds, run.history[column], label=name, **style
                )
            label = f"{column} [J]" if column in ENERGIES else column
            axes.set_ylabel(label, parse_math=False)
        diagrams[-1].set_xlabel(f"time [{unit.symbol}]")
        handles, labels = diagrams[0].get_legend_handles_labels()
        picture.legend(handles, labels, loc="outside upper left", ncols=2)
    return picture


def _names(first: str, second: str) -> tuple[str, str]:
    """Return what tells two paths apart: all of them, where it is not the last part."""
    ends = first.rpartition("/")[2], second.rpartition("/")[2]
    return ends if ends[0] != ends[1] else (first, second)
