"""Pictures of bodies at one or several instants, for papers."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from carom.display.colours import INK
from carom.errors import InputError
from carom.plot.style import DOTS, INCH, PAPER, page_width, paper_file, several, write
from carom.results.result import Result
from carom.view.arrows import LONGEST
from carom.view.camera import AZIMUTH, ELEVATION, Sight
from carom.view.colouring import Colouring
from carom.view.flat import FlatScene, Scene
from carom.view.page import colour_bar, force_key, length_key, mappable
from carom.view.space import SpaceModel, SpaceScene, plotter, reached
from carom.view.subject import Subject, subject

SINGLE, WHOLE = 85.0, 170.0
"""Widths of one column of a paper, and of two [mm]."""

NARROWEST = 8.0
"""Room for an instant beside others, at least [mm]."""

THINNEST = 1000.0
"""Of a window: its longer side in its shorter one, at most."""

LARGEST = 1e12
"""Of a window: its sides, at most [m]."""

TALLEST = 90.0
"""Height of a scene, at most [mm]."""

MARGIN = 0.06
"""Around bodies of the plane, as a share of the larger side of the box around them."""

_PAD, _GAP, _HEAD, _FOOT = 0.04, 0.08, 0.2, 0.46
"""Around the page, between scenes, above and below them [inch]."""

_WIDEST_GAP = 0.35


@dataclass(frozen=True)
class Window:
    """What is seen of the plane: its corners [m]."""

    low: tuple[float, float]
    high: tuple[float, float]

    @property
    def aspect(self) -> float:
        """Its width in its height."""
        return (self.high[0] - self.low[0]) / (self.high[1] - self.low[1])


@dataclass(frozen=True)
class Look:
    """How bodies are looked at.

    Parameters
    ----------
    limits
        Values of the first and the last colour; None are those that are shown.
    colours
        A colour map of matplotlib; None is that of the field.
    camera
        Azimuth and elevation [degrees].
    window
        What is seen of the plane: left, bottom, right, top [m]; None is all of the bodies.
    bare
        Whether bodies and obstacles are all that is drawn.

    Raises
    ------
    InputError
        The limits, or the sides of the window, are not in order, or an angle is no number.
    """

    limits: tuple[float, float] | None
    colours: str | None
    camera: tuple[float, float]
    window: tuple[float, float, float, float] | None
    bare: bool = False

    def __post_init__(self) -> None:
        if self.limits is not None:
            _in_order("--range", *several("--range", self.limits, "LOW HIGH"))
        if self.window is not None:
            several("--window", self.window, "LEFT BOTTOM RIGHT TOP")
            _a_part_of_the_plane(self.window)
        if not np.isfinite(several("--camera", self.camera, "AZIMUTH ELEVATION")).all():
            azimuth, elevation = self.camera
            raise InputError(f"--camera {azimuth:g} {elevation:g}: give two angles in degrees")

    @property
    def sight(self) -> Sight:
        """The axes of a picture of bodies in space."""
        return Sight.towards(*self.camera)

    def values(self, colouring: Colouring | None, within: tuple[float, float]) -> ScalarMappable:
        """Return the way from values to colours; `within` are the least and the largest."""
        return mappable(colouring, self.limits or within, self.colours)


def picture(
    results: Result | Path | str,
    out: Path | str | None = None,
    *,
    times: float | Sequence[float] | None = None,
    field: str | None = None,
    limits: tuple[float, float] | None = None,
    smooth: bool = False,
    edges: bool = True,
    reactions: bool = False,
    magnification: float = 1.0,
    colours: str | None = None,
    width: float | None = None,
    bare: bool = False,
    camera: tuple[float, float] = (AZIMUTH, ELEVATION),
    window: tuple[float, float, float, float] | None = None,
) -> Figure:
    """Draw the bodies of a run in the colours of a field, at one or several instants.

    Bodies of the plane are lines and areas, those in space an image, for which PyVista is needed
    (``pip install 'carom[view]'``). Text is text, in fonts that are in the file.

    Parameters
    ----------
    results
        The results, or their directory; the run may still be going on.
    out
        The file to write: ``.pdf``, ``.svg`` or ``.png``. None writes none.
    times
        Instants [s], side by side if there are several: of each the nearest frame that the run has
        recorded. None is the last.
    field
        What gives the colours, by the names of ``result.fields``, ``result.surface``, and
        ``"von-mises"``, ``"hydrostatic-pressure"`` and ``"body"``, which tells bodies apart. None
        is the most telling that there is.
    limits
        Values of the first and the last colour. None are those of the instants that are shown.
    smooth
        Whether what is known per cell is drawn as if it were continuous: as the mean of the cells
        around each node. Without, every cell has the colour of its value.
    edges
        Whether the edges of cells are drawn.
    reactions
        Whether the contact reactions are drawn, as arrows.
    magnification
        What displacements are multiplied by.
    colours
        A colour map of matplotlib.
    width
        Of the picture [mm]. None is a column of a paper (85) for one instant, two (170) for more.
    bare
        Whether only bodies and obstacles are drawn, without times, colour bar and scales.
    camera
        Where bodies in space are seen from: around z from the x axis, and above [degrees].
    window
        What is seen of the plane: left, bottom, right, top [m]. None is all of the bodies.

    Returns
    -------
    Figure
        Matplotlib's, to go on with.

    Raises
    ------
    InputError
        There are no fields, no such field or map, the file has another ending, a number is none
        that can be, or PyVista is needed and not installed.
    """
    file = None if out is None else paper_file(out)
    look = Look(limits, colours, camera, window, bare)
    what = subject(
        results,
        field=field,
        magnification=magnification,
        edges=edges,
        reactions=reactions,
        smooth=smooth,
    )
    instants = list(times) if np.iterable(times) and not isinstance(times, str) else [times]
    frames = [what.frames.nearest(time) for time in instants]
    if not frames:
        raise InputError("times: name an instant, or none for the last")
    with mpl.rc_context(PAPER), ExitStack() as stack:
        made = _drawn(what, frames, look, width, stack)
        if file is not None:
            write(made, file, dots=DOTS)
    return made


def _drawn(
    what: Subject,
    frames: Sequence[int],
    look: Look,
    width: float | None,
    stack: ExitStack,
) -> Figure:
    colouring = what.colouring
    within = colouring.limits(frames) if colouring else (0.0, 1.0)
    values = look.values(colouring, within)
    sight = Sight.of_plane() if what.is_flat else look.sight
    seen = window_of(what, frames, look) if what.is_flat else None
    aspect = seen.aspect if seen else sight.aspect(reached(what, frames))

    page = _page(width, len(frames))
    across = (page - 2 * _PAD - _GAP * (len(frames) - 1)) / len(frames)
    up = min(across / aspect, TALLEST / INCH)
    across = up * aspect
    free = page - 2 * _PAD - across * len(frames)  # much of it where scenes would be too tall
    between = min(free / max(len(frames) - 1, 1), _WIDEST_GAP)
    foot = _FOOT if not look.bare and (colouring or seen or what.reactions) else _PAD
    head = _PAD if look.bare else _HEAD
    height = head + up + foot
    figure = Figure(figsize=(page, height))
    FigureCanvasAgg(figure)

    largest = what.largest_force(frames) if what.reactions else 0.0
    first = _PAD + (free - between * (len(frames) - 1)) / 2
    model = None
    for k, frame in enumerate(frames):
        left = first + k * (across + between)
        axes = _axes(figure, left, foot, across, up)
        if seen:
            frame_in(axes, seen)
        if not look.bare:
            scale = figure.dpi_scale_trans
            figure.text(left, foot + up + 0.05, what.caption(frame), transform=scale, color=INK)
        if seen:
            scene: Scene = FlatScene(axes, what, values, largest_force=largest)
        else:
            if model is None:
                size = (round(across * DOTS), round(up * DOTS))
                drawing = stack.enter_context(plotter(size, off_screen=True, of="carom picture"))
                model = SpaceModel(
                    drawing, what, values, frames=frames, largest_force=largest, sight=sight
                )
            scene = SpaceScene(axes, drawing, model)
        scene.update(frame)
    if look.bare:
        return figure
    if colouring:
        bar = _axes(figure, _PAD + 0.02, foot - 0.29, min(0.5 * page, 2.4), 0.07)
        colour_bar(bar, values, colouring, within=within)
    right = page - _PAD - 0.02
    if seen:
        metre = up / (seen.high[1] - seen.low[1])
        length_key(figure, right, foot - 0.2, metre=metre, most=0.16 * page)
        right -= 0.24 * page
    if largest > 0.0:
        diagonal = float(np.hypot(across, up))
        newton = LONGEST * diagonal / largest
        most = min(0.16 * page, largest * newton)
        force_key(figure, right, foot - 0.2, newton=newton, size=diagonal, most=most)
    return figure


def _page(width: float | None, count: int) -> float:
    """Return how wide a picture of so many instants is [inch]."""
    page = page_width(width, SINGLE if count == 1 else WHOLE)
    if page < count * NARROWEST / INCH:
        raise InputError(
            f"--time: {count} instants side by side take a --width of {count * NARROWEST:g} mm "
            "or more"
        )
    return page


def _axes(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Return axes at a place of the page [inch]."""
    page, up = figure.get_size_inches()
    return figure.add_axes((left / page, bottom / up, width / page, height / up))


def wide_enough(axes: Axes, seen: Window, aspect: float) -> None:
    """Let axes of an aspect, width in height, show a part of the plane and what is around it."""
    low, high = np.array(seen.low), np.array(seen.high)
    middle, (width, height) = (low + high) / 2, high - low
    half = np.array([max(width, height * aspect), max(height, width / aspect)]) / 2
    frame_in(axes, Window(tuple(middle - half), tuple(middle + half)))


def frame_in(axes: Axes, seen: Window) -> None:
    """Let axes show a part of the plane, without ticks."""
    axes.set(xlim=(seen.low[0], seen.high[0]), ylim=(seen.low[1], seen.high[1]))
    axes.set_axis_off()


def window_of(what: Subject, frames: Sequence[int], look: Look) -> Window:
    """Return what is seen of the plane: what was asked for, or the bodies with a margin."""
    if look.window is not None:
        left, bottom, right, top = look.window
        return Window((left, bottom), (right, top))
    low, high = what.box(frames)
    size = float((high - low).max()) or 1.0
    # A body that is next to no line still has a height on the page.
    grown = np.maximum(high - low + 2 * MARGIN * size, 0.2 * size)
    middle = (low + high) / 2
    return Window(tuple(middle - grown / 2), tuple(middle + grown / 2))


def _a_part_of_the_plane(window: tuple[float, float, float, float]) -> None:
    left, bottom, right, top = window
    given = f"--window {left:g} {bottom:g} {right:g} {top:g}"
    if not (np.isfinite(window).all() and left < right and bottom < top):
        raise InputError(
            f"{given}: give LEFT BOTTOM RIGHT TOP in metres, LEFT less than RIGHT and BOTTOM less "
            "than TOP"
        )
    wide, tall = right - left, top - bottom
    if max(wide, tall) > min(THINNEST * min(wide, tall), LARGEST):
        raise InputError(
            f"{given}: this part of the plane is {wide:g} m wide and {tall:g} m high; neither can "
            f"be more than {THINNEST:g} times the other, nor more than {LARGEST:g} m"
        )


def _in_order(option: str, first: float, second: float) -> None:
    if not (np.isfinite([first, second]).all() and first < second):
        raise InputError(
            f"{option} {first:g} {second:g}: give two numbers, the second larger than the first"
        )
