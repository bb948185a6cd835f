"""``carom watch``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from carom.cli import failures as status
from carom.cli.failures import failures
from carom.cli.progress import shown_progress
from carom.errors import InputError
from carom.io import layout
from carom.io.progress import Running, read_progress
from carom.results.result import Result

STATUSES = {
    "completed": 0,
    "stopped": 0,
    "interrupted": status.INTERRUPTED,
    "failed": status.NOT_CONVERGED,
    "uncertified": status.NOT_CONVERGED,
    "intersecting": status.NOT_CONVERGED,
}
"""Exit statuses by how the run ended: those of `carom run`."""


def watch(
    directory: Annotated[
        Path, typer.Argument(help="Results directory of `carom run`.", metavar="DIR")
    ],
    *,
    every: Annotated[
        float, typer.Option(metavar="SECONDS", min=0.05, help="How often to look [s].")
    ] = 1.0,
) -> None:
    """Follow a run from another terminal, until it ends."""
    console = Console()
    with failures(directory):
        last = _follow(directory, console, every)
        if (directory / layout.SUMMARY).exists():
            result = Result.open(directory)
            console.print(result)
            raise typer.Exit(STATUSES.get(result.summary["status"], status.SYSTEM_FAILURE))
        if last is None:
            raise InputError(
                f"{directory}: no run is going on there, and none has ended; name the results "
                "directory of `carom run`"
            )
        typer.echo(f"error: {_death(directory, last)}", err=True)
        raise typer.Exit(status.SYSTEM_FAILURE)


def _follow(directory: Path, console: Console, every: float) -> Running | None:
    """Show the progress until the run has ended or died; return what was last heard of it."""
    last: Running | None = None
    with shown_progress(console) as show:
        while (running := read_progress(directory)) is not None:
            if running.progress is not None and (last is None or running.updated > last.updated):
                show(running.progress)
            last = running
            if not running.is_alive:
                break
            time.sleep(every)
    return last


def _death(directory: Path, last: Running) -> str:
    """Return how a run ended that says nothing itself."""
    at = f" at t = {last.progress.time:g} s" if last.progress is not None else ""
    died = read_progress(directory) is not None
    what = (
        f"the run has died{at}: process {last.pid} on {last.host} is gone"
        if died
        else f"the run has stopped{at} without results"
    )
    checkpoint = any((directory / name).exists() for name in layout.CHECKPOINTS)
    remedy = (
        "go on from its last checkpoint with carom run CASE --resume"
        if checkpoint
        else "it left no checkpoint"
    )
    return f"{directory}: {what}; {remedy}"
