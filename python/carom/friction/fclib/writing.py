"""Writing FCLIB files."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import scipy.sparse as sp

from carom.friction.fclib.reading import COLUMNS, ROWS
from carom.friction.problem import Problem
from carom.friction.record import Iterate, Record


def write(record: Record, path: Path) -> None:
    """Write an FCLIB file, whole or not at all."""
    partial = path.with_name(f"{path.name}.tmp")
    try:
        with h5py.File(partial, "w") as file:
            _write_record(file, record)
        partial.replace(path)
    except BaseException:  # Ctrl-C leaves no half a file either
        partial.unlink(missing_ok=True)
        raise


def _write_record(file: h5py.File, record: Record) -> None:
    _write_problem(file, record)
    if record.guesses:
        guesses = file.create_group("guesses")
        _put_integer(guesses, "number_of_guesses", len(record.guesses))
        for number, guess in enumerate(record.guesses, start=1):
            _put_iterate(guesses.create_group(str(number)), guess)
    if record.solution is not None:
        _put_iterate(file.create_group("solution"), record.solution)


def _write_problem(file: h5py.File, record: Record) -> None:
    problem = record.problem
    local = isinstance(problem, Problem)
    root = file.create_group("fclib_local" if local else "fclib_global")
    _put_integer(root, "spacedim", problem.dimension)
    vectors = root.create_group("vectors")
    if isinstance(problem, Problem):
        _put_rows(root.create_group("W"), problem.matrix().tocsr())
        vectors["q"] = problem.q.ravel()
    else:
        _put_columns(root.create_group("M"), problem.M)
        _put_columns(root.create_group("H"), problem.H)
        vectors["f"] = problem.f
        vectors["w"] = problem.b.ravel()
    vectors["mu"] = problem.mu
    info = root.create_group("info")
    _put_text(info, "title", record.title)
    _put_text(info, "description", record.description)
    _put_text(info, "math_info", "")


def _put_rows(group: h5py.Group, matrix: sp.csr_array) -> None:
    matrix.eliminate_zeros()
    _put_compressed(group, matrix, ROWS)


def _put_columns(group: h5py.Group, matrix: sp.csc_array) -> None:
    _put_compressed(group, matrix, COLUMNS)


def _put_compressed(group: h5py.Group, matrix: sp.csr_array | sp.csc_array, kind: int) -> None:
    _put_integer(group, "nzmax", matrix.nnz)
    _put_integer(group, "m", matrix.shape[0])
    _put_integer(group, "n", matrix.shape[1])
    _put_integer(group, "nz", kind)
    group["p"] = matrix.indptr.astype(np.int32)
    group["i"] = matrix.indices.astype(np.int32)
    group["x"] = matrix.data


def _put_iterate(group: h5py.Group, iterate: Iterate) -> None:
    if iterate.velocities is not None:
        group["v"] = iterate.velocities
    group["u"] = iterate.motions.ravel()
    group["r"] = iterate.reactions.ravel()


def _put_integer(group: h5py.Group, name: str, value: int) -> None:
    group[name] = np.array([value], dtype=np.int32)


def _put_text(group: h5py.Group, name: str, text: str) -> None:
    """Write a text that ends with a zero byte, as C programs expect it."""
    data = text.encode()
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(data) + 1)
    kind.set_strpad(h5py.h5t.STR_NULLTERM)
    space = h5py.h5s.create(h5py.h5s.SCALAR)
    dataset = h5py.h5d.create(group.id, name.encode(), kind, space)
    dataset.write(space, space, np.array(data, dtype=f"S{len(data) + 1}"), kind)
