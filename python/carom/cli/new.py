"""``carom new``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from carom.cli import complete
from carom.cli.case import Force
from carom.cli.failures import failures
from carom.display.tables import add, two_columns
from carom.errors import InputError
from carom.new.mesh_case import MATERIALS, UNITS, mesh_case
from carom.new.template import MESH_FILE, SCRIPTS, TEMPLATES, file_name, place, template


def new(
    *,
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[TEMPLATE]",
            help="What to begin with; without it, the templates are listed.",
            autocompletion=complete.names(TEMPLATES),
        ),
    ] = None,
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FILE]", help="File to write; default TEMPLATE.toml, of a script TEMPLATE.py."
        ),
    ] = None,
    force: Force = False,
    mesh: Annotated[
        Path | None,
        typer.Option(metavar="MESH", help="Mesh of the part, for the template mesh-file."),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(
            help=f"What the mesh is in: {', '.join(UNITS)}; default m.",
            autocompletion=complete.names(UNITS),
        ),
    ] = None,
    material: Annotated[
        str | None,
        typer.Option(
            help=f"What the part is of: {', '.join(MATERIALS)}; default steel.",
            autocompletion=complete.names(MATERIALS),
        ),
    ] = None,
) -> None:
    """Write a commented case file, or script, that runs as it is."""
    if name is None:
        _list()
        return
    path = Path(file_name(name)) if file is None else file
    with failures(path):
        text = template(name)
        if name == MESH_FILE:
            if mesh is None:
                raise InputError(f"the template {MESH_FILE} needs a mesh; give --mesh FILE")
            text = mesh_case(mesh, path, unit=unit or "m", material=material or "steel")
        elif (mesh, unit, material) != (None, None, None):
            raise InputError(
                f"--mesh, --unit and --material are of the template {MESH_FILE}, not of {name}"
            )
        place(text, path, force=force)
    if name in SCRIPTS:
        typer.echo(f"{path} is written; run it: python {path}")
    else:
        typer.echo(f"{path} is written; look at it: carom doctor {path}; run it: carom run {path}")


def _list() -> None:
    table = two_columns("Templates")
    for name, what in TEMPLATES.items():
        add(table, name, what)
    console = Console()
    console.print(table)
    console.print("Write one: carom new TEMPLATE [FILE]", highlight=False)
