"""The command line ``carom``: one module per command, imported when the command is used."""

from __future__ import annotations

from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from carom import __version__

COMMANDS = {
    "tour": "Show in a minute what carom does: run an impact, say where its energy went, open its "
    "page.",
    "new": "Write a commented case file, or script, that runs as it is.",
    "run": "Run a case and write its results.",
    "check": "Validate a case and print what would run.",
    "doctor": "Examine a case: units, meshes, meetings, contact, time step and cost, with "
    "remedies.",
    "sweep": "Run a case with many values side by side; one table, one picture, a folder for each "
    "run.",
    "restitution": "Run a case with many values, and show what an impact did: curves of e, and of "
    "the energy.",
    "compare": "Show two runs side by side: what differs in the case, what came of it, and curves.",
    "modes": "Split the energy of bodies over the modes in which they vibrate, frame by frame.",
    "audit": "Check finished results by code that shares nothing with the solver.",
    "plot": "Draw energies and tracked points of finished results again.",
    "picture": "Draw the bodies at one or several instants, for papers: as lines and areas, fonts "
    "included.",
    "film": "Make a film of the bodies as they move, with the energies beside them.",
    "view": "Turn the bodies in a window, as they deform, coloured by a field.",
    "watch": "Follow a run from another terminal, until it ends.",
    "report": "Write a page with the animated bodies, energies and all numbers of a run; or "
    "of a study.",
    "schema": "Print the JSON Schema of the case file, by which editors complete and check it.",
    "friction": "Contact problems with friction on their own.",
}
"""What the list of commands says of each: the first line of its help."""


def command(name: str) -> Any:  # noqa: ANN401 (Click's, which Typer has as its own or not)
    """Import a command or group of commands, from the module of its name."""
    module = import_module(f"carom.cli.{name}")
    group = getattr(module, "app", None)
    if group is None:
        group = typer.Typer(add_completion=False)
        group.command(name)(getattr(module, name))
    made = typer.main.get_command(group)
    made.name = name
    return made


class Commands(TyperGroup):
    """Commands of which those that are not used are no more than a line of help."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:  # noqa: ANN401, D102 (as above)
        if args and args[0] in COMMANDS:
            self.commands[args[0]] = command(args[0])
        return super().resolve_command(ctx, args)


app = typer.Typer(
    cls=Commands,
    help="Frictional impact of deformable bodies, every joule accounted for.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


def _listed() -> None:
    """Stand in the list for a command that is not imported."""


for _name, _line in COMMANDS.items():
    app.command(_name, help=_line)(_listed)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"carom {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    *,
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command line."""
    try:
        app(prog_name="carom")
    except OSError as error:  # of what a command does all others are told by the command
        where = error.filename or "standard output"
        typer.echo(f"error: {where}: {error.strerror or error}", err=True)
        raise SystemExit(1) from error
