"""Energies over time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.display.colours import BLACK, BLUE, GREEN, ORANGE, PALE_BLUE, PALE_GREY, PURPLE, SKY
from carom.display.time_unit import TimeUnit
from carom.plot.style import figure, run_unit
from carom.results.result import Result

CURVES = (
    ("kinetic", r"$E_c$ kinetic", BLUE, "-"),
    ("strain", r"$E_e$ strain", ORANGE, "-"),
    ("springs", r"$E_s$ springs", SKY, "-"),
    ("total", r"$E_t$ total", BLACK, "-"),
    ("friction", r"$D_\mathrm{friction}$", GREEN, "--"),
    ("plastic", r"$D_\mathrm{plastic}$", PURPLE, "--"),
    ("dampers", r"$D_\mathrm{dampers}$", BLUE, "--"),
)
"""Column of the history, label, colour and line of each curve."""

IF_ANY = ("springs", "plastic", "dampers")
"""Columns that are drawn only where there is any."""


def energy_figure(result: Result) -> Figure:
    """Draw energies and what is dissipated [J] over time, with the contacts as shades.

    Stages stand side by side, each with a time axis of its own: an impact may be a ten-thousandth
    of the preload before it.
    """
    unit = run_unit(result)
    time = result.history["time"] / unit.seconds
    parts = list(_parts(result))
    with figure(height=3.6) as picture:
        row = picture.subplots(1, len(parts), sharey=True, squeeze=False)[0]
        for axes, (name, rows) in zip(row, parts, strict=True):
            for column, label, colour, line in CURVES:
                if column in IF_ANY and not result.history[column].any():
                    continue
                values = result.history[column][rows]
                axes.plot(time[rows], values, line, color=colour, label=label)
            _shade_contacts(axes, result, unit)
            if name:
                axes.set_xlim(time[rows][0], time[rows][-1])
                axes.set_xlabel(name)
                axes.tick_params(axis="x", labelrotation=30.0)
        if len(parts) == 1:
            row[0].set_xlabel(f"time $t$ [{unit.symbol}]")
        else:
            picture.supxlabel(f"time $t$ [{unit.symbol}]")
        row[0].set_ylabel("energy [J]")
        row[0].set_title(result.summary["title"], parse_math=False)
        handles, labels = row[0].get_legend_handles_labels()
        picture.legend(handles, labels, loc="outside right center")
    return picture


def _parts(result: Result) -> Iterator[tuple[str, slice]]:
    """Yield the name and the rows of every stage that has come to an end of a step."""
    stage = result.history.get("stage")
    if stage is None:
        yield "", slice(None)
        return
    for number, entry in enumerate(result.summary.get("stages", []), start=1):
        first, last = np.searchsorted(stage, [number, number + 1])
        if last > first:
            # From the end of the stage before.
            yield entry["name"], slice(max(int(first) - 1, 0), int(last))


def _shade_contacts(axes: Axes, result: Result, unit: TimeUnit) -> None:
    """Shade when two bodies touch, and more lightly when a body touches an obstacle."""
    obstacles = {obstacle.name for obstacle in result.scenario.obstacles}
    labelled = set()
    for contact in result.summary["contacts"]:
        with_obstacle = not obstacles.isdisjoint(contact["pair"])
        label = "body on obstacle" if with_obstacle else "body on body"
        release = contact["release"]
        axes.axvspan(
            contact["onset"] / unit.seconds,
            (result.history["time"][-1] if release is None else release) / unit.seconds,
            color=PALE_BLUE if with_obstacle else PALE_GREY,
            linewidth=0,
            zorder=0 if with_obstacle else 0.5,
            label=None if label in labelled else label,
        )
        labelled.add(label)
