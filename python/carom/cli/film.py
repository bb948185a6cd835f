"""``carom film``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from carom.cli import drawing
from carom.cli.case import Force, ResultsDirectory
from carom.cli.failures import failures
from carom.io.sparing import spare_file
from carom.view.film import film as make


def film(
    directory: ResultsDirectory,
    *,
    out: Annotated[Path, typer.Option(metavar="FILE", help="File to write: .mp4, .gif or .webp.")],
    field: drawing.FieldName = None,
    range_: drawing.Limits = None,
    smooth: drawing.Smooth = False,
    edges: drawing.Edges = True,
    reactions: drawing.Reactions = False,
    energies: Annotated[
        bool,
        typer.Option(
            "--energies/--no-energies", help="Draw where the energy is beside the bodies."
        ),
    ] = True,
    magnification: drawing.Magnification = 1.0,
    colours: drawing.Colours = None,
    size: Annotated[
        str | None,
        typer.Option(
            metavar="WxH",
            help="Width and height [px]. Default: 1280x720, of .gif and .webp 800x450.",
        ),
    ] = None,
    fps: Annotated[
        float | None,
        typer.Option(help="Pictures per second. Default: 25, or what shows every frame once."),
    ] = None,
    duration: Annotated[float | None, typer.Option(help="Of the film [s].")] = None,
    speed: Annotated[
        float | None,
        typer.Option(
            help="Seconds of the run in a second of the film: 0.001 is slow motion 1 : 1000. "
            "Default: every frame is shown once."
        ),
    ] = None,
    between: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="START END", help="First and last time that is shown [s]."),
    ] = None,
    camera: drawing.Camera = drawing.FROM_THE_FRONT,
    window: drawing.Window = None,
    force: Force = False,
) -> None:
    """Make a film of the bodies as they move, with the energies beside them.

    MP4 takes the extra film of carom, which has ffmpeg, bodies in space the extra view, which has
    PyVista. No display is needed.
    """
    console = Console(stderr=True)
    with failures(directory):
        spare_file(out, force=force)
        with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
            task = bar.add_task(f"{out.name}", total=1.0)
            make(
                directory,
                out,
                field=field,
                limits=range_,
                smooth=smooth,
                edges=edges,
                reactions=reactions,
                energies=energies,
                magnification=magnification,
                colours=colours,
                size=drawing.pixels(size),
                rate=fps,
                duration=duration,
                speed=speed,
                between=between,
                camera=camera,
                window=window,
                progress=lambda done: bar.update(task, completed=done),
            )
        typer.echo(out)
