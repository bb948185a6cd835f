"""``carom plot``."""

from __future__ import annotations

import typer

from carom.cli.case import ResultsDirectory
from carom.cli.failures import failures
from carom.plot import draw
from carom.results.result import Result


def plot(
    directory: ResultsDirectory,
) -> None:
    """Draw energies and tracked points of finished results again."""
    with failures(directory):
        for picture in draw(Result.open(directory)):
            typer.echo(picture)
