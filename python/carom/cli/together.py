"""How a command ends on several ranks: one line, whoever could not go on, and all of them end."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, redirect_stderr

import typer

from carom.errors import InputError
from carom.ranks.engine import Engine, engine_named


@contextmanager
def together(name: str | None, *, threads: int | None) -> Iterator[Engine | None]:
    """Run a command on the ranks of an engine; None is no engine.

    What one of them says of an error that all of them meet is said once. Where one alone fails, it
    says so and ends the others, which would wait for it.

    Raises
    ------
    typer.Exit
        The command failed; what was wrong is told.
    """
    if name is None:
        yield None
        return
    try:
        if threads not in (None, 1):
            raise InputError(
                f"--threads {threads}: each rank has one thread; start as many ranks as there are "
                "cores"
            )
        engine = engine_named(name)
    except InputError as error:
        if _is_first():
            typer.echo(f"error: {error}", err=True)
        raise typer.Exit(2) from error
    told = io.StringIO()
    try:
        with redirect_stderr(told) if engine.rank > 0 else nullcontext():
            yield engine
    except BaseException as failure:
        status = failure.exit_code if isinstance(failure, typer.Exit) else 1
        alone = not engine.all_failed()
        if alone:
            if engine.rank > 0:
                sys.stderr.write(f"rank {engine.rank}: {told.getvalue() or failure}")
            sys.stderr.flush()
            engine.abort(status)
        raise


def _is_first() -> bool:
    """Return whether this is the first rank, or the only one, before MPI can be asked."""
    of_launchers = ("OMPI_COMM_WORLD_RANK", "PMI_RANK", "SLURM_PROCID")
    return next((os.environ[name] for name in of_launchers if name in os.environ), "0") == "0"
