"""``carom modes``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from carom.cli import complete
from carom.cli.failures import failures
from carom.display.sheet import Sheet, print_whole
from carom.io.atomic import write_whole
from carom.io.sparing import spare_file
from carom.modes.energies import Array, ModalEnergies
from carom.modes.figure import modes_figure
from carom.modes.split import modal_energies
from carom.modes.table import modes_csv
from carom.plot.style import paper_file, write
from carom.results.result import Result


def modes(
    directory: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            help="Results directory of `carom run`.",
            autocompletion=complete.results,
        ),
    ],
    *,
    count: Annotated[int, typer.Option(min=1, help="Modes of each body.")] = 20,
    body: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Body; may be given several times. Default: all."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw the spectrogram: .png, .pdf or .svg."),
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write every energy at every frame as a table."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that are there.")] = False,
) -> None:
    """Split the energy of bodies over the modes in which they vibrate, frame by frame.

    Frames are those of the fields (output.fields_every): take as many as show the vibration.
    """
    console = Console()
    with failures(directory):
        for file in (out, csv):
            if file is not None:
                spare_file(file, force=force)
        picture = None if out is None else paper_file(out)
        found = list(modal_energies(Result.open(directory), count=count, bodies=body).values())
        if picture is not None:
            write(modes_figure(found), picture)
        if csv is not None:
            write_whole(csv, modes_csv(found).encode())
    for one in found:
        print_whole(console, _sheet(one), title=f"{one.body}, at the last frame")
    for file in (out, csv):
        if file is not None:
            console.print(file, highlight=False, soft_wrap=True)


def _sheet(one: ModalEnergies) -> Sheet:
    """Return the energies at the last frame, and the largest of each over time."""
    rows = [("rigid", "", *_pair(one.rigid))]
    rows += [
        (str(k), f"{frequency:.6g}", *_pair(one.energies[:, k - 1]))
        for k, frequency in enumerate(one.frequencies, start=1)
    ]
    rows += [("rest", "", *_pair(one.rest)), ("total", "", *_pair(one.total))]
    return Sheet(("mode", "frequency [Hz]", "energy [J]", "largest [J]"), rows)


def _pair(values: Array) -> tuple[str, str]:
    return f"{values[-1]:.6g}", f"{values[abs(values).argmax()]:.6g}"
