"""What can go wrong, as one hierarchy.

The native module raises these classes too, so this file imports nothing of carom.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.friction import Problem


class CaromError(Exception):
    """Any error that carom raises on purpose."""


class InputError(CaromError, ValueError):
    """What was asked for cannot be run.

    Parameters
    ----------
    message
        One line: the fact, the key and its value, the remedy.
    key
        Dotted path of the offending entry, such as ``bodies.1.mesh.radius``.
    """

    def __init__(self, message: str, key: str | None = None) -> None:
        super().__init__(message)
        self.key = key


class MeshError(InputError):
    """A mesh that cannot carry a computation: inverted cells, bodies that overlap at the start."""


class ConvergenceError(CaromError, RuntimeError):
    """A step failed even after all its retries with smaller time steps.

    Parameters
    ----------
    message
        One line: the time, the step and what did not converge.
    report
        Numbers about the failed step; under ``friction`` what the solver of the contact problem
        said, if that is what failed.
    problem
        The contact problem that could not be solved; None if something else failed. Motions in m,
        forces in N, with ``massless`` contact ξ times these.
    guess
        The reactions that its solver started from [N], shape [n, D].
    """

    def __init__(
        self,
        message: str,
        report: Mapping[str, Any],
        *,
        problem: Problem | None = None,
        guess: NDArray[np.float64] | None = None,
    ) -> None:
        super().__init__(message)
        self.report = dict(report)
        self.problem = problem
        self.guess = guess


class CertificateError(CaromError, RuntimeError):
    """A run came to its end, but Coulomb's law did not hold as it should; its results are kept.

    Parameters
    ----------
    message
        One line: how far from the law the worst step was, what is allowed, the remedy.
    """


class PenetrationError(CaromError, RuntimeError):
    """A run came to its end, but something went into something else; its results are kept.

    Parameters
    ----------
    message
        One line: who was how deep in whom, when, what is allowed, the remedy.
    """


class StorageError(CaromError, OSError):
    """A file of the results could not be written, as on a full disk.

    Parameters
    ----------
    message
        One line: the file, what is wrong, and how to go on.
    """


class CaromWarning(UserWarning):
    """Something that speaks against the results of a run, which ended nevertheless.

    Parameters
    ----------
    message
        One line: the fact, the number, the remedy.
    code
        What it is, in a word that stays the same, such as ``"ledger-defect"``.
    where
        What it is about: a dotted key of the case file or of ``summary.json``, or a file.
    value
        The number that gave rise to it, in the unit that the message names; None if none did.
    allowed
        What the number may be at most, or at least, without a warning.
    """

    def __init__(
        self,
        message: str,
        code: str = "",
        where: str = "",
        value: float | None = None,
        allowed: float | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.code = code
        self.where = where
        self.value = value
        self.allowed = allowed


@contextmanager
def naming(file: str | PathLike[str]) -> Iterator[None]:
    """Put the name of the file in front of every `InputError` that leaves the block."""
    try:
        yield
    except InputError as error:
        raise type(error)(f"{file}: {error}", error.key) from error
