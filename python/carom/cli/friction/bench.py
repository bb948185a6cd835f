"""``carom friction bench``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

import carom
from carom.cli.case import Force
from carom.cli.failures import failures
from carom.display.sheet import Sheet, print_whole
from carom.errors import InputError
from carom.io.sparing import spare_file
from carom.messages import known
from carom.system.existing import entries

if TYPE_CHECKING:
    from carom.friction.bench import Run

PEERS = ("siconos",)


def bench(
    *,
    folder: Annotated[
        Path, typer.Argument(help="Folder of contact problems, and those below it.", metavar="DIR")
    ],
    solvers: Annotated[
        str | None, typer.Option(metavar="A,B,…", help="Names of solvers; without them all.")
    ] = None,
    tolerance: Annotated[
        float, typer.Option(help="Residual at which a problem counts as solved.")
    ] = 1e-8,
    time_limit: Annotated[
        float, typer.Option(metavar="SECONDS", help="Time that a solve may take.")
    ] = 10.0,
    against: Annotated[
        str | None, typer.Option(help="Another code to run beside: siconos.", metavar="CODE")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write the tables and the performance profile."),
    ] = None,
    force: Force = False,
) -> None:
    """Compare solvers on all contact problems of a folder."""
    screen, progress = Console(), Console(stderr=True)

    def show(run: Run) -> None:
        took = f"{1e3 * run.time:.3g} ms, " if run.time == run.time else ""
        progress.print(
            f"{run.case}: {run.solver}: {took}{run.status}, residual {run.residual:.1e}",
            highlight=False,
            soft_wrap=True,
        )

    with failures(folder):
        from carom.friction import bench as friction_bench  # noqa: PLC0415 (imports scipy)

        if out is not None and entries(out):
            for name in friction_bench.FILES:
                spare_file(out / name, force=force)
        names = _solvers(solvers)
        if against is not None and against not in PEERS:
            raise InputError(f"--against {against}: {known(against, PEERS)}")
        siconos = friction_bench.Siconos.find() if against is not None else None
        cases, refused = friction_bench.read_cases(folder)
        for file, why in refused.items():
            typer.echo(f"warning: {file}: left out: {why}", err=True)
        comparison = friction_bench.compare(
            cases,
            names,
            tolerance=tolerance,
            time_limit=time_limit,
            siconos=siconos,
            observer=show,
        )
        if out is not None:
            for path in friction_bench.write_report(comparison, out):
                progress.print(path)
            progress.print(friction_bench.draw_profile(comparison, out))
    for part in friction_bench.parts(comparison):
        if isinstance(part, Sheet):
            print_whole(screen, part)
        else:
            screen.print(part, markup=False, highlight=False, soft_wrap=True)


def _solvers(names: str | None) -> list[str]:
    """Return the solvers asked for."""
    if names is None:
        return list(carom.friction.SOLVERS)
    chosen = [name.strip() for name in names.split(",")]
    for name in chosen:
        if name not in carom.friction.SOLVERS:
            raise InputError(f"--solvers {name}: {known(name, carom.friction.SOLVERS)}")
    return chosen
