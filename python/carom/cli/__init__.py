"""The command line ``carom``: one module per command."""

from __future__ import annotations

from typing import Annotated

import typer

from carom import __version__
from carom.cli.audit import audit
from carom.cli.check import check
from carom.cli.doctor import doctor
from carom.cli.friction import app as friction
from carom.cli.new import new
from carom.cli.plot import plot
from carom.cli.report import report
from carom.cli.run import run
from carom.cli.schema import schema
from carom.cli.sweep import sweep
from carom.cli.view import view
from carom.cli.watch import watch

app = typer.Typer(
    help="Frictional impact of deformable bodies, every joule accounted for.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
app.command()(new)
app.command()(run)
app.command()(check)
app.command()(doctor)
app.command()(sweep)
app.command()(audit)
app.command()(plot)
app.command()(view)
app.command()(watch)
app.command()(report)
app.command()(schema)
app.add_typer(friction, name="friction")


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
    app(prog_name="carom")
