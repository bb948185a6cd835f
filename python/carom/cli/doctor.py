"""``carom doctor``."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from carom.cli.case import CaseFile, Overrides, load
from carom.cli.failures import BAD_INPUT, failures
from carom.cli.plain import json_text
from carom.doctor import Diagnosis, examine

STYLES = {"ok": "green", "advice": "cyan", "warning": "yellow", "error": "bold red"}


def doctor(
    *,
    case: CaseFile,
    overrides: Overrides = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Examine a case: units, meshes, meetings, contact, time step and cost, with remedies."""
    with failures(case):
        diagnosis = examine(load(case, overrides))
    if as_json:
        typer.echo(json_text(diagnosis.as_dict()))
    else:
        _show(diagnosis)
    if diagnosis.worst == "error":
        raise typer.Exit(BAD_INPUT)


def _show(diagnosis: Diagnosis) -> None:
    table = Table(title=Text(diagnosis.title or "Examination"), title_justify="left")
    table.add_column("level")
    table.add_column("where", overflow="fold")
    table.add_column("finding", overflow="fold")
    for finding in diagnosis.findings:
        said = Text(finding.what)
        if finding.remedy:
            said.append(f"\n→ {finding.remedy}", style="bold")
        table.add_row(Text(finding.level, style=STYLES[finding.level]), Text(finding.key), said)
    Console().print(table)
