"""``carom picture``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from carom.cli import drawing
from carom.cli.case import Force, ResultsDirectory
from carom.cli.failures import failures
from carom.io.sparing import spare_file
from carom.plot.flow_figure import energy_flow
from carom.results.result import Result
from carom.view.picture import picture as draw


def picture(
    directory: ResultsDirectory,
    *,
    out: Annotated[Path, typer.Option(metavar="FILE", help="File to write: .pdf, .svg or .png.")],
    what: Annotated[
        Literal["bodies", "energy"],
        typer.Option(
            help="What is drawn: the bodies, or where the energy of the run went, as bands whose "
            "widths are joules (of the other options --width alone is of it)."
        ),
    ] = "bodies",
    time: Annotated[
        str | None,
        typer.Option(
            metavar="T,…",
            help="Instant [s], or several side by side, such as 0,0.1,0.2; default the last.",
        ),
    ] = None,
    field: drawing.FieldName = None,
    range_: drawing.Limits = None,
    smooth: drawing.Smooth = False,
    edges: drawing.Edges = True,
    reactions: drawing.Reactions = False,
    magnification: drawing.Magnification = 1.0,
    colours: drawing.Colours = None,
    width: Annotated[
        float | None,
        typer.Option(
            metavar="MM",
            help="Of the picture [mm]. Default: 85, a column of a paper; of several instants 170.",
        ),
    ] = None,
    bare: Annotated[
        bool,
        typer.Option("--bare", help="Bodies and obstacles alone: no times, colour bar and scales."),
    ] = False,
    camera: drawing.Camera = drawing.FROM_THE_FRONT,
    window: drawing.Window = None,
    force: Force = False,
) -> None:
    """Draw the bodies at one or several instants, for papers: as lines and areas, fonts included.

    Bodies in space are drawn by PyVista, the extra view of carom. No display is needed.
    """
    with failures(directory):
        spare_file(out, force=force)
        if what == "energy":
            energy_flow(Result.open(directory), out, width=width)
            typer.echo(out)
            return
        draw(
            directory,
            out,
            times=None if time is None else drawing.numbers("--time", time),
            field=field,
            limits=range_,
            smooth=smooth,
            edges=edges,
            reactions=reactions,
            magnification=magnification,
            colours=colours,
            width=width,
            bare=bare,
            camera=camera,
            window=window,
        )
        typer.echo(out)
