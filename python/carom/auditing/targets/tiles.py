"""Facets of second degree cut into tiles between their nodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.auditing.arrays import Indices
from carom.auditing.mesh.facets import grouped

TILES = {
    3: [[0, 1, 2]],
    4: [[0, 1, 2, 3]],
    # A triangle at every corner, and what is between the middles of the sides.
    6: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    8: [[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6, 7]],
    9: [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]],
}
"""Corners of the tiles of a facet by its number of nodes."""


def cut(facets: Indices) -> tuple[list[list[int]], list[int]]:
    """Return the corners of the tiles of facets, shape [facet_count, a], and whose they are."""
    found: list[tuple[int, list[int]]] = []
    for kind, rows, nodes in grouped(facets, 3):
        for own, facet in zip(rows.tolist(), nodes.tolist(), strict=True):
            found += [(own, [facet[k] for k in tile]) for tile in TILES[len(kind.nodes)]]
    found.sort(key=lambda tile: tile[0])
    return [tile for _, tile in found], [own for own, _ in found]


def padded(rows: Sequence[Sequence[int]], width: int) -> Indices:
    """Return rows of nodes as an array, shape [count, width]; shorter ones end with their first."""
    table = [[*row, *[row[0]] * (width - len(row))] for row in rows]
    return np.array(table, dtype=np.int64).reshape(len(table), width)
