"""The kinds of cells that files hold: names, dimensions, and how a cell is turned inside out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.mesh_file.arrays import Indices


@dataclass(frozen=True)
class Kind:
    """A kind of cell that bodies and their facets are made of.

    Parameters
    ----------
    name
        As the case file names it.
    dimension
        Of the cell.
    edges
        For each corner its neighbours, such that the edges to them are right-handed.
    sides
        The corners of each side, as a walk with the cell on the left, or as seen from outside.
    mirror
        The nodes in an order that turns the cell inside out and keeps its shape.
    """

    name: str
    dimension: int
    edges: tuple[tuple[int, ...], ...]
    sides: tuple[tuple[int, ...], ...]
    mirror: tuple[int, ...]


_Table = tuple[tuple[int, ...], ...]

_LINE: tuple[_Table, _Table] = (), ()
_TRIANGLE: tuple[_Table, _Table] = ((1, 2), (2, 0), (0, 1)), ((0, 1), (1, 2), (2, 0))
_QUADRILATERAL: tuple[_Table, _Table] = (
    ((1, 3), (2, 0), (3, 1), (0, 2)),
    ((0, 1), (1, 2), (2, 3), (3, 0)),
)
_TETRAHEDRON: tuple[_Table, _Table] = ((1, 2, 3),), ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
_HEXAHEDRON_EDGES = (
    (1, 3, 4),
    (2, 0, 5),
    (3, 1, 6),
    (0, 2, 7),
    (7, 5, 0),
    (4, 6, 1),
    (5, 7, 2),
    (6, 4, 3),
)
_HEXAHEDRON_SIDES = (
    *((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5)),
    *((2, 3, 7, 6), (3, 0, 4, 7)),
)
_HEXAHEDRON: tuple[_Table, _Table] = _HEXAHEDRON_EDGES, _HEXAHEDRON_SIDES
_WEDGE: tuple[_Table, _Table] = (
    ((1, 2, 3), (2, 0, 4), (0, 1, 5), (5, 4, 0), (3, 5, 1), (4, 3, 2)),
    ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
)
# The first two directions change places: corners, then edges, faces and the middle.
_HEX8 = (0, 3, 2, 1, 4, 7, 6, 5)
_HEX20 = (*_HEX8, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17)

KINDS = {
    "line": Kind("line2", 1, *_LINE, (1, 0)),
    "line3": Kind("line3", 1, *_LINE, (1, 0, 2)),
    "triangle": Kind("tri3", 2, *_TRIANGLE, (0, 2, 1)),
    "triangle6": Kind("tri6", 2, *_TRIANGLE, (0, 2, 1, 5, 4, 3)),
    "quad": Kind("quad4", 2, *_QUADRILATERAL, (0, 3, 2, 1)),
    "quad8": Kind("quad8", 2, *_QUADRILATERAL, (0, 3, 2, 1, 7, 6, 5, 4)),
    "quad9": Kind("quad9", 2, *_QUADRILATERAL, (0, 3, 2, 1, 7, 6, 5, 4, 8)),
    "tetra": Kind("tet4", 3, *_TETRAHEDRON, (0, 2, 1, 3)),
    "tetra10": Kind("tet10", 3, *_TETRAHEDRON, (0, 2, 1, 3, 6, 5, 4, 7, 9, 8)),
    "wedge": Kind("wedge6", 3, *_WEDGE, (0, 2, 1, 3, 5, 4)),
    "wedge15": Kind("wedge15", 3, *_WEDGE, (0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13)),
    "hexahedron": Kind("hex8", 3, *_HEXAHEDRON, _HEX8),
    "hexahedron20": Kind("hex20", 3, *_HEXAHEDRON, _HEX20),
    "hexahedron27": Kind("hex27", 3, *_HEXAHEDRON, (*_HEX20, 22, 23, 20, 21, 24, 25, 26)),
}
"""By the name that meshio gives them."""

_DIMENSIONS = {"vertex": 0, "line": 1, "triangle": 2, "quad": 2, "polygon": 2}


def dimension(kind: str) -> int:
    """Return the dimension of a kind of cell, which carom may not know, by its name in meshio."""
    if kind in KINDS:
        return KINDS[kind].dimension
    return _DIMENSIONS.get(kind.rstrip("0123456789"), 3)


def smallest_corner(kind: Kind, points: np.ndarray, nodes: Indices) -> np.ndarray:
    """Return for each cell the smallest volume or area that the edges at a corner span.

    It is negative for a cell that is numbered the other way round, or turned inside out there.
    """
    x = points[nodes]  # [cells, nodes, D]
    corners = []
    for corner, neighbours in enumerate(kind.edges):
        edges = [x[:, n] - x[:, corner] for n in neighbours]
        with np.errstate(all="ignore"):  # flat cells, and lengths whose product is out of range
            corners.append(np.linalg.det(np.stack(edges, axis=1)))
    return np.asarray(np.min(corners, axis=0))
