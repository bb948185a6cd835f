"""``carom plot``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from carom.cli.failures import failures
from carom.plot import draw
from carom.result import Result


def plot(
    directory: Annotated[
        Path, typer.Argument(help="Results directory of `carom run`.", metavar="DIR")
    ],
) -> None:
    """Draw energies and tracked points of finished results again."""
    with failures(directory):
        for picture in draw(Result.open(directory)):
            typer.echo(picture)
