"""``carom run``."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from carom.building.build import build
from carom.case.scenario import Scenario
from carom.cli.case import CaseFile, Overrides, load
from carom.cli.failures import failures
from carom.cli.lasting import lasting
from carom.cli.progress import shown_progress
from carom.cli.together import together
from carom.errors import (
    CertificateError,
    ConvergenceError,
    InputError,
    PenetrationError,
    naming,
)
from carom.io import layout
from carom.io.claim import claimed
from carom.mesh_file import Note
from carom.ranks.engine import Engine, in_turn
from carom.results.doubts import Doubt
from carom.results.result import Result
from carom.running.restart import ended
from carom.running.run import drive
from carom.system.existing import entries
from carom.system.interrupt import terminable
from carom.system.threads import take_threads


def run(
    *,
    case: CaseFile,
    overrides: Overrides = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Results directory; default results/CASE."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the last checkpoint in DIR.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Replace the results that are in DIR.")
    ] = False,
    threads: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, help="Threads that share the work; default all cores."),
    ] = None,
    engine: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Share bodies among the processes of mpiexec, by this engine: petsc.",
        ),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print errors only.")] = False,
) -> None:
    """Run a case and write its results."""
    with failures(case):
        take_threads(threads)
    with together(engine, threads=threads) as ranks:
        _run(case, overrides, out, resume=resume, force=force, quiet=quiet, ranks=ranks)


def _run(
    case: Path,
    overrides: Overrides,
    out: Path | None,
    *,
    resume: bool,
    force: bool,
    quiet: bool,
    ranks: Engine | None,
) -> None:
    is_mute = quiet or (ranks is not None and ranks.rank > 0)
    console = Console(quiet=is_mute, file=lasting())

    def tell(line: str) -> None:
        console.print(line, markup=False, highlight=False, soft_wrap=True)

    def tell_of(doubt: Doubt) -> None:
        # What is found at the end stands in the table that follows.
        if not (directory / layout.SUMMARY).exists():
            tell(f"warning: {doubt.message}")

    directory = Path("results") / case.stem if out is None else out
    with failures(case), terminable():
        if resume and force:
            raise InputError("--resume goes on with a run, --force replaces it; give one of them")
        scenario = load(case, overrides)
        _spare_the_case(case, directory)
        if resume and (there := _ended(directory, scenario, ranks)) is not None:
            tell(
                f"{directory}: the run has ended ({there.summary['status']}); nothing to go on with"
            )
            return
        with naming(case):
            notes: list[Note] = []
            simulation = build(scenario, notes, engine=ranks)
        try:
            with shown_progress(console) as progress:
                result = drive(
                    simulation,
                    scenario,
                    directory,
                    progress=progress,
                    resume=resume,
                    force=force,
                    notes=notes,
                    notify=tell_of,
                    engine=ranks,
                )
        except (CertificateError, ConvergenceError, PenetrationError, KeyboardInterrupt):
            if (directory / layout.SUMMARY).exists():
                console.print(Result.open(directory))
            raise
        console.print(result)


def _ended(directory: Path, scenario: Scenario, ranks: Engine | None) -> Result | None:
    """Return the results of a run that has ended, whose last files may have to be made."""

    def look() -> Result | None:
        follows = ranks is not None and ranks.rank > 0
        with claimed(directory) if is_open and not follows else nullcontext():
            return ended(directory, scenario)

    is_open = (directory / layout.PROGRESS).exists()
    return in_turn(ranks, look)


def _spare_the_case(case: Path, directory: Path) -> None:
    """Refuse a results directory where the run would overwrite the case itself."""
    copy = directory / layout.CASE
    if layout.CASE in entries(directory) and copy.exists() and copy.samefile(case):
        raise InputError(f"{case}: would be overwritten in {directory}; choose another --out")
