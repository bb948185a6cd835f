"""Kinds of cells and facets: their nodes, shape functions and sides.

The shape functions of a kind are the polynomials that are 1 at one node and 0 at the others. They
follow from its nodes and from the monomials that they are made of, and from nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.errors import InputError


@dataclass(frozen=True)
class Kind:
    """A kind of cell or facet over its reference domain.

    Simplices have their corners at the origin and the unit vectors, squares and cubes at ±1; a
    wedge is a triangle that goes from −1 to 1.

    Parameters
    ----------
    name
        Its name in the case file, or that of a facet.
    vtk_type
        Its number in VTK.
    nodes
        Reference coordinates of the nodes, in VTK's order, shape [a, d].
    powers
        Exponents of the monomials, shape [a, d].
    sides
        Corners of its sides, in the right-handed sense as seen from outside; in the plane with the
        cell on their left.
    """

    name: str
    vtk_type: int
    nodes: Array
    powers: Indices
    sides: tuple[tuple[int, ...], ...] = ()

    @property
    def dimension(self) -> int:
        """Dimension of the reference domain."""
        return int(self.nodes.shape[1])

    @property
    def degree(self) -> int:
        """1 or 2."""
        return int(self.powers.max())

    @property
    def is_simplex(self) -> bool:
        """Whether the domain is a triangle or a tetrahedron."""
        return self.dimension > 1 and bool((self.nodes >= 0).all())

    @property
    def is_wedge(self) -> bool:
        """Whether the domain is a triangle times a segment."""
        return self.dimension == 3 and self.corner_count == 6

    @property
    def corner_count(self) -> int:
        """Number of corners, the nodes that come first."""
        return 1 + max((max(side) for side in self.sides), default=1)

    @property
    def middle(self) -> Array:
        """The middle of the domain, shape [d]."""
        middle: Array = self.nodes[: self.corner_count].mean(axis=0)
        return middle

    @cached_property
    def _combined(self) -> Array:
        """What the shape functions have of each monomial, shape [monomial, a]."""
        # Rounded, as all of them are eighths.
        combined: Array = np.rint(8 * np.linalg.inv(_monomials(self.nodes, self.powers))) / 8
        return combined

    def values(self, at: Array) -> Array:
        """Return N_a at reference points, shape [..., d], shape [..., a]."""
        values: Array = _monomials(at, self.powers) @ self._combined
        return values

    def slopes(self, at: Array) -> Array:
        """Return ∂N_a/∂ξ at reference points, shape [..., a, d]."""
        parts = []
        for axis in range(self.dimension):
            power = self.powers[:, axis]
            lower = self.powers.copy()
            lower[:, axis] = np.maximum(power - 1, 0)
            parts.append((power * _monomials(at, lower)) @ self._combined)
        return np.stack(parts, axis=-1)

    @cached_property
    def facets(self) -> Indices:
        """Nodes of the sides, in the order of the kind of the sides, shape [side, a].

        Sides that have fewer nodes than others end with their first one.
        """
        sides = [self._nodes_on(corners) for corners in self.sides]
        widest = max(map(len, sides))
        return np.array([side + side[:1] * (widest - len(side)) for side in sides])

    def _nodes_on(self, corners: tuple[int, ...]) -> list[int]:
        """Return the nodes of a side: its corners, middles of its edges, and its middle."""
        places = [self.nodes[corner] for corner in corners]
        edges = list(zip(places, [*places[1:], places[0]], strict=True))
        middles = [0.5 * (a + b) for a, b in edges[: 1 if len(corners) == 2 else None]]
        if len(corners) == 4:
            middles.append(np.mean(places, axis=0))
        found = (np.flatnonzero((self.nodes == middle).all(axis=1)) for middle in middles)
        return [*corners, *(int(node) for nodes in found for node in nodes)]


def kind_with(dimension: int, node_count: int) -> Kind:
    """Return the kind of a dimension with so many nodes; below three there is one for each."""
    return next(
        kind
        for kind in KINDS.values()
        if kind.dimension == dimension and len(kind.nodes) == node_count
    )


def kind_of(vtk_type: int, dimension: int) -> Kind:
    """Return the kind of cells of a VTK type and a dimension.

    Raises
    ------
    InputError
        The auditor does not know it, or it has another dimension.
    """
    for kind in KINDS.values():
        if (kind.vtk_type, kind.dimension) == (vtk_type, dimension):
            return kind
    raise InputError(f"cannot audit cells of VTK type {vtk_type} yet")


def _monomials(at: Array, powers: Indices) -> Array:
    """Return products of powers of coordinates, none above the second, shape [..., monomial]."""
    table: Array = np.ones((*np.shape(at)[:-1], len(powers)))
    for x, power in zip(np.moveaxis(at, -1, 0), powers.T, strict=True):
        table *= np.stack([np.ones_like(x), x, x * x], axis=-1)[..., power]
    return table


def _powers(dimension: int, degree: int, keep: str) -> Indices:
    """Return the exponents of the monomials up to a degree.

    They are "complete" up to it in sum, of it in every "direction", or "serendipity": of these only
    those that are above the first degree in one direction at most.
    """
    every: Iterable[tuple[int, ...]] = product(range(degree + 1), repeat=dimension)
    if keep == "complete":
        every = [p for p in every if sum(p) <= degree]
    elif keep == "serendipity":
        every = [p for p in every if sum(k > 1 for k in p) <= 1]
    return np.array(list(every), dtype=np.int64)


def _swept(degree: int) -> Indices:
    """Return the exponents of a wedge: complete in the triangle, and to 1 along the segment.

    Those of the second degree along it have less than that in the triangle.
    """
    around = _powers(2, degree, "complete").tolist()
    powers = [(*p, k) for p in around for k in range(degree + 1) if k < 2 or sum(p) < 2]
    return np.array(powers, dtype=np.int64)


def _with_middles(corners: Array, edges: list[tuple[int, int]]) -> Array:
    return np.concatenate([corners, [0.5 * (corners[a] + corners[b]) for a, b in edges]])


_LINE = np.array([[-1.0], [1.0]])
_TRIANGLE = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
_TETRAHEDRON = np.concatenate([np.zeros((1, 3)), np.eye(3)])
_SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_CUBE = np.array([[x, y, z] for z in (-1.0, 1.0) for x, y in _SQUARE])

_AROUND_TRIANGLE = [(0, 1), (1, 2), (2, 0)]
_WEDGE = np.array([[*corner, z] for z in (-1.0, 1.0) for corner in _TRIANGLE])
_AROUND_SQUARE = [(0, 1), (1, 2), (2, 3), (3, 0)]
_UPRIGHT = [(0, 4), (1, 5), (2, 6), (3, 7)]
_OF_CUBE = [*_AROUND_SQUARE, *((a + 4, b + 4) for a, b in _AROUND_SQUARE), *_UPRIGHT]
_OF_TETRAHEDRON = [*_AROUND_TRIANGLE, (0, 3), (1, 3), (2, 3)]
_OF_WEDGE = [
    *_AROUND_TRIANGLE,
    *((a + 3, b + 3) for a, b in _AROUND_TRIANGLE),
    *((a, a + 3) for a in range(3)),
]
_CENTRE = [[0.0, 0.0]]
_SIDES = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1], [0, 0, 0]])
"""Centres of the sides of a cube, and its own."""

_TETRAHEDRON_SIDES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_CUBE_SIDES = (
    *((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4)),
    *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
)
_WEDGE_SIDES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))

_TRI6 = _with_middles(_TRIANGLE, _AROUND_TRIANGLE)
_QUAD8 = _with_middles(_SQUARE, _AROUND_SQUARE)
_TET10 = _with_middles(_TETRAHEDRON, _OF_TETRAHEDRON)
_HEX20 = _with_middles(_CUBE, _OF_CUBE)
_WEDGE15 = _with_middles(_WEDGE, _OF_WEDGE)

_TRIANGLE_SIDES = tuple(_AROUND_TRIANGLE)
_SQUARE_SIDES = tuple(_AROUND_SQUARE)

KINDS = {
    kind.name: kind
    for kind in (
        Kind("line2", 3, _LINE, _powers(1, 1, "direction")),
        Kind("line3", 21, _with_middles(_LINE, [(0, 1)]), _powers(1, 2, "direction")),
        Kind("tri3", 5, _TRIANGLE, _powers(2, 1, "complete"), _TRIANGLE_SIDES),
        Kind("tri6", 22, _TRI6, _powers(2, 2, "complete"), _TRIANGLE_SIDES),
        Kind("quad4", 9, _SQUARE, _powers(2, 1, "direction"), _SQUARE_SIDES),
        Kind("quad8", 23, _QUAD8, _powers(2, 2, "serendipity"), _SQUARE_SIDES),
        Kind(
            "quad9",
            28,
            np.concatenate([_QUAD8, _CENTRE]),
            _powers(2, 2, "direction"),
            _SQUARE_SIDES,
        ),
        Kind("tet4", 10, _TETRAHEDRON, _powers(3, 1, "complete"), _TETRAHEDRON_SIDES),
        Kind("tet10", 24, _TET10, _powers(3, 2, "complete"), _TETRAHEDRON_SIDES),
        Kind("wedge6", 13, _WEDGE, _swept(1), _WEDGE_SIDES),
        Kind("wedge15", 26, _WEDGE15, _swept(2), _WEDGE_SIDES),
        Kind("hex8", 12, _CUBE, _powers(3, 1, "direction"), _CUBE_SIDES),
        Kind("hex20", 25, _HEX20, _powers(3, 2, "serendipity"), _CUBE_SIDES),
        Kind(
            "hex27",
            29,
            np.concatenate([_HEX20, _SIDES.astype(np.float64)]),
            _powers(3, 2, "direction"),
            _CUBE_SIDES,
        ),
    )
}
"""All kinds by name."""
