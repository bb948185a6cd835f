"""What of a mesh is seen: its cells in the plane, its boundary facets in space."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from carom.io.frames import Frames

Indices = NDArray[np.int64]

_PERIMETER = {
    5: (0, 1, 2),
    9: (0, 1, 2, 3),
    22: (0, 3, 1, 4, 2, 5),
    23: (0, 4, 1, 5, 2, 6, 3, 7),
    28: (0, 4, 1, 5, 2, 6, 3, 7),
}
"""Of cells of the plane by their VTK type: the nodes around, with those on the edges."""

_TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_HEXAHEDRON = (
    (0, 3, 2, 1),
    (4, 5, 6, 7),
    (0, 1, 5, 4),
    (1, 2, 6, 5),
    (2, 3, 7, 6),
    (3, 0, 4, 7),
)
_WEDGE = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
_TETRAHEDRON_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
_HEXAHEDRON_EDGES = (
    *((0, 1), (1, 2), (2, 3), (0, 3), (4, 5), (5, 6), (6, 7), (4, 7)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)
_WEDGE_EDGES = (
    *((0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5)),
    *((0, 3), (1, 4), (2, 5)),
)


def _second_order(
    faces: Sequence[Sequence[int]], edges: Sequence[tuple[int, int]], corners: int
) -> tuple[tuple[int, ...], ...]:
    """Return faces with the nodes on their edges, which VTK numbers after the corners."""
    middle = {frozenset(edge): corners + index for index, edge in enumerate(edges)}
    return tuple(
        tuple(
            node
            for a, b in zip(face, (*face[1:], face[0]), strict=True)
            for node in (a, middle[frozenset((a, b))])
        )
        for face in faces
    )


_FACES = {
    10: _TETRAHEDRON,
    12: _HEXAHEDRON,
    13: _WEDGE,
    24: _second_order(_TETRAHEDRON, _TETRAHEDRON_EDGES, 4),
    25: _second_order(_HEXAHEDRON, _HEXAHEDRON_EDGES, 8),
    26: _second_order(_WEDGE, _WEDGE_EDGES, 6),
    29: _second_order(_HEXAHEDRON, _HEXAHEDRON_EDGES, 8),
}
"""Of cells in space by their VTK type: the perimeter of each face."""

_LINES = {3: (0, 1), 21: (0, 2, 1)}
"""Facets of the plane by their VTK type: the nodes along."""


@dataclass(frozen=True)
class Outline:
    """The faces that are drawn, by the numbers of the points that they need.

    Parameters
    ----------
    dimension
        2 or 3.
    points
        Numbers in the file of the points that are needed, shape [point_count].
    cell
        The cell that each face shows, shape [face_count].
    body
        The body of each face, shape [face_count].
    around
        The points around each face, shape [face_count, most]; where there are fewer the last is
        repeated.
    triangles
        Corners of the triangles into which faces are cut, shape [triangle_count, 3].
    face
        The face of each triangle, shape [triangle_count].
    edges
        Ends of the edges between faces, shape [edge_count, 2].
    rim
        Ends of the edges where bodies of the plane end, shape [rim_count, 2].
    facets
        For every face in space, for every rim edge in the plane, the facet of ``surface.vtkhdf``
        that it lies on, or -1.
    """

    dimension: int
    points: Indices
    cell: Indices
    body: Indices
    around: Indices
    triangles: Indices
    face: Indices
    edges: Indices
    rim: Indices
    facets: Indices


def outline(frames: Frames, surface: Frames | None) -> Outline:
    """Return what is drawn of a mesh; `surface` tells which facet of that file is where."""
    cells = np.split(frames.connectivity, frames.offsets[1:-1])
    in_space = bool(np.isin(frames.types, list(_FACES)).any())
    faces = list(_boundary(cells, frames.types) if in_space else _plane(cells, frames.types))
    perimeters = [perimeter for _, perimeter in faces]
    owner = np.array([cell for cell, _ in faces], dtype=np.int64)

    triangles: list[tuple[int, int, int]] = []
    face: list[int] = []
    for index, perimeter in enumerate(perimeters):
        cut = list(_cut(perimeter))
        triangles += cut
        face += [index] * len(cut)
    edges, count = _edges(perimeters)
    rim = edges[count == 1] if not in_space else np.empty((0, 2), dtype=np.int64)
    shown = perimeters if in_space else rim.tolist()

    needed = np.unique(np.concatenate([np.asarray(p, dtype=np.int64) for p in perimeters]))
    renumber = np.full(len(frames.points), -1, dtype=np.int64)
    renumber[needed] = np.arange(len(needed))
    return Outline(
        dimension=3 if in_space else 2,
        points=needed,
        cell=owner,
        body=np.asarray(frames.body, dtype=np.int64)[owner],
        around=renumber[_padded(perimeters)],
        triangles=renumber[np.array(triangles, dtype=np.int64)],
        face=np.array(face, dtype=np.int64),
        edges=renumber[edges],
        rim=renumber[rim],
        facets=_facets(shown, surface),
    )


def _plane(cells: Sequence[Indices], types: NDArray[np.uint8]) -> Iterator[tuple[int, list[int]]]:
    """Yield the cells of the plane and the nodes around them."""
    for index, (nodes, kind) in enumerate(zip(cells, types.tolist(), strict=True)):
        if (perimeter := _PERIMETER.get(kind)) is not None:
            yield index, nodes[list(perimeter)].tolist()


def _boundary(
    cells: Sequence[Indices], types: NDArray[np.uint8]
) -> Iterator[tuple[int, list[int]]]:
    """Yield the faces that only one cell has, with that cell."""
    seen: dict[tuple[int, ...], tuple[int, list[int]] | None] = {}
    for index, (nodes, kind) in enumerate(zip(cells, types.tolist(), strict=True)):
        numbers = nodes.tolist()
        for local in _FACES.get(kind, ()):
            perimeter = [numbers[node] for node in local]
            key = tuple(sorted(perimeter))
            seen[key] = None if key in seen else (index, perimeter)
    yield from (face for face in seen.values() if face is not None)


def _cut(perimeter: Sequence[int]) -> Iterator[tuple[int, int, int]]:
    """Cut a face into triangles; one of second order at its edges' middles first."""
    if len(perimeter) > 4:
        count = len(perimeter)
        for corner in range(0, count, 2):
            yield perimeter[corner - 1], perimeter[corner], perimeter[corner + 1]
        perimeter = perimeter[1::2]
    for index in range(1, len(perimeter) - 1):
        yield perimeter[0], perimeter[index], perimeter[index + 1]


def _padded(perimeters: Sequence[Sequence[int]]) -> Indices:
    """Return perimeters as the rows of a table, the last node repeated where there are fewer."""
    most = max(map(len, perimeters), default=0)
    rows = [[*nodes, *[nodes[-1]] * (most - len(nodes))] for nodes in perimeters]
    return np.array(rows, dtype=np.int64).reshape(-1, most)


def _edges(perimeters: Sequence[Sequence[int]]) -> tuple[Indices, Indices]:
    """Return every edge once, and how many faces have it."""
    ends = [
        pair for nodes in perimeters for pair in zip(nodes, (*nodes[1:], nodes[0]), strict=True)
    ]
    unique, count = np.unique(
        np.sort(np.array(ends, dtype=np.int64), axis=1), axis=0, return_counts=True
    )
    return unique, count


def _facets(shown: Sequence[Sequence[int]], surface: Frames | None) -> Indices:
    """Return for each shown face or edge the facet of the surface file with all its nodes."""
    if surface is None:
        return np.full(len(shown), -1, dtype=np.int64)
    known: dict[frozenset[int], int] = {}
    facets = np.split(surface.connectivity, surface.offsets[1:-1])
    for index, (nodes, kind) in enumerate(zip(facets, surface.types.tolist(), strict=True)):
        if (along := _LINES.get(kind)) is not None:
            ordered = nodes[list(along)].tolist()
            for pair in pairwise(ordered):
                known[frozenset(pair)] = index
        elif (perimeter := _PERIMETER.get(kind)) is not None:
            known[frozenset(nodes[list(perimeter)].tolist())] = index
    return np.array([known.get(frozenset(nodes), -1) for nodes in shown], dtype=np.int64)
