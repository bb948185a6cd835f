"""``carom view``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from carom.cli.case import Force, ResultsDirectory
from carom.cli.failures import failures
from carom.io import layout
from carom.io.frames import Frames
from carom.results.result import read_case
from carom.system.existing import spare_existing
from carom.view import View, animate, screenshot, show, shown


def view(
    directory: ResultsDirectory,
    *,
    field: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="What gives the colours: von-mises, hydrostatic-pressure, displacement, velocity, "
            "reaction, strain, energy_density; with --surface pressure, slip, friction_energy.",
        ),
    ] = None,
    time: Annotated[
        float | None, typer.Option(help="Time of the frame [s]; default the last.")
    ] = None,
    surface: Annotated[
        bool, typer.Option("--surface", help="Show what happened on the boundaries.")
    ] = False,
    magnification: Annotated[
        float, typer.Option(metavar="M", help="What displacements are multiplied by.")
    ] = 1.0,
    edges: Annotated[bool, typer.Option(help="Draw the edges of cells.")] = True,
    screenshot_file: Annotated[
        Path | None,
        typer.Option(
            "--screenshot", metavar="FILE", help="Draw into a picture; no display needed."
        ),
    ] = None,
    animation: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw all frames into a .gif or .mp4.")
    ] = None,
    force: Force = False,
) -> None:
    """Show results in space: bodies as they deform, coloured by a field."""
    files = [file for file in (screenshot_file, animation) if file is not None]
    with failures(directory):
        for file in files:
            spare_existing(file, force=force)
        frames = Frames(directory / (layout.SURFACE if surface else layout.FIELDS))
        scene = View(
            frames,
            shown(frames, field),
            read_case(directory),
            magnification=magnification,
            edges=edges,
        )
        if screenshot_file is not None:
            screenshot(scene, frames.nearest(time), screenshot_file)
        if animation is not None:
            animate(scene, animation)
        if not files:
            show(scene, frames.nearest(time))
        for file in files:
            typer.echo(file)
