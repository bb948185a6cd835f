"""What stands around bodies on a page: colours and their values, a length, a force."""

from __future__ import annotations

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from carom.display.colours import FAINT, FORCE, INK, SEQUENTIAL
from carom.display.si_prefix import prefixed
from carom.errors import InputError
from carom.view.arrows import arrows
from carom.view.colouring import Colouring

NO_VALUE = "#C9CFD8"
"""The colour of what has no value."""

AT_END = 0.04
"""Of the colours: a value that is no farther from an end of the bar stands at it."""

NICE = (5.0, 2.0, 1.0)
"""What lengths and forces that are shown for comparison are, times a power of ten."""


def mappable(
    colouring: Colouring | None, limits: tuple[float, float], colours: str | None
) -> ScalarMappable:
    """Return the way from values to colours.

    Raises
    ------
    InputError
        There is no such map of colours.
    """
    import matplotlib as mpl  # noqa: PLC0415

    name = colours or (colouring.map if colouring else SEQUENTIAL)
    if name not in mpl.colormaps:
        raise InputError(
            f"--colours {name}: no colour map of matplotlib; try viridis, cividis, magma or RdBu_r"
        )
    made = ScalarMappable(Normalize(*limits), mpl.colormaps[name].with_extremes(bad=NO_VALUE))
    made.set_array(np.array(limits))
    return made


def colour_bar(
    axes: Axes, values: ScalarMappable, colouring: Colouring, *, within: tuple[float, float]
) -> None:
    """Draw the colours with their values, in a unit in which these are short.

    Parameters
    ----------
    axes
        Where the bar is drawn; its title is above, its values are below.
    values
        The way from values to colours.
    colouring
        What the values are of.
    within
        Least and largest value that there is: what is beyond the colours has an arrow.
    """
    low, high = values.get_clim()
    unit, size = prefixed(colouring.unit, max(abs(low), abs(high)))
    slack = 1e-6 * (high - low)
    beyond = (within[0] < low - slack, within[1] > high + slack)
    ends: dict[tuple[bool, bool], Literal["neither", "min", "max", "both"]] = {
        (False, False): "neither",
        (True, False): "min",
        (False, True): "max",
        (True, True): "both",
    }
    bar = Colorbar(
        axes,
        values,
        orientation="horizontal",
        extend=ends[beyond],
        extendfrac=0.04,
    )
    bar.outline.set_visible(False)
    marks = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(low / size, high / size)
    shown = [m for m in marks if low / size - 1e-9 <= m <= high / size + 1e-9]
    bar.set_ticks([m * size for m in shown], labels=[f"{m:.6g}".replace("-", "−") for m in shown])
    # A value at an end of the bar stays beside it: the page may end there.
    for mark, written in zip(shown, axes.get_xticklabels(), strict=True):
        if abs(mark * size - low) < AT_END * (high - low):
            written.set_horizontalalignment("left")
        elif abs(mark * size - high) < AT_END * (high - low):
            written.set_horizontalalignment("right")
    axes.tick_params(length=2.0, width=0.5, pad=1.5, color=FAINT, labelcolor=INK)
    title = f"{colouring.title} [{unit}]" if unit else colouring.title
    axes.set_title(title, loc="left", pad=2.5, color=INK, fontsize="medium")


def nice(most: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is no more than so much."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(next(power * digit for digit in NICE if power * digit <= most * (1 + 1e-9)))


def length_key(figure: Figure, right: float, bottom: float, *, metre: float, most: float) -> None:
    """Draw a length to compare with.

    Parameters
    ----------
    figure
        The page.
    right, bottom
        Its lower right corner [inch].
    metre
        How long a metre is on the page [inch].
    most
        How long it may be [inch].
    """
    length = nice(most / metre)
    unit, size = prefixed("m", length)
    left = right - length * metre
    scale = figure.dpi_scale_trans
    for x in ([left, right], [left, left], [right, right]):
        ends = [bottom, bottom] if x[0] != x[1] else [bottom - 0.025, bottom + 0.025]
        figure.add_artist(Line2D(x, ends, color=INK, linewidth=0.8, transform=scale))
    _say_below(figure, (left + right) / 2, bottom, f"{length / size:g} {unit}", INK)


def force_key(
    figure: Figure, right: float, bottom: float, *, newton: float, size: float, most: float
) -> None:
    """Draw a force to compare with.

    Parameters
    ----------
    figure
        The page.
    right, bottom
        Its lower right corner [inch].
    newton
        How long an arrow of 1 N is on the page [inch].
    size
        Diagonal of the picture that the arrows are in [inch].
    most
        How long it may be [inch].
    """
    force = nice(most / newton)
    unit, worth = prefixed("N", force)
    length = force * newton
    scale = figure.dpi_scale_trans
    arrow = arrows(np.array([[right - length, bottom]]), np.array([[length, 0.0]]), size=size)
    figure.add_artist(PolyCollection(list(arrow), facecolors=FORCE, linewidths=0, transform=scale))
    _say_below(figure, right - length / 2, bottom, f"{force / worth:g} {unit}", FORCE)


def _say_below(figure: Figure, x: float, y: float, text: str, colour: str) -> None:
    """Write what a key is worth under it."""
    scale = figure.dpi_scale_trans
    figure.text(x, y - 0.06, text, ha="center", va="top", color=colour, transform=scale)
