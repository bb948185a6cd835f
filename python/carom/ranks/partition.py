"""Which rank has which cells of a body."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def ranks_of_cells(
    nodes: NDArray[np.float64], blocks: Sequence[NDArray[np.uint32]], count: int
) -> NDArray[np.int64]:
    """Return the rank of every cell: as many cells each, and boxes that are not long.

    By recursive coordinate bisection (Berger & Bokhari 1987): the box around the cells is cut
    across its longest side, into parts with as many cells as ranks.
    """
    centres = np.concatenate([nodes[cells].mean(axis=1) for cells in blocks])
    ranks = np.zeros(len(centres), dtype=np.int64)
    _cut(centres, np.arange(len(centres)), range(count), ranks)
    return ranks


def _cut(
    centres: NDArray[np.float64],
    cells: NDArray[np.int64],
    among: range,
    ranks: NDArray[np.int64],
) -> None:
    if len(among) == 1 or len(cells) == 0:
        ranks[cells] = among[0]
        return
    own = centres[cells]
    axis = int(np.argmax(np.ptp(own, axis=0)))
    half = len(among) // 2
    # Stable, so that all ranks cut alike.
    order = cells[np.argsort(own[:, axis], kind="stable")]
    at = len(cells) * half // len(among)
    _cut(centres, order[:at], among[:half], ranks)
    _cut(centres, order[at:], among[half:], ranks)


def ranks_of_nodes(
    count: int, blocks: Sequence[NDArray[np.uint32]], cells: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return the rank of each of so many nodes: the first of those that have a cell around it."""
    ranks = np.full(count, np.iinfo(np.int64).max)
    first = 0
    for block in blocks:
        own = cells[first : first + len(block)]
        np.minimum.at(ranks, block, own[:, None])
        first += len(block)
    # What is in no cell is anybody's.
    ranks[ranks == np.iinfo(np.int64).max] = 0
    return ranks
