"""``carom view``."""

from __future__ import annotations

from typing import Annotated

import typer

from carom.cli import drawing
from carom.cli.case import ResultsDirectory
from carom.cli.failures import failures
from carom.view.subject import subject
from carom.view.window import show


def view(
    directory: ResultsDirectory,
    *,
    field: drawing.FieldName = None,
    time: Annotated[
        float | None, typer.Option(help="Time of the first frame [s]; default the last.")
    ] = None,
    range_: drawing.Limits = None,
    smooth: drawing.Smooth = False,
    edges: drawing.Edges = True,
    reactions: drawing.Reactions = False,
    magnification: drawing.Magnification = 1.0,
) -> None:
    """Turn the bodies in a window, as they deform, coloured by a field.

    It takes PyVista, the extra view of carom, and a display; carom picture and carom film draw into
    files.
    """
    with failures(directory):
        shown = subject(
            directory,
            field=field,
            magnification=magnification,
            edges=edges,
            reactions=reactions,
            smooth=smooth,
        )
        show(shown, shown.frames.nearest(time), limits=range_)
