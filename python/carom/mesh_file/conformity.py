"""Cells that lie side by side and do not hold together: pieces, and nodes that hang on a side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.display.counting import count
from carom.mesh_file.arrays import Indices, Note
from carom.mesh_file.cells import KINDS

NEAR = 1e-6
"""Distance, in diameters of a side, at which a node lies on it."""

_MIDDLES = {
    "triangle6": ((0, 1), (1, 2), (2, 0)),
    **dict.fromkeys(("quad8", "quad9"), ((0, 1), (1, 2), (2, 3), (3, 0))),
    "tetra10": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    "wedge15": (
        *((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)),
        *((0, 3), (1, 4), (2, 5)),
    ),
    **dict.fromkeys(
        ("hexahedron20", "hexahedron27"),
        (
            *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
            *((0, 4), (1, 5), (2, 6), (3, 7)),
        ),
    ),
}
"""Of cells of second order, the corners of the edges whose middles follow the corners."""

_REMEDY = (
    "merge the nodes and mesh the sides alike in the program that wrote the file, or make each "
    "piece a body of its own and tie them with cohesion = { unbreakable = true }"
)

Array = NDArray[np.float64]
Blocks = list[tuple[str, Indices]]


def comes_apart(points: Array, blocks: Blocks) -> list[Note]:
    """Return notes of pieces that share no node, and of nodes on sides of cells without them.

    Parameters
    ----------
    points
        Positions of the nodes [m], shape [point_count, D]; each belongs to a cell.
    blocks
        Kinds of cells, as meshio names them, and their nodes.
    """
    return [*_pieces(points, blocks), *_hanging(points, blocks)]


def _pieces(points: Array, blocks: Blocks) -> list[Note]:
    from scipy.sparse import coo_array  # noqa: PLC0415 (SciPy, which most runs do without)
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415

    first = np.concatenate([np.repeat(n[:, 0], n.shape[1] - 1) for _, n in blocks])
    others = np.concatenate([n[:, 1:].ravel() for _, n in blocks])
    graph = coo_array((np.ones(len(first)), (first, others)), shape=(len(points),) * 2)
    number, piece = connected_components(graph, directed=False)
    if number == 1:
        return []
    smallest = int(np.argmin(np.bincount(piece)))
    what = (
        f"its cells make {number:,} pieces that share no node, and nothing holds them together; "
        f"the smallest is at {_place(points[piece == smallest].mean(axis=0))}"
    )
    return [Note("mesh-in-pieces", what, value=number, allowed=1, remedy=_REMEDY, is_grave=True)]


def _hanging(points: Array, blocks: Blocks) -> list[Note]:
    hanging = np.union1d(_middles_alone(blocks, len(points)), _on_sides(points, blocks))
    if not len(hanging):
        return []
    what = (
        f"{count(len(hanging), 'node')} on the inside of sides of cells that do not have them, as "
        f"at {_place(points[hanging[0]])}: the cells come apart there"
    )
    return [
        Note("hanging-nodes", what, value=len(hanging), allowed=0, remedy=_REMEDY, is_grave=True)
    ]


def _middles_alone(blocks: Blocks, total: int) -> Indices:
    """Return the middles of edges that another cell has without a middle."""
    edges, middles = [], []
    for name, nodes in blocks:
        corners, with_middles = KINDS[name].edges, _MIDDLES.get(name)
        # A tetrahedron names the neighbours of one corner, and of a plane cell each edge twice.
        pairs = with_middles or (
            tuple((a, b) for a in range(4) for b in range(a))
            if name == "tetra"
            else tuple({(min(a, b), max(a, b)) for a, bs in enumerate(corners) for b in bs})
        )
        for number, pair in enumerate(pairs):
            edges.append(np.sort(nodes[:, pair], axis=1))
            has = nodes[:, _corner_count(name) + number] if with_middles else None
            middles.append(np.full(len(nodes), -1) if has is None else has)
    if not any(name in _MIDDLES for name, _ in blocks):
        return np.zeros(0, dtype=np.int64)
    both = np.concatenate(edges)
    key, middle = both[:, 0] * total + both[:, 1], np.concatenate(middles)
    plain = np.unique(key[middle < 0])
    return np.unique(middle[(middle >= 0) & np.isin(key, plain)])


def _corner_count(name: str) -> int:
    return 1 + max(corner for side in KINDS[name].sides for corner in side)


def _on_sides(points: Array, blocks: Blocks) -> Indices:
    """Return the corners of boundary sides that lie on other boundary sides, at no corner."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (SciPy, which most runs do without)

    sides = _boundary(blocks, len(points))
    nodes = np.unique(np.concatenate([side.ravel() for side in sides]))
    tree = cKDTree(points[nodes])
    found = []
    for side in sides:
        x = points[side]  # [sides, corners, D]
        centres = x.mean(axis=1)
        size = 2.0 * np.linalg.norm(x - centres[:, None], axis=2).max(axis=1)
        near = tree.query_ball_point(centres, 0.5 * size * (1.0 + NEAR))
        owner = np.repeat(np.arange(len(side)), [len(n) for n in near])
        which = nodes[np.concatenate([np.asarray(n, dtype=np.int64) for n in near])]
        others = ~(side[owner] == which[:, None]).any(axis=1)
        owner, which = owner[others], which[others]
        place, reach = points[which], NEAR * size[owner]
        at_corner = (np.linalg.norm(x[owner] - place[:, None], axis=2) <= reach[:, None]).any(1)
        on = _distance(place, x[owner]) <= reach
        found.append(which[on & ~at_corner])
    return np.unique(np.concatenate(found))


def _boundary(blocks: Blocks, total: int) -> list[Indices]:
    """Return the corners of the sides that one cell alone has, by how many corners they have."""
    by_corners: dict[int, list[Indices]] = {}
    for name, nodes in blocks:
        for side in KINDS[name].sides:
            by_corners.setdefault(len(side), []).append(nodes[:, side])
    # The sum of random numbers of its corners tells a side, in whichever order they are.
    marks = np.random.default_rng(0).integers(0, 2**63, size=total, dtype=np.uint64)
    found = []
    for parts in by_corners.values():
        sides = np.concatenate(parts)
        _, first, times = np.unique(
            marks[sides].sum(axis=1, dtype=np.uint64), return_index=True, return_counts=True
        )
        found.append(sides[np.sort(first[times == 1])])
    return found


def _distance(place: Array, corners: Array) -> Array:
    """Return how far points are from segments, triangles or quadrilaterals [m], shape [n].

    Parameters
    ----------
    place
        The points [m], shape [n, D].
    corners
        Corners of the side of each [m], shape [n, 2, 3 or 4, D].
    """
    if corners.shape[1] == 4:
        parts = (corners[:, [0, 1, 2]], corners[:, [0, 2, 3]])
        return np.minimum(*(_distance(place, part) for part in parts))
    start = corners[:, 0]
    arms = corners[:, 1:] - start[:, None]  # [n, d, D]
    gram = np.einsum("nai,nbi->nab", arms, arms)
    right = np.einsum("nai,ni->na", arms, place - start)
    flat = np.linalg.det(gram) <= 0.0
    gram[flat] = np.eye(arms.shape[1])
    share = np.linalg.solve(gram, right[..., None])[..., 0]
    # What is beyond a border is of another side, or on an edge, where round-off is what puts it.
    beyond = np.maximum(0.0, -share).max(axis=1) + np.maximum(0.0, share.sum(axis=1) - 1.0)
    foot = start + np.einsum("na,nai->ni", share, arms)
    distance = np.linalg.norm(place - foot, axis=1)
    distance[(beyond > NEAR) | flat] = np.inf
    return np.asarray(distance)


def _place(at: Array) -> str:
    return f"({', '.join(f'{x:.4g}' for x in at)})"
