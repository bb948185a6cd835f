"""The scene: deformed bodies in colours, rigid obstacles, and a camera."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.case.scenario import Scenario
from carom.display.time_unit import time_unit
from carom.errors import InputError
from carom.io.frames import Frames
from carom.view.camera import aim
from carom.view.fields import Shown
from carom.view.obstacles import draw_obstacles

WINDOW = (1280, 960)
"""Pixels of a picture."""

_BRIGHT = {"ambient": 0.45, "diffuse": 0.65, "specular": 0.0}
"""Of bodies: what faces the camera has the colour of the bar, and no face is dark."""

FRAMES_PER_SECOND = 25
"""Of an animation."""


@dataclass(frozen=True)
class View:
    """What to draw.

    Parameters
    ----------
    frames
        The file with the fields.
    shown
        The field that gives the colours.
    scenario
        The case, for its obstacles.
    magnification
        What displacements are multiplied by; 0 draws the reference configuration.
    edges
        Whether the edges of cells are drawn.
    """

    frames: Frames
    shown: Shown
    scenario: Scenario
    magnification: float = 1.0
    edges: bool = True

    def positions(self, frame: int) -> NDArray[np.float64]:
        """Return where the points are drawn [m], shape [point_count, 3]."""
        return np.asarray(
            self.frames.points + self.magnification * self.frames.field("displacement", frame)
        )


def screenshot(view: View, frame: int, file: Path) -> None:
    """Draw a frame into a file, without a display.

    Raises
    ------
    InputError
        PyVista is not installed, or the file has no ending of a picture.
    """
    if file.suffix.lower() not in (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp"):
        raise InputError(f"--screenshot {file}: must end in .png, .jpg, .tif or .bmp")
    with _plotter(view, off_screen=True) as plotter:
        _draw(plotter, view, frame)
        plotter.screenshot(str(file))


def animate(view: View, file: Path) -> None:
    """Draw all frames into a film, without a display.

    Raises
    ------
    InputError
        PyVista or imageio is not installed, or the file has no ending of a film.
    """
    endings = {".gif": "open_gif", ".mp4": "open_movie"}
    if file.suffix.lower() not in endings:
        raise InputError(f"--animation {file}: must end in .gif or .mp4")
    with _plotter(view, off_screen=True) as plotter:
        try:
            if file.suffix.lower() == ".gif":
                plotter.open_gif(str(file), fps=FRAMES_PER_SECOND)
            else:
                plotter.open_movie(str(file), framerate=FRAMES_PER_SECOND)
        except (ImportError, ValueError) as error:
            raise InputError(
                f'--animation {file}: {" ".join(str(error).split())}; pip install "carom[view]"'
            ) from None
        grid = _draw(plotter, view, 0, limits=_limits(view))
        for frame in range(len(view.frames.times)):
            _update(grid, view, frame)
            plotter.add_text(_caption(view, frame), name="time", font_size=10)
            plotter.write_frame()


def show(view: View, frame: int) -> None:
    """Open a window in which the view can be turned, with a slider over the frames.

    Raises
    ------
    InputError
        PyVista is not installed, or there is no display.
    """
    if _is_headless():
        raise InputError("there is no display; give --screenshot FILE")
    with _plotter(view, off_screen=False) as plotter:
        grid = _draw(plotter, view, frame, limits=_limits(view))

        def turn_to(value: float) -> None:
            chosen = round(value)
            _update(grid, view, chosen)
            plotter.add_text(_caption(view, chosen), name="time", font_size=10)

        if len(view.frames.times) > 1:
            last = len(view.frames.times) - 1
            plotter.add_slider_widget(turn_to, [0, last], value=frame, title="frame", fmt="%.0f")
        plotter.show()


def _is_headless() -> bool:
    return sys.platform.startswith("linux") and not any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )


@contextmanager
def _plotter(view: View, *, off_screen: bool) -> Iterator[Any]:
    try:
        import pyvista  # noqa: PLC0415 (an extra, and slow to load)
        from vtkmodules.vtkCommonCore import vtkLogger  # noqa: PLC0415
    except ImportError as error:
        raise InputError(f'carom view needs PyVista ({error}): pip install "carom[view]"') from None
    # Without a display VTK draws by EGL or OSMesa, and says so before.
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    if off_screen:
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    plotter: Any = pyvista.Plotter(off_screen=off_screen, window_size=list(WINDOW))
    try:
        plotter.set_background("white")
        yield plotter
    finally:
        plotter.close()
        vtkLogger.SetStderrVerbosity(verbosity)


def _draw(
    plotter: Any,  # noqa: ANN401 (PyVista is optional)
    view: View,
    frame: int,
    *,
    limits: tuple[float, float] | None = None,
) -> Any:  # noqa: ANN401
    """Draw a frame and return its grid."""
    import pyvista  # noqa: PLC0415

    frames, flat = view.frames, view.scenario.dimension == 2
    cells = np.insert(frames.connectivity, frames.offsets[:-1], np.diff(frames.offsets))
    grid = pyvista.UnstructuredGrid(cells, frames.types, view.positions(frame))
    grid[view.shown.title] = view.shown.values(frames, frame)
    plotter.add_mesh(
        grid,
        scalars=view.shown.title,
        preference="point" if view.shown.on_points else "cell",
        clim=limits,
        cmap="viridis",
        show_edges=view.edges,
        edge_opacity=0.3,
        line_width=3 if _is_line(frames) else 1,
        lighting=not flat,  # shades would tell other values than the colour bar
        **_BRIGHT,
        scalar_bar_args={
            "title": f"{view.shown.title}\n",  # without the empty line it runs into the labels
            "color": "black",
            "n_labels": 4,
            "fmt": "%.3g",
            "position_x": 0.2,  # the last label begins where the bar ends
            "position_y": 0.04,
            "width": 0.6,
        },
    )
    low, high = np.reshape(grid.bounds, (3, 2)).T
    draw_obstacles(plotter, view.scenario, low, high, float(frames.times[frame]))
    plotter.add_text(_caption(view, frame), name="time", font_size=10)
    for label in plotter.actors.values():
        if hasattr(label, "prop") and type(label).__name__ == "CornerAnnotation":
            label.prop.color = "black"
    plotter.add_axes(color="black")
    aim(plotter, view.positions(frame) if limits is None else _reached(view), flat=flat)
    return grid


def _update(grid: Any, view: View, frame: int) -> None:  # noqa: ANN401
    grid.points = view.positions(frame)
    grid[view.shown.title] = view.shown.values(view.frames, frame)


def _reached(view: View) -> NDArray[np.float64]:
    """Return corners of the boxes around the bodies in all frames [m]: what a film must show."""
    ends = []
    for frame in range(len(view.frames.times)):
        points = view.positions(frame)
        ends.append((points.min(axis=0), points.max(axis=0)))
    return np.array(
        [np.where(side, high, low) for low, high in ends for side in np.ndindex(2, 2, 2)]
    )


def _limits(view: View) -> tuple[float, float]:
    """Return the smallest and the largest value over all frames, which keep their colours."""
    values = [view.shown.values(view.frames, k) for k in range(len(view.frames.times))]
    return min(float(v.min()) for v in values), max(float(v.max()) for v in values)


def _is_line(frames: Frames) -> bool:
    return bool(np.isin(frames.types, (3, 21)).all())


def _caption(view: View, frame: int) -> str:
    times = view.frames.times
    return f"t = {time_unit(float(times[-1])).text(float(times[frame]))}"
