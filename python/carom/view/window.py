"""A window in which the bodies of a run can be turned."""

from __future__ import annotations

import os
import sys

from carom.errors import InputError
from carom.view.camera import Sight
from carom.view.page import mappable
from carom.view.space import SpaceModel, plotter
from carom.view.subject import Subject

SIZE = (1280, 960)
"""Of the window [px]."""


def show(subject: Subject, frame: int, *, limits: tuple[float, float] | None = None) -> None:
    """Open a window with the bodies and, if there are several frames, a slider over them.

    Parameters
    ----------
    subject
        What is drawn.
    frame
        The first frame that is shown.
    limits
        Values of the first and the last colour; None are those of the run.

    Raises
    ------
    InputError
        PyVista is not installed, or there is no display.
    """
    if _is_headless():
        raise InputError(
            "there is no display for a window; carom picture and carom film draw into files"
        )
    frames, colouring = range(len(subject.frames.times)), subject.colouring
    within = limits or (colouring.limits(frames) if colouring else (0.0, 1.0))
    colours = mappable(colouring, within, None)
    sight = Sight.of_plane() if subject.is_flat else Sight.towards()
    with plotter(SIZE, off_screen=False, of="carom view") as drawing:
        model = SpaceModel(
            drawing,
            subject,
            colours,
            frames=frames,
            largest_force=subject.largest_force(frames) if subject.reactions else 0.0,
            sight=sight,
        )
        if colouring:
            import pyvista  # noqa: PLC0415 (an extra)

            table = pyvista.LookupTable(colours.get_cmap(), scalar_range=within)
            drawing.mapper.lookup_table = table
            title = f"{colouring.title} [{colouring.unit}]" if colouring.unit else colouring.title
            drawing.add_scalar_bar(title=f"{title}\n", color="black", fmt="%.3g", n_labels=4)

        def turn_to(value: float) -> None:
            model.update(round(value))
            caption = subject.caption(round(value))
            drawing.add_text(caption, name="time", font_size=10, color="black")

        turn_to(frame)
        drawing.add_axes(color="black")
        if len(frames) > 1:
            drawing.add_slider_widget(
                turn_to, [0, len(frames) - 1], value=frame, title="frame", fmt="%.0f", color="black"
            )
        drawing.show()


def _is_headless() -> bool:
    return sys.platform.startswith("linux") and not any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )
