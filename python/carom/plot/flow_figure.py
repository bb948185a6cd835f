"""The picture of where the energy of a run went, for papers."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path as Curve
from numpy.typing import NDArray

from carom.display.colours import FAINT, INK, NAMED
from carom.display.si_prefix import prefixed
from carom.plot.flow import Band, Share, bands, flow
from carom.plot.style import DOTS, PAPER, page_width, paper_file, write
from carom.results.result import Result

TRUNK = 0.36
"""Of the picture's width: the height of all energy together."""

WIDTH = 120.0
"""Of the picture unless it is said [mm]."""

_LINE, _GAP = 0.14, 0.05
"""Height of a line of text, and least distance of bands [inch]."""


def energy_flow(
    result: Result, out: Path | str | None = None, *, width: float | None = None
) -> Figure:
    """Draw where the energy of a run went, as bands whose widths are joules.

    At the left stands what it came from, at the right what it became: energy at the end, what
    friction (by pairs) and other terms of the ledger took, and what is unexplained.

    Parameters
    ----------
    result
        The results.
    out
        The file to write: ``.pdf``, ``.svg`` or ``.png``. None writes none.
    width
        Of the picture [mm]. None is 120.

    Returns
    -------
    Figure
        Matplotlib's, to go on with.

    Raises
    ------
    InputError
        The file has another ending, or the width is none that can be.
    """
    file = None if out is None else paper_file(out)
    drawn = _drawn(result, page_width(width, WIDTH))
    if file is not None:
        with mpl.rc_context(PAPER):
            write(drawn, file, dots=DOTS)
    return drawn


def _drawn(result: Result, across: float) -> Figure:
    what = flow(result.history, result.ledger)
    with mpl.rc_context(PAPER):
        if not what.total > 0.0:
            figure, axes = _blank(across, _LINE)
            axes.text(across / 2, _LINE / 2, "no energy", ha="center", va="center", color=FAINT)
            return figure
        drawn = bands(what, TRUNK * across, _slot)
        figure, axes = _blank(across, drawn.height + _LINE)
        unit, size = prefixed("J", what.total)
        left, middle, right = 0.34 * across, 0.42 * across, 0.64 * across
        for side, shown in ((-1, drawn.sources), (1, drawn.sinks)):
            edge, inner = (left, middle) if side < 0 else (right, middle + 0.06)
            align = "left" if side > 0 else "right"
            for band in shown:
                _draw(axes, band, inner, edge)
                joule = f"{band.share.joule / size:.3g} {unit} ({what.fraction(band.share)})"
                gap, centre = 0.06 * side, band.label + band.width / 2
                axes.text(edge + gap, centre, band.share.label, ha=align, va="bottom", color=INK)
                axes.text(edge + gap, centre + 0.01, joule, ha=align, va="top", color=FAINT)
        axes.add_patch(Rectangle((middle, drawn.top), 0.06, drawn.width, color=INK, linewidth=0))
    return figure


def _blank(across: float, up: float) -> tuple[Figure, Axes]:
    """Return a figure with one inch for one inch of the axes, from above."""
    figure = Figure(figsize=(across, up))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, across), ylim=(up - _LINE / 2, -_LINE / 2))
    axes.set_axis_off()
    return figure, axes


def _slot(_: Share, width: float) -> float:
    """Return what a band takes, with its label and its distance to others [inch]."""
    return max(width + _GAP, 2.0 * _LINE)


def _colour(share: Share) -> NDArray[np.float64]:
    pure = np.array(to_rgb(NAMED[share.colour]))
    return pure + share.white * (1.0 - pure)


def _draw(axes: Axes, band: Band, x: float, far: float) -> None:
    """Draw a band between two upright edges."""
    y, end, half = band.trunk, band.label, (x + far) / 2
    upper = [(x, y), (half, y), (half, end), (far, end)]
    lower = [(far, end), (half, end), (half, y), (x, y)]
    corners = np.array([*upper, *lower, (x, y)]) + np.repeat(
        [[0.0, 0.0], [0.0, band.width]], [4, 5], 0
    )
    corners[-1] = (x, y)
    codes = [Curve.MOVETO, *[Curve.CURVE4] * 3, Curve.LINETO, *[Curve.CURVE4] * 3, Curve.CLOSEPOLY]
    path = Curve(corners, codes)
    axes.add_patch(PathPatch(path, facecolor=_colour(band.share), linewidth=0, alpha=0.85))
