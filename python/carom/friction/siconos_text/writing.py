"""Writing text files of Siconos."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from carom.friction.problem import Problem
from carom.friction.record import AnyProblem
from carom.friction.siconos_text.matrices import BLOCKS, PRINTED

_TRIPLET = 1
"""The origin that Siconos notes of a matrix in triplets."""


def write(problem: AnyProblem, path: Path) -> None:
    """Write a problem, whole or not at all: W in blocks, M and H in triplets."""
    lines = [str(problem.dimension), str(problem.contacts)]
    if isinstance(problem, Problem):
        lines += _blocks(problem)
        vectors = [problem.q, problem.mu]
    else:
        lines += [*_triplets(problem.M), *_triplets(problem.H)]
        vectors = [problem.f, problem.b, problem.mu]
    lines += [_line(np.ravel(vector)) for vector in vectors]
    partial = path.with_name(f"{path.name}.tmp")
    partial.write_text("\n".join(lines) + "\n", encoding="utf-8")
    partial.replace(path)


def _blocks(problem: Problem) -> Iterable[str]:
    n, dimension, count = problem.contacts, problem.dimension, len(problem.columns)
    ends = _line(dimension * np.arange(1, n + 1))
    yield from map(str, (BLOCKS, n * dimension, n * dimension, count, n, n))
    yield from (ends, ends, str(n + 1), str(count), _line(problem.starts), _line(problem.columns))
    for number, block in enumerate(problem.blocks):
        yield str(number)
        yield _line(block.T.ravel())


def _triplets(matrix: sp.csc_array) -> Iterable[str]:
    rows, columns = matrix.shape
    entries = matrix.tocoo()
    yield from map(str, (PRINTED, rows, columns, _TRIPLET))
    yield "CSparse"
    yield f"triplet: {rows}-by-{columns}, nzmax: {entries.nnz} nnz: {entries.nnz}"
    lists = (entries.row.tolist(), entries.col.tolist(), entries.data.tolist())
    for row, column, value in zip(*lists, strict=True):
        yield f"    {row} {column} : {value!r}"


def _line(values: NDArray[np.generic]) -> str:
    return " ".join(map(repr, values.tolist()))
