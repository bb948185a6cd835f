"""W in compressed block rows: a D × D block for each pair of contacts that act on one another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class BlockRows:
    """A square matrix of D × D blocks.

    Parameters
    ----------
    starts
        First block of every row, and their number, shape [n + 1].
    columns
        Block columns, ascending in every row, the diagonal among them.
    blocks
        The blocks, shape [block_count, D, D].
    """

    starts: NDArray[np.int64]
    columns: NDArray[np.int64]
    blocks: NDArray[np.float64]

    def matrix(self) -> sp.bsr_array:
        """Return the matrix, shape [n D, n D]."""
        size = (len(self.starts) - 1) * self.blocks.shape[1]
        if size == 0:
            return sp.bsr_array((0, 0))
        return sp.bsr_array((self.blocks, self.columns, self.starts), shape=(size, size))


def block_rows(symmetric: sp.csr_array, dimension: int) -> BlockRows:
    """Return a symmetric matrix in blocks; those on the diagonal are stored even where zero."""
    count = symmetric.shape[0] // dimension
    if count == 0:
        none = np.zeros(0, dtype=np.int64)
        return BlockRows(np.zeros(1, dtype=np.int64), none, np.zeros((0, dimension, dimension)))
    rows = symmetric.tobsr(blocksize=(dimension, dimension))
    rows.sort_indices()
    owners = np.repeat(np.arange(count), np.diff(rows.indptr))
    missing = np.setdiff1d(np.arange(count), owners[rows.indices == owners])
    starts, columns, blocks = rows.indptr, rows.indices, rows.data
    if missing.size:
        columns = np.concatenate([columns, missing])
        blocks = np.concatenate([blocks, np.zeros((missing.size, dimension, dimension))])
        owners = np.concatenate([owners, missing])
        order = np.lexsort((columns, owners))
        columns, blocks = columns[order], blocks[order]
        starts = np.concatenate([[0], np.cumsum(np.bincount(owners, minlength=count))])
    return BlockRows(
        np.ascontiguousarray(starts, dtype=np.int64),
        np.ascontiguousarray(columns, dtype=np.int64),
        np.ascontiguousarray(blocks, dtype=np.float64),
    )
