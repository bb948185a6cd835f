"""``carom schema``."""

from __future__ import annotations

import typer

from carom.case.schema import case_file_schema
from carom.cli.plain import json_text


def schema() -> None:
    """Print the JSON Schema of the case file, by which editors complete and check it."""
    typer.echo(json_text(case_file_schema()))
