"""What all pictures share: size, fonts and axes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from numbers import Real
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from carom import __version__
from carom.display.time_unit import TimeUnit, time_unit
from carom.errors import InputError
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

PAPER: dict[Any, Any] = {
    **_STYLE,
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.titleweight": "normal",
    "pdf.fonttype": 42,
    "svg.fonttype": "path",
    "svg.hashsalt": "carom",
}
"""Of pictures for papers: small text in fonts that are in the file, and the same file each time."""

FILM: dict[Any, Any] = {**_STYLE, "font.size": 11, "axes.titlesize": 11}
"""Of films."""

WIDTH = 7.0
"""Width of a picture [inch]."""

INCH = 25.4
"""[mm]"""

NARROWEST_PAGE, WIDEST_PAGE = 15.0, 2000.0
"""Of pictures for papers [mm]."""

DOTS = 300
"""Dots per inch of images on paper, and of what is an image in vector files."""

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


def paper_file(out: Path | str) -> Path:
    """Return the file of a picture for a paper.

    Raises
    ------
    InputError
        It has no ending of one.
    """
    file = Path(out)
    if file.suffix.lower() not in (".pdf", ".svg", ".png"):
        raise InputError(f"--out {file}: must end in .pdf, .svg or .png")
    return file


def positive(option: str, value: float) -> float:
    """Return a number that must be greater than zero, or say so."""
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{option} {value:g}: must be a number greater than 0")
    return value


def several(option: str, values: Any, names: str) -> tuple[float, ...]:  # noqa: ANN401 (checked here)
    """Return numbers that belong together, or say which they are.

    Parameters
    ----------
    option
        What they were given as.
    values
        What was given.
    names
        One word for each number, such as "START END".

    Raises
    ------
    InputError
        There are more or fewer of them, or something that is no number.
    """
    given = tuple(values) if isinstance(values, Iterable) else (values,)
    if len(given) != len(names.split()) or not all(isinstance(one, Real) for one in given):
        raise InputError(f"{option} {values!r}: give numbers, {names}")
    return given


def page_width(width: float | None, usual: float) -> float:
    """Return how wide a picture for a paper is [inch].

    Parameters
    ----------
    width
        What was asked for [mm]; None is what is usual.
    usual
        See `width` [mm].

    Raises
    ------
    InputError
        No page has that width.
    """
    taken = usual if width is None else width
    if not (isinstance(taken, Real) and NARROWEST_PAGE <= taken <= WIDEST_PAGE):
        raise InputError(
            f"--width {taken}: must be {NARROWEST_PAGE:g} to {WIDEST_PAGE:g} millimetres"
        )
    return taken / INCH


def write(figure: Figure, path: Path, *, dots: int = RESOLUTION) -> Path:
    """Write a figure in the format of the file's ending and return its path.

    Parameters
    ----------
    figure
        The figure.
    path
        A file that ends in ``.pdf``, ``.svg`` or ``.png``.
    dots
        Dots per inch of images.
    """
    made_by = f"carom {__version__}"
    about: dict[str, dict[str, Any]] = {
        ".pdf": {"Creator": made_by, "Producer": None, "CreationDate": None},
        ".svg": {"Creator": made_by, "Date": None},
        ".png": {"Software": made_by},
    }
    figure.savefig(path, dpi=dots, metadata=about[path.suffix.lower()])
    return path


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as a PNG picture and return its path."""
    figure.savefig(path, dpi=RESOLUTION)
    return path
