"""What notebooks show of a result, as HTML."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.display.colours import BLUE, GREEN, ORANGE
from carom.display.markup import Html, element, format_number, join
from carom.display.tables import html_table
from carom.display.time_unit import time_unit
from carom.io import layout
from carom.results.outcome import contact_events, outcome, summary_title

if TYPE_CHECKING:
    from carom.results.result import Result

CURVES = (
    ("kinetic", BLUE),
    ("strain", ORANGE),
    ("total", "currentColor"),
    ("friction", GREEN),
)
"""Columns of the history and their colours; black is that of the notebook's text."""

WIDTH, HEIGHT = 480, 160
"""Size of the picture without its labels [px]."""

BUCKETS = 240
"""Parts of the time of which the least and the largest value are drawn."""


def result_html(result: Result) -> Html:
    """Return what came out of a run, its energies over time, and links to its files."""
    files = [name for name in (layout.REPORT, layout.FIELDS) if (result.path / name).exists()]
    links = [element("a", name, href=_address(result.path / name)) for name in files]
    separated = [part for link in links for part in (" · ", link)][1:]
    return element(
        "div",
        element("strong", summary_title(result.summary)),
        html_table(outcome(result.summary)),
        _scene(result.path),
        _energies(result.history),
        html_table(contact_events(result.summary)),
        element("div", str(result.path), ": " if links else None, separated),
    )


def _scene(directory: Path) -> Html | None:
    """Return the bodies in motion, where there are fields.

    The report, a higher room, has the scene and is not known here: it comes by its name.
    """
    drawn: Html | None = import_module("carom.report.notebook").notebook_scene(directory)
    return drawn


def _address(path: Path) -> str:
    """Return a link to a file: relative to the notebook where the path is."""
    return path.as_uri() if path.is_absolute() else path.as_posix()


def _energies(history: dict[str, NDArray[np.float64]]) -> Html | None:
    """Return a picture of the energies over time, in SVG; None of a run without time."""
    time = history["time"]
    shown = [(name, colour) for name, colour in CURVES if history[name].any()]
    top = max((np.nanmax(history[name]) for name, _ in shown), default=0.0)
    if len(time) < 2 or not top > 0.0:
        return None
    bottom = min(0.0, *(np.nanmin(history[name]) for name, _ in shown))
    unit = time_unit(float(time[-1]))
    across = (time - time[0]) / (time[-1] - time[0])
    curves = [
        element(
            "polyline",
            points=_points(across, (history[name] - bottom) / (top - bottom)),
            fill="none",
            stroke=colour,
            stroke_width="1.5",
        )
        for name, colour in shown
    ]
    names = [
        element("tspan", f"{name} ", fill=colour, dx="8" if index else None)
        for index, (name, colour) in enumerate(shown)
    ]
    return element(
        "svg",
        element(
            "rect",
            width=str(WIDTH),
            height=str(HEIGHT),
            fill="none",
            stroke="currentColor",
            stroke_opacity="0.3",
        ),
        curves,
        _label(0, -6, [*names, element("tspan", f"up to {format_number(top, 4)} J", dx="8")]),
        _label(0, HEIGHT + 16, f"t = {unit.text(float(time[0]), 4)}"),
        _label(WIDTH, HEIGHT + 16, unit.text(float(time[-1]), 4), anchor="end"),
        viewBox=f"-2 -22 {WIDTH + 4} {HEIGHT + 44}",
        width=str(WIDTH + 4),
        role="img",
        aria_label="energies over time",
        style="max-width: 100%; display: block",
    )


def _label(x: int, y: int, text: str | Iterable[str], *, anchor: str = "start") -> Html:
    return element(
        "text",
        join(text),
        x=str(x),
        y=str(y),
        text_anchor=anchor,
        fill="currentColor",
        font_size="12",
    )


def _points(across: NDArray[np.float64], up: NDArray[np.float64]) -> str:
    """Return a curve as corners of a polyline, thinned so that no peak is lost."""
    parts = np.array_split(np.flatnonzero(np.isfinite(up)), min(BUCKETS, len(up)))
    kept = [
        number
        for part in parts
        if len(part)
        for number in sorted({part[up[part].argmin()], part[up[part].argmax()]})
    ]
    return " ".join(f"{WIDTH * across[n]:.1f},{HEIGHT * (1.0 - up[n]):.1f}" for n in kept)
