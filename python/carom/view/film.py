"""Films of a run: the bodies as they move, and beside them where the energy is."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from carom.case.scenario import Scenario
from carom.display.colours import FAINT, INK
from carom.errors import InputError
from carom.io import layout
from carom.io.history import read_history
from carom.plot.books import Books, rows
from carom.plot.style import FILM, several
from carom.results.result import Result
from carom.view.camera import AZIMUTH, ELEVATION
from carom.view.encoding import encoder, ending
from carom.view.flat import FlatScene, Scene
from carom.view.pace import Pace, pace
from carom.view.page import colour_bar
from carom.view.picture import Look, wide_enough, window_of
from carom.view.space import SpaceModel, SpaceScene, plotter
from carom.view.subject import Subject, subject

SIZES = {".mp4": (1280, 720), ".gif": (800, 450), ".webp": (800, 450)}
"""Width and height of a film unless they are said [px]."""

LEAST, MOST = 160, 4096
"""Pixels of a side."""

_CUTS = 1
"""How often edges of triangles are halved where colours run on: a film is looked at in passing."""


def film(
    results: Result | Path | str,
    out: Path | str,
    *,
    field: str | None = None,
    limits: tuple[float, float] | None = None,
    smooth: bool = False,
    edges: bool = True,
    reactions: bool = False,
    energies: bool = True,
    magnification: float = 1.0,
    colours: str | None = None,
    size: tuple[int, int] | None = None,
    rate: float | None = None,
    duration: float | None = None,
    speed: float | None = None,
    between: tuple[float, float] | None = None,
    camera: tuple[float, float] = (AZIMUTH, ELEVATION),
    window: tuple[float, float, float, float] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Make a film of a run, without a display.

    Colours have the same values from beginning to end. Every picture is a frame that the run has
    recorded; nothing is made up between frames. ``output.fields_every`` says how many there are.

    Parameters
    ----------
    results
        The results, or their directory; the run may still be going on.
    out
        The file to write: ``.mp4`` (``pip install 'carom[film]'``), ``.gif`` or ``.webp``.
    field, limits, smooth, edges, reactions, magnification, colours, camera, window
        As of `picture`; the values of the colours are those of the whole film.
    energies
        Whether the terms of the ledger are drawn beside the bodies, as far as time has come.
    size
        Width and height [px], even numbers. None is 1280 × 720, of GIF and WebP 800 × 450. Where
        the height is more than the width, the energies are below.
    rate
        Pictures per second; None is 25, or what shows every frame once.
    duration
        Of the film [s].
    speed
        Seconds of the run in a second of the film; 0.001 is slow motion by a thousand. Without
        duration and speed every frame is shown once.
    between
        First and last time that is shown [s].
    progress
        Is told the share that is done after every picture.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        There are no fields, no such field or map, the file has another ending, a number is none
        that can be, or a package is needed and not installed.
    """
    file = Path(out)
    pixels = _checked(size or SIZES[ending(file)])
    look = Look(limits, colours, camera, window)
    what = subject(
        results,
        field=field,
        magnification=magnification,
        edges=edges,
        reactions=reactions,
        smooth=smooth,
    )
    run = pace(what.frames.times, rate=rate, duration=duration, speed=speed, between=between)
    directory = results.path if isinstance(results, Result) else Path(results)
    history = read_history(directory / layout.HISTORY) if energies else None
    with mpl.rc_context(FILM), ExitStack() as stack:
        take = stack.enter_context(encoder(file, pixels, run.rate))
        reel = _Reel(
            what,
            run,
            history=history,
            pixels=pixels,
            look=look,
            stack=stack,
        )
        for index in range(len(run.frames)):
            take(reel.picture(index))
            if progress is not None:
                progress((index + 1) / len(run.frames))
    return file


class _Reel:
    """A figure of which only what moves is drawn anew for each picture."""

    def __init__(
        self,
        what: Subject,
        run: Pace,
        *,
        history: dict[str, NDArray[np.float64]] | None,
        pixels: tuple[int, int],
        look: Look,
        stack: ExitStack,
    ) -> None:
        self._what, self._run = what, run
        self._tells_pace = any(_is_dynamic(what.scenario))
        # Letters shrink less than pictures do.
        dots = 100.0 * (min(pixels) / 720.0) ** 0.75
        self._figure = Figure(figsize=(pixels[0] / dots, pixels[1] / dots), dpi=dots)
        self._canvas = FigureCanvasAgg(self._figure)
        width, height = self._figure.get_size_inches()
        upright = height > width
        panel = 0.0 if history is None else (0.42 * height if upright else min(0.34 * width, 4.6))
        across = width if upright else width - panel
        foot = 0.95 if what.colouring else 0.2
        bottom = foot + (panel if upright else 0.0)
        axes = self._axes(0.25, bottom, across - 0.5, height - bottom - 0.62)

        frames = sorted(set(run.frames.tolist()))
        colouring = what.colouring
        within = colouring.limits(frames) if colouring else (0.0, 1.0)
        values = look.values(colouring, within)
        largest = what.largest_force(frames) if what.reactions else 0.0
        if what.is_flat:
            seen = window_of(what, frames, look)
            axes_box = axes.get_window_extent()
            wide_enough(axes, seen, axes_box.width / axes_box.height)
            self._scene: Scene = FlatScene(axes, what, values, largest_force=largest, cuts=_CUTS)
        else:
            box = axes.get_window_extent()
            drawing = stack.enter_context(
                plotter((round(box.width), round(box.height)), off_screen=True, of="carom film")
            )
            model = SpaceModel(
                drawing,
                what,
                values,
                frames=frames,
                largest_force=largest,
                sight=look.sight,
            )
            self._scene = SpaceScene(axes, drawing, model)
        if colouring:
            bar = self._axes(0.3, bottom - 0.46, min(0.55 * across, 4.0), 0.11)
            colour_bar(bar, values, colouring, within=within)

        top = height - 0.2
        scale = self._figure.dpi_scale_trans
        self._time = self._figure.text(
            0.28, top, "", va="top", color=INK, fontsize="large", transform=scale
        )
        self._pace = self._figure.text(
            across - 0.28, top, "", va="top", ha="right", color=FAINT, transform=scale
        )
        self._books = self._with_books(history, panel, across, upright)
        moving = [*self._scene.artists, self._time, self._pace]
        moving += self._books.artists if self._books else []
        for artist in moving:
            artist.set_animated(True)
        self._moving = sorted(moving, key=lambda artist: artist.get_zorder())
        self._scene.update(frames[0])
        self._past = self._drawn()
        for area in self._books.past if self._books else []:
            area.set_visible(False)
        self._ground = self._drawn()

    def _drawn(self) -> NDArray[np.uint8]:
        """Draw what does not move, and return the pixels, shape [height, width, 4]."""
        self._canvas.draw()  # type: ignore[no-untyped-call]
        return np.array(self._pixels())

    def _pixels(self) -> NDArray[np.uint8]:
        """Return the canvas itself, shape [height, width, 4]: what is written there is drawn."""
        return np.asarray(
            self._canvas.buffer_rgba(),  # type: ignore[no-untyped-call]
            dtype=np.uint8,
        )

    def picture(self, index: int) -> NDArray[np.uint8]:
        """Return a picture of the film, shape [height, width, 3]."""
        frame = int(self._run.frames[index])
        pixels = self._pixels()
        pixels[:] = self._ground
        self._scene.update(frame)
        self._time.set_text(self._what.caption(frame))
        self._pace.set_text(self._run.text(index) if self._tells_pace else "")
        if self._books:
            time = float(self._what.frames.times[frame])
            time /= self._what.unit.seconds
            self._books.update(time)
            box, height = self._books.seen(time), len(pixels)
            rows_ = slice(round(height - box.y1), round(height - box.y0))
            columns = slice(round(box.x0), round(box.x1))
            pixels[rows_, columns] = self._past[rows_, columns]
        for artist in self._moving:
            self._figure.draw_artist(artist)
        return np.ascontiguousarray(pixels[..., :3])

    def _with_books(
        self,
        history: dict[str, NDArray[np.float64]] | None,
        panel: float,
        across: float,
        upright: bool,
    ) -> Books | None:
        if history is None or not len(history["time"]):
            return None
        line, (width, height) = 0.235, self._figure.get_size_inches()
        head = line * (rows(history) + 0.6)
        left = 0.85 if upright else across + 0.62
        room = (panel if upright else height - 0.4) - 0.62 - head
        tall = room if upright else min(room, 0.95 * panel)
        wide = width - left - 0.32
        bottom = 0.62 if upright else max(0.62, (height - tall - head - 0.4) / 2)
        axes = self._axes(left, bottom, wide, tall)
        return Books(axes, history, self._what.unit, line=line / tall)

    def _axes(self, left: float, bottom: float, width: float, height: float) -> Axes:
        """Return axes at a place of the picture [inch]."""
        page, up = self._figure.get_size_inches()
        return self._figure.add_axes((left / page, bottom / up, width / page, height / up))


def _is_dynamic(scenario: Scenario) -> list[bool]:
    """Return of every analysis whether its time is that of a clock."""
    kinds = [scenario.analysis.kind] if scenario.analysis else []
    kinds += [stage.analysis.kind for stage in scenario.stages if stage.analysis]
    return [kind == "dynamic" for kind in kinds]


def _checked(size: tuple[int, int]) -> tuple[int, int]:
    several("--size", size, "WIDTH HEIGHT")
    if any(side % 2 or not LEAST <= side <= MOST for side in size):
        raise InputError(
            f"--size {size[0]}x{size[1]}: width and height are even numbers of pixels, "
            f"{LEAST} to {MOST}"
        )
    return size
