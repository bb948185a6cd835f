"""``carom friction convert``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import carom
from carom.cli.case import Force
from carom.cli.failures import failures
from carom.cli.friction.problem_file import ProblemFile, warnings_named
from carom.io.sparing import spare_file


def convert(
    *,
    file: ProblemFile,
    out: Annotated[
        Path,
        typer.Argument(
            help="File to write: FCLIB (.hdf5, .h5) or text of Siconos (.dat, .txt).", metavar="OUT"
        ),
    ],
    condense: Annotated[
        bool, typer.Option("--condense", help="Write a global problem in local form: W, q, μ.")
    ] = False,
    force: Force = False,
) -> None:
    """Write a contact problem in another format."""
    with failures(file):
        carom.friction.check_suffix(out)
        spare_file(out, force=force)
        with warnings_named(file):
            record = carom.friction.read_record(file)
        if condense:
            record = record.condensed()
        carom.friction.write_record(record, out)
