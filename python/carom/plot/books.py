"""Where the energy is over time: what is stored and what was taken, one upon the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from carom.display.colours import FAINT, INK, NAMED
from carom.display.si_prefix import prefixed
from carom.display.time_unit import TimeUnit
from carom.ledger_terms import terms

SHORT = {
    "kinetic": "kinetic",
    "strain": "strain",
    "springs": "springs",
    "friction": "friction",
    "viscous": "damping, viscosity",
    "dampers": "dampers",
    "plastic": "plastic flow",
    "scheme": "time scheme",
    "normal_contact": "normal reactions",
    "settling": "settling of contacts",
}
"""What the terms that are drawn are called where there is little space."""

LEAST = 1e-4
"""Of the largest energy: terms that stay below it are not drawn, for nothing would be seen."""

History = Mapping[str, NDArray[np.float64]]


@dataclass(frozen=True)
class Layer:
    """A term as it is drawn: its label, its colour and its values [J], shape [row_count]."""

    label: str
    colour: str
    values: NDArray[np.float64]


def layers(history: History) -> list[Layer]:
    """Return the terms that are seen, what is stored first."""
    shown = [term for term in terms("run") if term.side != "given"]
    most = max((float(np.nanmax(np.abs(history[term.name]))) for term in shown), default=0.0)
    return [
        Layer(SHORT[term.name], NAMED[term.colour], history[term.name])
        for term in shown
        if float(np.nanmax(np.abs(history[term.name]))) > LEAST * most
    ]


class Books:
    """The books of a run in a part of a figure, up to a time that moves on.

    Terms stand one upon the other, negative ones below zero: the top is the energy at the start and
    the work done since. What comes after the time is pale. Above stand the terms with their values,
    and what all of them leave unexplained.

    Parameters
    ----------
    axes
        Where they are drawn; the labels stand above.
    history
        The columns of ``history.csv``.
    unit
        The unit of the time axis.
    line
        Height of a line of text, in the height of the axes.
    """

    def __init__(self, axes: Axes, history: History, unit: TimeUnit, *, line: float) -> None:
        self._axes, self._times = axes, history["time"] / unit.seconds
        self._layers = layers(history)
        self._defect = history["defect"]
        values = [layer.values for layer in self._layers]
        low = np.minimum(np.array(values), 0.0).sum(axis=0) if values else np.zeros(1)
        high = np.maximum(np.array(values), 0.0).sum(axis=0) if values else np.ones(1)
        top, bottom = float(np.nanmax(high)) or 1.0, float(np.nanmin(low))
        self._symbol, self._size = prefixed("J", max(top, -bottom))
        first, last = float(self._times[0]), float(self._times[-1])
        axes.set_xlim(first, last if last > first else first + 1.0)
        axes.set_ylim(bottom / self._size, 1.04 * top / self._size)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.set_xlabel(f"time [{unit.symbol}]")
        axes.set_ylabel(f"energy [{self._symbol}]")
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        axes.tick_params(color=FAINT)

        self.past: list[PolyCollection] = []
        """The terms in full colour, over the whole time: what is seen of them is `seen`."""
        self._numbers: list[Text] = []
        self._stack()
        self._now = Line2D([], [], color=INK, linewidth=1.0, transform=axes.get_xaxis_transform())
        axes.add_line(self._now)
        self._label(line)
        self.artists: list[Artist] = [self._now, *self._numbers]
        """What changes from time to time, but for `past`."""

    def update(self, time: float) -> None:
        """Go on to a time, in the unit of the axis."""
        self._now.set_data([time, time], [0.0, 1.0])
        for text, layer in zip(self._numbers, self._layers, strict=False):
            value = float(np.interp(time, self._times, layer.values)) / self._size
            text.set_text(f"{value:.3f} {self._symbol}".replace("-", "−"))
        row = max(int(np.searchsorted(self._times, time, side="right")) - 1, 0)
        self._numbers[-1].set_text(_power(float(self._defect[row])) + " J")

    def seen(self, time: float) -> Bbox:
        """Return the part of the figure in which there is full colour up to a time [px]."""
        (left, _), (bottom, top) = self._axes.get_xlim(), self._axes.get_ylim()
        return Bbox(self._axes.transData.transform([[left, bottom], [max(time, left), top]]))

    def _stack(self) -> None:
        below, above = np.zeros(len(self._times)), np.zeros(len(self._times))
        for layer in self._layers:
            values = np.nan_to_num(layer.values) / self._size
            up, down = above + np.maximum(values, 0.0), below + np.minimum(values, 0.0)
            for start, end in ((above, up), (below, down)):
                if not (start != end).any():
                    continue
                for opacity in (0.22, 1.0):
                    area = self._axes.fill_between(
                        self._times, start, end, color=layer.colour, alpha=opacity, linewidth=0
                    )
                    if opacity == 1.0:
                        self.past.append(area)
            above, below = up, down

    def _label(self, line: float) -> None:
        """Put the terms above, each with its colour and value."""
        page = self._axes.transAxes
        rows = [*((layer.label, layer.colour) for layer in self._layers), ("unexplained", None)]
        top = 1.0 + line * (len(rows) + 0.6)
        for k, (label, colour) in enumerate(rows):
            middle = top - line * (k + 0.5)
            if colour is not None:
                patch = Rectangle(
                    (0.0, middle - 0.3 * line),
                    0.035,
                    0.6 * line,
                    facecolor=colour,
                    linewidth=0,
                    transform=page,
                    clip_on=False,
                )
                self._axes.add_patch(patch)
            ink = INK if colour is not None else FAINT
            self._axes.text(0.06, middle, label, color=ink, va="center", transform=page)
            number = self._axes.text(
                1.0, middle, "", color=ink, va="center", ha="right", transform=page
            )
            self._numbers.append(number)


def rows(history: History) -> int:
    """Return how many lines of text stand above the books."""
    return len(layers(history)) + 1


def _power(value: float) -> str:
    """Return a number with one digit and a power of ten, for it is no more than round-off."""
    if value == 0.0:
        return "0"
    mantissa, _, exponent = f"{abs(value):.0e}".partition("e")
    raised = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{'−' if value < 0 else ''}{mantissa}·10{raised}"
