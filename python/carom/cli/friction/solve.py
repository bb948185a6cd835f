"""``carom friction solve``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

import carom
from carom.cli.case import Force
from carom.cli.failures import NOT_CONVERGED, failures
from carom.cli.friction.problem_file import ProblemFile, warnings_named
from carom.cli.plain import json_text
from carom.display.tables import add, two_columns
from carom.errors import InputError
from carom.io.sparing import spare_file

if TYPE_CHECKING:
    from carom.friction import Record

REFUTED = "refuted"
"""Status of an answer that its solver took for a solution and that is none."""


def solve(
    *,
    file: ProblemFile,
    solver: Annotated[
        str | None, typer.Option(help="Name of the solver; without it the default.")
    ] = None,
    tolerance: Annotated[
        float, typer.Option(help="Residual at which the problem counts as solved.")
    ] = 1e-8,
    max_iterations: Annotated[
        int | None, typer.Option(metavar="N", help="Iterations after which to give up.")
    ] = None,
    time_limit: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time after which to give up.")
    ] = None,
    warm: Annotated[
        bool, typer.Option("--warm", help="Start from the first guess in the file.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the figures as JSON.")] = False,
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write problem and answer as FCLIB (HDF5).")
    ] = None,
    force: Force = False,
) -> None:
    """Solve a contact problem; exit status 0 only where the answer obeys the law."""
    asked = carom.friction.SOLVERS[0] if solver is None else solver
    if max_iterations is None:
        max_iterations = carom.friction.DEFAULT_ITERATIONS
    with failures(file):
        if out is not None:
            carom.friction.check_suffix(out, carom.friction.FCLIB_SUFFIXES)
            spare_file(out, force=force)
        with warnings_named(file):
            record = carom.friction.read_record(file)
        guess = _guess(record, file) if warm else None
        solution = carom.friction.solve(
            record.problem,
            solver=asked,
            tolerance=tolerance,
            max_iterations=max_iterations,
            time_limit=time_limit,
            guess=guess,
        )
        measured = record.problem.measure(solution.reactions)
        refuted = solution.solved and not measured.decisive <= tolerance
        figures = {
            "file": str(file),
            "contacts": record.problem.contacts,
            "dimension": record.problem.dimension,
            "solver": asked,
            "solved_by": solution.solver,
            "status": REFUTED if refuted else solution.status,
            "residual": measured.residual,
            "natural_residual": measured.natural_residual,
            "certificate_joule": measured.certificate,
            "iterations": solution.iterations,
            "cpu_s": solution.time,
        }
        if out is not None:
            carom.friction.write_record(record.answered(solution), out)
    if as_json:
        typer.echo(json_text(figures))
    else:
        Console().print(_table(figures, title=record.title))
    if figures["status"] != "solved":
        raise typer.Exit(NOT_CONVERGED)


def _guess(record: Record, file: Path) -> Any:  # noqa: ANN401 (an array)
    if not record.guesses:
        raise InputError(f"{file}: has no guess to start from; leave out --warm")
    return record.guesses[0].reactions


def _table(figures: dict[str, Any], *, title: str) -> Table:
    table = two_columns(title or figures["file"])
    add(table, "contacts", f"{figures['contacts']} in {figures['dimension']}D")
    add(table, "status", figures["status"])
    by = figures["solved_by"]
    add(table, "solver", figures["solver"] + (f" ({by})" if by != figures["solver"] else ""))
    add(table, "iterations", str(figures["iterations"]))
    add(table, "time", f"{1e3 * figures['cpu_s']:.3g} ms")
    add(
        table,
        "residual",
        f"{figures['residual']:.2e}, in natural units {figures['natural_residual']:.2e}",
    )
    add(table, "certificate", f"{figures['certificate_joule']:.2e} J")
    return table
