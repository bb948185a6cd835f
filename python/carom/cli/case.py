"""What commands have in common that take a case file or results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from carom.case.scenario import Scenario
from carom.cli import complete
from carom.errors import naming

CaseFile = Annotated[
    Path,
    typer.Argument(help="Case file (TOML).", metavar="CASE", autocompletion=complete.case_files),
]

ResultsDirectory = Annotated[
    Path,
    typer.Argument(
        help="Results directory of `carom run`.",
        metavar="DIR",
        autocompletion=complete.results,
    ),
]

Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Replace a value, such as analysis.end_time=3; can be repeated.",
    ),
]

Force = Annotated[bool, typer.Option("--force", help="Replace a file that is there already.")]


def load(case: Path, overrides: list[str] | None) -> Scenario:
    """Read a case file and put the overrides in place."""
    scenario = Scenario.from_toml(case)
    with naming(case):
        return scenario.with_overrides(overrides or [])
