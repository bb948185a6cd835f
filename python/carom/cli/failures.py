"""How a command ends that cannot do what it was asked: one line, and an exit status."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from carom.errors import (
    CertificateError,
    ConvergenceError,
    InputError,
    PenetrationError,
    StorageError,
)
from carom.system.interrupt import Terminated

SYSTEM_FAILURE = 1
BAD_INPUT = 2
NOT_CONVERGED = 3
INTERRUPTED = 130
TERMINATED = 143


@contextmanager
def failures(file: Path) -> Iterator[None]:
    """Turn errors into one line on stderr and an exit status.

    Parameters
    ----------
    file
        What the command works on.
    """
    try:
        yield
    except InputError as error:
        raise _ended(BAD_INPUT, f"error: {error}") from error
    except (CertificateError, ConvergenceError, PenetrationError) as error:
        raise _ended(NOT_CONVERGED, f"error: {file}: {error}") from error
    except Terminated as error:
        raise _ended(TERMINATED, f"{file}: stopped by SIGTERM") from error
    except KeyboardInterrupt as error:
        raise _ended(INTERRUPTED, f"{file}: interrupted") from error
    except StorageError as error:
        raise _ended(SYSTEM_FAILURE, f"error: {error}") from error
    except OSError as error:
        where = error.filename or file
        raise _ended(SYSTEM_FAILURE, f"error: {where}: {error.strerror or error}") from error


def _ended(status: int, line: str) -> typer.Exit:
    typer.echo(line, err=True)
    return typer.Exit(status)
