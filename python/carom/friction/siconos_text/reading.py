"""Reading text files of Siconos."""

from __future__ import annotations

from pathlib import Path

import scipy.sparse as sp

from carom.errors import InputError, naming
from carom.friction.global_problem import GlobalProblem
from carom.friction.problem import Problem
from carom.friction.record import AnyProblem
from carom.friction.siconos_text.matrices import read_matrix
from carom.friction.siconos_text.tokens import Tokens, is_integer

_DIMENSIONS = {"1", "2", "3"}

_FLAG = 1
"""Words that some files have after the last number, of no consequence."""


def read(path: Path) -> AnyProblem:
    """Read a problem, local or global.

    Raises
    ------
    InputError
        If the file is cut short or foreign, or the problem in it is not valid.
    """
    with naming(path):
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            raise InputError("is neither HDF5 nor text") from None
        return _problem(Tokens(text))


def _problem(tokens: Tokens) -> AnyProblem:
    if tokens.ahead(1) and tokens.ahead(1)[0] not in _DIMENSIONS:
        tokens.words(1, "")
        raise tokens.wrong("is neither HDF5 nor a text of Siconos, which begins with 2 or 3")
    dimension = tokens.integer("the dimension")
    contacts = tokens.integer("the number of contacts")
    size = contacts * dimension
    first = read_matrix(tokens, "the first matrix")
    if _is_global(tokens, first, size=size, contacts=contacts):
        return _global(tokens, first, contacts=contacts, dimension=dimension)
    if first.shape != (size, size):
        raise InputError(
            f"the first matrix is {first.shape[0]} × {first.shape[1]} and no other follows: must "
            f"be {size} × {size} for {contacts} contacts in {dimension}D"
        )
    q, mu = tokens.numbers(size, "q"), tokens.numbers(contacts, "mu")
    _refuse_more(tokens)
    return Problem(first, q.reshape(contacts, dimension), mu)


def _global(tokens: Tokens, m: sp.sparray, *, contacts: int, dimension: int) -> GlobalProblem:
    size = contacts * dimension
    h = read_matrix(tokens, "H")
    f, b = tokens.numbers(m.shape[0], "f"), tokens.numbers(size, "b")
    mu = tokens.numbers(contacts, "mu")
    _refuse_more(tokens)
    return GlobalProblem(m, h, f, b.reshape(contacts, dimension), mu)


def _is_global(tokens: Tokens, first: sp.sparray, *, size: int, contacts: int) -> bool:
    """Whether H follows: more words than q and μ, which begin with a storage and a size."""
    if first.shape == (size, size) and tokens.left <= size + contacts + _FLAG:
        return False
    header = tokens.ahead(3)
    return (
        len(header) == 3
        and all(map(is_integer, header))
        and (int(header[1]), int(header[2])) == (first.shape[0], size)
    )


def _refuse_more(tokens: Tokens) -> None:
    if tokens.left > _FLAG:
        count = tokens.left
        tokens.words(1, "")
        raise tokens.wrong(
            f"{count} words follow the last of mu; rolling friction is not supported"
        )
