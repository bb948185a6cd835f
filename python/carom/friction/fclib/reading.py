"""Reading FCLIB files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from carom.display.counting import count
from carom.errors import InputError, naming
from carom.friction.global_problem import GlobalProblem
from carom.friction.problem import Problem
from carom.friction.record import AnyProblem, Iterate, Record

COLUMNS, ROWS = -1, -2
"""Values of ``nz`` for compressed columns and compressed rows."""

FORMS = ("fclib_local", "fclib_global")

BILATERAL = {"fclib_local": ("V", "R"), "fclib_global": ("G",)}
"""Matrices of bilateral constraints, by form."""


def read(path: Path) -> Record:
    """Read a problem with its title, guesses and solution.

    Raises
    ------
    InputError
        If the file is damaged or foreign, or the problem in it is not valid.
    """
    with _opened(path) as file:
        root, problem = _problem(file)
        return Record(
            problem,
            title=_text(root, "title"),
            description=_text(root, "description"),
            guesses=tuple(_guesses(file, problem)),
            solution=_iterate(file, "solution", problem) if "solution" in file else None,
        )


def read_problem(path: Path) -> AnyProblem:
    """Read the problem alone.

    Raises
    ------
    InputError
        If the file is damaged or foreign, or the problem in it is not valid.
    """
    with _opened(path) as file:
        return _problem(file)[1]


@contextmanager
def _opened(path: Path) -> Iterator[h5py.File]:
    """Open a file; what HDF5 says of a damaged one becomes an `InputError`."""
    with naming(path):
        try:
            with h5py.File(path, "r") as file:
                yield file
        except (InputError, FileNotFoundError, PermissionError):
            raise
        except (OSError, KeyError, RuntimeError, ValueError, TypeError) as error:
            reason = " ".join(str(error).split())
            raise InputError(f"is no readable HDF5 file, perhaps cut short: {reason}") from error


def _problem(file: h5py.File) -> tuple[h5py.Group, AnyProblem]:
    """Return the group of the problem, and the problem."""
    form = next((name for name in FORMS if name in file), None)
    if form is None:
        raise InputError(
            f"has no group {' or '.join(FORMS)} (but {', '.join(list(file)[:5]) or 'nothing'}): "
            "not an FCLIB file of a contact problem"
        )
    root = _group(file, form)
    for name in BILATERAL[form]:
        if name in root:
            raise InputError(f"{form}/{name}: bilateral constraints are not supported")
    dimension = _integer(root, "spacedim")
    if dimension not in {1, 2, 3}:
        raise InputError(f"{form}/spacedim = {dimension}: must be 2 or 3")
    mu = _numbers(root, "vectors/mu")
    if form == "fclib_local":
        return root, Problem(_matrix(root, "W"), _vectors(root, "vectors/q", mu, dimension), mu)
    m, h, f = _matrix(root, "M"), _matrix(root, "H"), _numbers(root, "vectors/f")
    return root, GlobalProblem(m, h, f, _vectors(root, "vectors/w", mu, dimension), mu)


def _matrix(root: h5py.Group, name: str) -> sp.sparray:
    """Return a matrix stored as CSparse has it."""
    group = _group(root, name)
    where = _where(group)
    rows, columns, kind = (_integer(group, key) for key in ("m", "n", "nz"))
    if rows < 0 or columns < 0 or kind < ROWS:
        raise InputError(
            f"{where}: m = {rows}, n = {columns}, nz = {kind}: must be sizes, and −1, −2 or the "
            "number of triplets"
        )
    values, inner = _numbers(group, "x"), _integers(group, "i")
    outer = _integers(group, "p")
    if kind >= 0:
        _at_least(group, "x", values, kind)
        _at_least(group, "i", inner, kind)
        _at_least(group, "p", outer, kind)
        values, inner, outer = values[:kind], inner[:kind], outer[:kind]
        _inside(group, "i", inner, rows)
        _inside(group, "p", outer, columns)
        return sp.coo_array((values, (inner, outer)), shape=(rows, columns))
    major, minor = (columns, rows) if kind == COLUMNS else (rows, columns)
    if len(outer) != major + 1:
        raise InputError(f"{where}/p has {_entries(outer)}: must be {major + 1}")
    if outer[0] != 0 or np.any(np.diff(outer) < 0):
        raise InputError(f"{where}/p: must begin with 0 and never decrease")
    stored = int(outer[-1])
    _at_least(group, "x", values, stored)
    _at_least(group, "i", inner, stored)
    values, inner = values[:stored], inner[:stored]
    _inside(group, "i", inner, minor)
    compressed = sp.csc_array if kind == COLUMNS else sp.csr_array
    return compressed((values, inner, outer), shape=(rows, columns))


def _vectors(
    root: h5py.Group, name: str, mu: NDArray[np.float64], dimension: int
) -> NDArray[np.float64]:
    """Return one vector for each contact of μ, shape [n, D]."""
    values = _numbers(root, name)
    if len(values) != len(mu) * dimension:
        raise InputError(
            f"{_where(root, name)} has {_entries(values)}: must be {len(mu) * dimension}, "
            f"{dimension} (spacedim) for each of the {count(len(mu), 'contact')} of mu"
        )
    return values.reshape(len(mu), dimension)


def _guesses(file: h5py.File, problem: AnyProblem) -> Iterator[Iterate]:
    if "guesses" not in file:
        return
    guesses = _group(file, "guesses")
    for number in range(1, _integer(guesses, "number_of_guesses") + 1):
        yield _iterate(guesses, str(number), problem)


def _iterate(parent: h5py.Group, name: str, problem: AnyProblem) -> Iterate:
    group = _group(parent, name)
    where = _where(group)
    velocities = None
    if isinstance(problem, GlobalProblem):
        velocities = _numbers(group, "v")
        if len(velocities) != problem.dofs:
            raise InputError(f"{where}/v has {_entries(velocities)}: must be {problem.dofs}")
    return Iterate(
        problem.vectors(f"{where}/r", _numbers(group, "r")),
        problem.vectors(f"{where}/u", _numbers(group, "u")),
        velocities,
    )


def _group(parent: h5py.Group, name: str) -> h5py.Group:
    found = parent.get(name)
    if not isinstance(found, h5py.Group):
        raise InputError(f"{_where(parent, name)}: required group is missing")
    return found


def _dataset(parent: h5py.Group, name: str) -> NDArray[np.generic]:
    found = parent.get(name)
    if not isinstance(found, h5py.Dataset):
        raise InputError(f"{_where(parent, name)}: required dataset is missing")
    return np.ravel(found[()])


def _numbers(parent: h5py.Group, name: str) -> NDArray[np.float64]:
    values = _dataset(parent, name)
    if values.dtype.kind not in "fiu":
        raise InputError(f"{_where(parent, name)}: has {values.dtype} data; must be numbers")
    if not np.isfinite(values).all():
        index = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"{_where(parent, name)}[{index}] = {values[index]}: must be finite")
    return values.astype(np.float64)


def _integers(parent: h5py.Group, name: str) -> NDArray[np.int64]:
    values = _dataset(parent, name)
    if values.dtype.kind not in "iu":
        raise InputError(f"{_where(parent, name)}: has {values.dtype} data; must be integers")
    return values.astype(np.int64)


def _integer(parent: h5py.Group, name: str) -> int:
    values = _integers(parent, name)
    if len(values) != 1:
        raise InputError(f"{_where(parent, name)} has {_entries(values)}: must be one integer")
    return int(values[0])


def _text(root: h5py.Group, name: str) -> str:
    """Return a text of the group ``info``, empty where there is none."""
    found = root.get(f"info/{name}")
    if not isinstance(found, h5py.Dataset):
        return ""
    value = found[()]
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value)


def _at_least(group: h5py.Group, name: str, values: NDArray[np.generic], least: int) -> None:
    if len(values) < least:
        raise InputError(f"{_where(group, name)} has {_entries(values)}: must be {least}")


def _inside(group: h5py.Group, name: str, indices: NDArray[np.int64], size: int) -> None:
    outside = np.flatnonzero((indices < 0) | (indices >= size))
    if outside.size:
        index = int(outside[0])
        raise InputError(
            f"{_where(group, name)}[{index}] = {indices[index]}: must be from 0 to {size - 1}"
        )


def _where(group: h5py.Group, name: str = "") -> str:
    return f"{group.name}/{name}".strip("/")


def _entries(values: NDArray[np.generic]) -> str:
    return count(len(values), "entry", "entries")
