"""``carom audit``."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.console import Console

from carom.auditing import Audit
from carom.auditing import audit as check_results
from carom.cli.case import ResultsDirectory
from carom.cli.failures import failures
from carom.cli.plain import json_text

REFUTED = 1
"""Exit status where a check failed; a file that cannot be read ends so too, with an error."""


def audit(
    *,
    directory: ResultsDirectory,
    as_json: Annotated[bool, typer.Option("--json", help="Print all figures as JSON.")] = False,
) -> None:
    """Check finished results by code that shares nothing with the solver."""
    with failures(directory):
        found = check_results(directory)
    if as_json:
        typer.echo(json_text(found.as_dict()))
    else:
        _show(found)
    if not found.confirmed:
        raise typer.Exit(REFUTED)


def _show(found: Audit) -> None:
    console = Console()
    console.print(found)
    if (remarks := found.remarks()) is not None:
        console.print(remarks)
    for check in found.refuted:
        console.print(
            f"refuted: {check.name}: {check.statement}: {check.figure:.3g} where "
            f"{check.tolerance:.3g} {check.unit} is allowed ({check.where})",
            markup=False,
            highlight=False,
            soft_wrap=True,
        )
    outcome = "confirmed" if found.confirmed else "REFUTED"
    console.print(f"{outcome}: {found.verdict}", highlight=False)
