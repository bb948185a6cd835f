"""What the commands that read a contact problem have in common."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

ProblemFile = Annotated[
    Path,
    typer.Argument(help="Contact problem: FCLIB (HDF5) or text of Siconos.", metavar="FILE"),
]


@contextmanager
def warnings_named(file: Path) -> Iterator[None]:
    """Print each warning of the block as one line on stderr that names the file."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield
    for warning in caught:
        typer.echo(f"warning: {file}: {warning.message}", err=True)
