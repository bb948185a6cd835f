"""Energies over time."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.display.colours import BLACK, BLUE, GREEN, ORANGE, PALE_BLUE, PALE_GREY, PURPLE
from carom.display.time_unit import TimeUnit
from carom.plot.style import figure, run_unit
from carom.results.result import Result

CURVES = (
    ("kinetic", r"$E_c$ kinetic", BLUE, "-"),
    ("strain", r"$E_e$ strain", ORANGE, "-"),
    ("total", r"$E_t = E_c + E_e$", BLACK, "-"),
    ("friction", r"$D_\mathrm{friction}$", GREEN, "--"),
    ("plastic", r"$D_\mathrm{plastic}$", PURPLE, "--"),
)
"""Column of the history, label, colour and line of each curve."""

IF_ANY = ("plastic",)
"""Columns that are drawn only where there is any."""


def energy_figure(result: Result) -> Figure:
    """Draw energies and what is dissipated [J] over time, with the contacts as shades."""
    unit = run_unit(result)
    time = result.history["time"] / unit.seconds
    with figure(height=3.6) as picture:
        axes = picture.add_subplot()
        for column, label, colour, line in CURVES:
            if column in IF_ANY and not result.history[column].any():
                continue
            axes.plot(time, result.history[column], line, color=colour, label=label)
        _shade_contacts(axes, result, unit)
        axes.set_xlabel(f"time $t$ [{unit.symbol}]")
        axes.set_ylabel("energy [J]")
        axes.set_title(result.summary["title"], parse_math=False)
        picture.legend(loc="outside right center")
    return picture


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
