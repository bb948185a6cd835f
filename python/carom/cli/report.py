"""``carom report``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from carom.cli.case import Force, ResultsDirectory
from carom.cli.failures import failures
from carom.report import write_report
from carom.sweep.page import is_study, write_study_page


def report(
    directory: ResultsDirectory,
    *,
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="File to write; default DIR/report.html.")
    ] = None,
    force: Force = False,
) -> None:
    """Write a page with the animated bodies, energies and all numbers of a run; or of a study."""
    with failures(directory):
        write = write_study_page if is_study(directory) else write_report
        typer.echo(write(directory, out=out, force=force))
