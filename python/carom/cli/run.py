"""``carom run``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from carom.checking import unit_warnings
from carom.cli.case import CaseFile, Overrides, load
from carom.cli.failures import failures
from carom.cli.progress import shown_progress
from carom.errors import CertificateError, ConvergenceError, InputError, naming
from carom.io import layout
from carom.result import Result
from carom.simulation import build, drive


def run(
    *,
    case: CaseFile,
    overrides: Overrides = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Results directory; default results/CASE."),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print errors only.")] = False,
) -> None:
    """Run a case and write its results."""
    console = Console(quiet=quiet)
    directory = Path("results") / case.stem if out is None else out
    with failures(case):
        scenario = load(case, overrides)
        _spare_the_case(case, directory)
        with naming(case):
            simulation = build(scenario)
        for warning in unit_warnings(scenario, simulation.describe()):
            console.print(f"warning: {warning}", markup=False, highlight=False, soft_wrap=True)
        try:
            with shown_progress(console) as observer:
                result = drive(simulation, scenario, directory, observer)
        except (CertificateError, ConvergenceError, KeyboardInterrupt):
            if (directory / layout.SUMMARY).exists():
                console.print(Result.open(directory))
            raise
        console.print(result)


def _spare_the_case(case: Path, directory: Path) -> None:
    """Refuse a results directory where the run would overwrite the case itself."""
    copy = directory / layout.CASE
    if copy.exists() and copy.samefile(case):
        raise InputError(f"{case}: would be overwritten in {directory}; choose another --out")
