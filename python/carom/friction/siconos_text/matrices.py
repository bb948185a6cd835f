"""Matrices as Siconos stores them in text: dense, in blocks, or as CSparse prints them."""

from __future__ import annotations

import re

import numpy as np
import scipy.sparse as sp

from carom.errors import InputError
from carom.friction.siconos_text.tokens import Tokens, is_integer

DENSE, BLOCKS, PRINTED = 0, 1, 2
"""Numbers of the storages."""

_SIZE = re.compile(r"(\d+)-by-(\d+),")

_GREATEST_HEADER = 40
"""Words of CSparse's own before the size of a matrix, at most."""


def read_matrix(tokens: Tokens, name: str) -> sp.sparray:
    """Read storage, size and entries of a matrix."""
    storage = tokens.integer(f"the storage of {name}")
    if storage not in {DENSE, BLOCKS, PRINTED}:
        raise tokens.wrong(f"the storage of {name} must be 0 (dense), 1 (blocks) or 2 (CSparse)")
    shape = (tokens.integer(f"the rows of {name}"), tokens.integer(f"the columns of {name}"))
    return {DENSE: _dense, BLOCKS: _blocks, PRINTED: _printed}[storage](tokens, name, shape)


def _dense(tokens: Tokens, name: str, shape: tuple[int, int]) -> sp.sparray:
    """Read a dense matrix: its size once more, and its columns."""
    for size, what in zip(shape, ("rows", "columns"), strict=True):
        if tokens.integer(f"the {what} of {name}") != size:
            raise tokens.wrong(f"{name} must have {size} {what} as said before")
    values = tokens.numbers(shape[0] * shape[1], name)
    return sp.csr_array(values.reshape(shape, order="F"))


def _blocks(tokens: Tokens, name: str, shape: tuple[int, int]) -> sp.sparray:
    """Read blocks in compressed block rows.

    First come their number, the numbers of block rows and columns, and where each of these ends.
    Then the lengths of the two lists that follow: the first block of every row, and their number;
    block columns. Last comes every block, its number first, by columns.
    """
    count = tokens.integer(f"the number of blocks of {name}")
    ends = []
    lengths = [tokens.integer(f"the number of block {kind} of {name}") for kind in _KINDS]
    for kind, length, size in zip(_KINDS, lengths, shape, strict=True):
        end = tokens.integers(length, f"the ends of the block {kind} of {name}")
        if np.any(np.diff(end) < 0) or (end[-1] if length else 0) != size:
            raise tokens.wrong(f"the block {kind} of {name} must ascend to {size}")
        ends.append(np.concatenate([[0], end]))
    filled = tokens.integer(f"the length of the block starts of {name}")
    stored = tokens.integer(f"the length of the block columns of {name}")
    if filled > lengths[0] + 1 or stored != count:
        raise tokens.wrong(f"the lists of {name} do not fit {lengths[0]} rows and {count} blocks")
    starts = tokens.integers(filled, f"the block starts of {name}")
    if filled and (starts[0] != 0 or starts[-1] != count or np.any(np.diff(starts) < 0)):
        raise tokens.wrong(f"the block starts of {name} must ascend from 0 to {count}")
    columns = tokens.integers(stored, f"the block columns of {name}")
    if np.any(columns >= lengths[1]):
        raise tokens.wrong(f"the block columns of {name} must be below {lengths[1]}")
    rows = np.repeat(np.arange(max(filled - 1, 0)), np.diff(starts))

    heights, widths = np.diff(ends[0])[rows], np.diff(ends[1])[columns]
    sizes = heights * widths
    total = int(sizes.sum()) + count
    values = tokens.numbers(total, f"the blocks of {name}")
    # Of every word: the block it belongs to and its place there, 0 for the block's number.
    owner = np.repeat(np.arange(count), sizes + 1)
    place = np.arange(total) - np.repeat(np.cumsum(sizes + 1) - sizes - 1, sizes + 1)
    numbered = values[place == 0] == np.arange(count)
    if not numbered.all():
        first = int(np.flatnonzero(place == 0)[np.flatnonzero(~numbered)[0]])
        raise tokens.wrong(f"must be the number of a block of {name}", first - total)
    entry, owner = place[place > 0] - 1, owner[place > 0]
    down, across = entry % heights[owner], entry // heights[owner]
    indices = (ends[0][rows[owner]] + down, ends[1][columns[owner]] + across)
    return sp.coo_array((values[place > 0], indices), shape=shape)


_KINDS = ("rows", "columns")


def _printed(tokens: Tokens, name: str, shape: tuple[int, int]) -> sp.sparray:
    """Read what CSparse prints: a header, then triplets, or columns with their entries."""
    tokens.integer(f"the origin of {name}")
    before = ""
    for _ in range(_GREATEST_HEADER):
        word = tokens.words(1, f"the size of {name}")[0]
        if (size := _SIZE.fullmatch(word)) is not None:
            break
        before = word
    else:
        raise tokens.wrong(
            f"{name} must have a size such as 12-by-12, within {_GREATEST_HEADER} words"
        )
    if (int(size[1]), int(size[2])) != shape:
        raise tokens.wrong(f"{name} must be {shape[0]}-by-{shape[1]}, as said before")
    tokens.expect("nzmax:", name)
    tokens.words(1, name)
    tokens.expect("nnz:", name)
    word = tokens.words(1, name)[0].rstrip(",")
    if not is_integer(word):
        raise tokens.wrong(f"{name} must have its number of entries here")
    if before == "triplet:":
        return _triplets(tokens, name, shape, int(word))
    tokens.expect("1-norm:", name)
    tokens.words(1, name)
    return _columns(tokens, name, shape, int(word))


def _triplets(tokens: Tokens, name: str, shape: tuple[int, int], count: int) -> sp.sparray:
    """Read lines of ``row column : value``."""
    rows, columns, values = [], [], []
    for _ in range(count):
        rows.append(_index(tokens, name, shape[0]))
        columns.append(_index(tokens, name, shape[1]))
        tokens.expect(":", name)
        values.append(tokens.words(1, name)[0])
    return sp.coo_array(
        (tokens.convert(values, name, stride=4), (np.array(rows), np.array(columns))), shape=shape
    )


def _columns(tokens: Tokens, name: str, shape: tuple[int, int], count: int) -> sp.sparray:
    """Read ``col j : locations a to b`` with its lines of ``row : value``, column by column."""
    rows, values, lengths = [], [], []
    for column in range(shape[1]):
        tokens.expect("col", f"column {column} of {name}")
        if tokens.integer(name) != column:
            raise tokens.wrong(f"{name} must have column {column} here")
        tokens.expect(":", name)
        tokens.expect("locations", name)
        first = tokens.integer(name)
        tokens.expect("to", name)
        lengths.append(tokens.integer(name, least=-1) - first + 1)
        for _ in range(lengths[-1]):
            rows.append(_index(tokens, name, shape[0]))
            tokens.expect(":", name)
            values.append(tokens.numbers(1, name)[0])
    if len(values) != count:
        raise InputError(f"{name} has {len(values)} entries: must be {count}, as its header says")
    starts = np.concatenate([[0], np.cumsum(lengths)])
    return sp.csc_array((np.array(values), np.array(rows, dtype=np.int64), starts), shape=shape)


def _index(tokens: Tokens, name: str, size: int) -> int:
    index = tokens.integer(f"an index of {name}")
    if index >= size:
        raise tokens.wrong(f"an index of {name} must be from 0 to {size - 1}")
    return index
