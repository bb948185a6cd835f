"""``carom sweep``."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from carom.case.scenario import Scenario
from carom.cli.case import CaseFile, Overrides, load
from carom.cli.failures import NOT_CONVERGED, failures
from carom.cli.lasting import lasting
from carom.display.sheet import Sheet, print_whole
from carom.errors import naming
from carom.plot.style import save
from carom.sweep import PICTURE, TABLE, Axis, Done, axis
from carom.sweep import sweep as run_all
from carom.sweep.figure import sweep_figure
from carom.sweep.table import shown_cells
from carom.system.interrupt import terminable

Vary = Annotated[
    list[str],
    typer.Option(
        metavar="KEY=VALUES",
        help="What to vary: START:STOP:COUNT with both ends, or a comma list; can be repeated.",
    ),
]
Jobs = Annotated[
    int | None, typer.Option(min=1, help="Processes at a time; default one per processor.")
]
Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Dask scheduler to run on, which sees these files."),
]
Force = Annotated[
    bool, typer.Option("--force", help="Run finished points again; replace another study.")
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print errors only.")]


def sweep(
    *,
    case: CaseFile,
    vary: Vary,
    overrides: Overrides = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Directory of the study; default results/CASE-sweep."),
    ] = None,
    jobs: Jobs = None,
    scheduler: Scheduler = None,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Run a case with many values side by side; one table, one picture, a folder for each run.

    Points that are finished are not run again. A run that fails is a row with its reason, and the
    exit status is then 3.
    """
    console = Console(quiet=quiet, file=lasting())
    directory = Path("results") / f"{case.stem}-sweep" if out is None else out
    with failures(case):
        scenario = load(case, overrides)
        with naming(case):
            axes = [axis(text) for text in vary]
            rows = run_told(
                console, scenario, axes, directory, jobs=jobs, scheduler=scheduler, force=force
            )
        keys = [one.key for one in axes]
        save(sweep_figure(scenario.title, keys, rows), directory / PICTURE)
    header, cells = shown_cells(keys, rows)
    print_whole(console, Sheet(header, cells, len(keys)), title=scenario.title or "Study")
    for row in rows:
        if row["reason"]:
            where = ", ".join(f"{key} = {row[key]}" for key in keys)
            said = f"{where}: {row['status']}: {row['reason']}"
            console.print(said, markup=False, highlight=False, soft_wrap=True)
    console.print(f"{directory / TABLE}, {directory / PICTURE}", highlight=False, soft_wrap=True)
    refuse_failed(rows)


def run_told(
    console: Console,
    scenario: Scenario,
    axes: Sequence[Axis],
    directory: Path,
    *,
    jobs: int | None,
    scheduler: str | None,
    force: bool,
) -> list[dict[str, Any]]:
    """Run a study, see `carom.sweep`, and tell of every run that is done."""
    ended = 0
    tell = _teller(console, [one.key for one in axes])

    def done(count: int, of: int, row: dict[str, Any]) -> None:
        nonlocal ended
        ended = count
        tell(count, of, row)

    try:
        with terminable():
            return run_all(
                scenario,
                axes,
                directory,
                jobs=jobs,
                scheduler=scheduler,
                force=force,
                done=done,
            )
    except KeyboardInterrupt:
        typer.echo(
            f"{ended} of {prod(len(one.values) for one in axes)} runs have ended and are kept in "
            f"{directory}; the same command, without --force, goes on",
            err=True,
        )
        raise


def _teller(console: Console, keys: Sequence[str]) -> Done:
    """Return what tells of every run that is done."""

    def done(count: int, of: int, row: dict[str, Any]) -> None:
        where = ", ".join(f"{key} = {row[key]}" for key in keys)
        said = f"{count}/{of}: {where}: {row['status']}"
        if row["warnings"]:
            said += f", warnings: {row['warnings']}"
        console.print(said, markup=False, highlight=False)

    return done


def refuse_failed(rows: Sequence[dict[str, Any]]) -> None:
    """Exit with a status that says so if runs did not complete."""
    if failed := [row for row in rows if row["status"] != "completed"]:
        typer.echo(f"{len(failed)} of {len(rows)} runs did not complete", err=True)
        raise typer.Exit(NOT_CONVERGED)
