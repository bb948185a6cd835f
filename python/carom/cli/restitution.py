"""``carom restitution``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from carom.cli.case import CaseFile, Overrides, load
from carom.cli.failures import failures
from carom.cli.lasting import lasting
from carom.cli.sweep import Force, Jobs, Quiet, Scheduler, Vary, refuse_failed, run_told
from carom.display.sheet import Sheet, print_whole
from carom.errors import naming
from carom.plot.style import save
from carom.sweep import axis
from carom.sweep.impacts import CURVES, IMPACTS, impact_rows, names_of
from carom.sweep.impacts_figure import impacts_figure

SHOWN = {
    "approach": "approach [m/s]",
    "sliding": "sliding [m/s]",
    "restitution": "e",
    "tangential_restitution": "tangential",
    "vibration": "vibration [J]",
    "strain": "strain [J]",
    "friction": "friction [J]",
}
"""Columns that fit a screen, and their titles there."""


def restitution(
    *,
    case: CaseFile,
    vary: Vary,
    overrides: Overrides = None,
    between: Annotated[
        str | None,
        typer.Option(
            metavar="A,B", help="The two whose impact counts; default the first that meet."
        ),
    ] = None,
    impact: Annotated[
        int, typer.Option(min=1, help="Which of their impacts, the first by default.")
    ] = 1,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Directory of the study; default results/CASE-restitution."
        ),
    ] = None,
    jobs: Jobs = None,
    scheduler: Scheduler = None,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Run a case with many values, and show what an impact did: curves of e, and of the energy.

    It is a study as of carom sweep, with its files, and a table and a picture of the impacts beside
    them. Runs without that impact have empty cells.
    """
    console = Console(quiet=quiet, file=lasting())
    directory = Path("results") / f"{case.stem}-restitution" if out is None else out
    with failures(case):
        scenario = load(case, overrides)
        with naming(case):
            two = names_of(scenario, between)
            axes = [axis(text) for text in vary]
            made = run_told(
                console, scenario, axes, directory, jobs=jobs, scheduler=scheduler, force=force
            )
        keys = [one.key for one in axes]
        rows = impact_rows(scenario, axes, directory, between=two, number=impact)
        save(impacts_figure(scenario.title, keys, rows), directory / CURVES)
    sheet = Sheet((*keys, *SHOWN.values()), _cells(keys, rows), len(keys))
    print_whole(console, sheet, title=scenario.title or "Impacts")
    console.print(f"{directory / IMPACTS}, {directory / CURVES}", highlight=False, soft_wrap=True)
    refuse_failed(made)


def _cells(keys: Sequence[str], rows: Sequence[dict[str, Any]]) -> list[list[str]]:
    return [
        [
            *(str(row[key]) for key in keys),
            *("" if row[name] is None else f"{row[name]:.4g}" for name in SHOWN),
        ]
        for row in rows
    ]
