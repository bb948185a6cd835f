"""What all pictures share: size, fonts and axes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from carom.display.time_unit import TimeUnit, time_unit
from carom.results.result import Result

_STYLE: dict[Any, Any] = {
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 11,
    "axes.titlelocation": "left",
    "axes.xmargin": 0.0,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "lines.solid_capstyle": "round",
}

WIDTH = 7.0
"""Width of a picture [inch]."""

RESOLUTION = 200
"""Dots per inch."""


@contextmanager
def figure(*, height: float) -> Iterator[Figure]:
    """Give an empty figure, `height` inches high, to draw on in carom's style."""
    with mpl.rc_context(_STYLE):
        yield Figure(figsize=(WIDTH, height), layout="constrained")


def run_unit(result: Result) -> TimeUnit:
    """Return the unit in which the time axes of a run are: s, ms, µs and so on."""
    times = result.history["time"]
    return time_unit(float(times[-1]) if len(times) else 0.0)


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as a PNG picture and return its path."""
    figure.savefig(path, dpi=RESOLUTION)
    return path
