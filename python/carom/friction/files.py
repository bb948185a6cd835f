"""Reading and writing contact problems; what is in a file is told from its content."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import h5py
from numpy.typing import ArrayLike

from carom.errors import InputError, naming
from carom.friction import fclib, siconos_text
from carom.friction.record import AnyProblem, Iterate, Record
from carom.friction.solution import Solution

FCLIB_SUFFIXES = (".hdf5", ".h5")
TEXT_SUFFIXES = (".dat", ".txt")


def read(path: str | PathLike[str]) -> AnyProblem:
    """Read a problem from an FCLIB file or a text file of Siconos.

    Returns
    -------
    `Problem` or `GlobalProblem`, as the file has it.

    Raises
    ------
    InputError
        If the file is damaged or foreign, or the problem in it is not valid.
    """
    path = Path(path)
    return fclib.read_problem(path) if _is_hdf5(path) else siconos_text.read(path)


def read_record(path: str | PathLike[str]) -> Record:
    """Read a problem with what else the file knows: title, guesses, solution.

    Raises
    ------
    InputError
        As `read`, and if a guess or the solution does not fit the problem.
    """
    path = Path(path)
    return fclib.read(path) if _is_hdf5(path) else Record(siconos_text.read(path), title=path.stem)


def write(
    problem: AnyProblem,
    path: str | PathLike[str],
    *,
    guess: ArrayLike | Solution | Iterate | None = None,
    solution: ArrayLike | Solution | Iterate | None = None,
    title: str = "",
    description: str = "",
) -> None:
    """Write a problem, as an FCLIB file (.hdf5, .h5) or a text file of Siconos (.dat, .txt).

    Parameters
    ----------
    problem
        The problem.
    path
        File to write; one that exists is replaced.
    guess
        Where a solver may start: reactions [N], shape [n, D] or [n D], or what `solve` returned.
        A text file has no place for it, nor for what follows.
    solution
        An answer, likewise.
    title, description
        Where the problem came from.

    Raises
    ------
    InputError
        If the suffix is another one.
    """
    record = Record(
        problem,
        title=title,
        description=description,
        guesses=() if guess is None else (Iterate.of(problem, guess),),
        solution=None if solution is None else Iterate.of(problem, solution),
    )
    write_record(record, path)


def write_record(record: Record, path: str | PathLike[str]) -> None:
    """Write a problem with what else is known of it, as `write` does.

    Raises
    ------
    InputError
        If the suffix is not one of those.
    """
    path = Path(path)
    check_suffix(path)
    if path.suffix in TEXT_SUFFIXES:
        siconos_text.write(record.problem, path)
    else:
        fclib.write(record, path)


def check_suffix(path: Path, suffixes: tuple[str, ...] = (*FCLIB_SUFFIXES, *TEXT_SUFFIXES)) -> None:
    """Raise an `InputError` unless the file's suffix is one of those that say its format."""
    if path.suffix not in suffixes:
        raise InputError(
            f"{path}: the suffix says the format and must be one of {', '.join(suffixes)}"
        )


def _is_hdf5(path: Path) -> bool:
    """Whether a file begins as HDF5 files do; the rest of it may be missing."""
    try:
        with path.open("rb"):
            return bool(h5py.is_hdf5(path))
    except OSError as error:
        with naming(path):
            raise InputError(f"cannot be read: {error.strerror}") from error
