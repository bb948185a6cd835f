"""Boundaries of bodies as segments or triangles, and the exact distances between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_PIECES = {
    3: ((0, 1),),
    21: ((0, 2), (2, 1)),
    5: ((0, 1, 2),),
    9: ((0, 1, 2), (0, 2, 3)),
    22: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    23: ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)),
    28: (
        *((0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8)),
        *((8, 5, 2), (8, 2, 6), (7, 8, 6), (7, 6, 3)),
    ),
}
"""Of facets by their VTK type: segments or triangles between their nodes, in their sense."""

_FAR = 10.0
"""Distance, in lengths of the longest edges, from which nodes alone say it to a percent."""

_AT_ONCE = 200_000
"""Pairs of triangles that are looked at together, which bounds the memory."""


@dataclass(frozen=True)
class Boundary:
    """A boundary of straight pieces.

    Parameters
    ----------
    points
        Its nodes [m], shape [point_count, D].
    pieces
        Segments that run with the body on their left, or triangles seen from outside, shape
        [piece_count, D].
    """

    points: Array
    pieces: Indices

    def at(self, points: Array) -> Boundary:
        """Return the same boundary with its nodes elsewhere."""
        return Boundary(points, self.pieces)

    @cached_property
    def corners(self) -> Array:
        """Positions of the corners of the pieces [m], shape [piece_count, D, D]."""
        return self.points[self.pieces]

    @cached_property
    def centres(self) -> Array:
        """Means of the corners [m], shape [piece_count, D]."""
        return np.asarray(self.corners.mean(axis=1))

    @cached_property
    def radii(self) -> Array:
        """How far the corners are from the centre [m], shape [piece_count]."""
        arms = np.linalg.norm(self.corners - self.centres[:, None], axis=2)
        return np.asarray(arms.max(axis=1))


def boundaries(
    surface: dict[str, Any], points: Array, bodies: int
) -> list[tuple[Boundary, Indices]]:
    """Return the boundary of each body, and which points of the model its points are.

    Parameters
    ----------
    surface
        What the native simulation says of its surface.
    points
        Positions of all nodes [m], shape [node_count, D].
    bodies
        How many there are.
    """
    facets = np.split(surface["connectivity"], surface["offsets"][1:-1])
    found = []
    for index in range(bodies):
        pieces = [
            facets[f][list(piece)]
            for f in np.flatnonzero(surface["body"] == index)
            for piece in _PIECES[int(surface["types"][f])]
        ]
        dimension = points.shape[1]
        nodes = np.array(pieces, dtype=np.int64).reshape(-1, dimension)
        used, local = np.unique(nodes, return_inverse=True)
        found.append((Boundary(points[used], local.reshape(-1, dimension)), used))
    return found


def distance(one: Boundary, other: Boundary) -> tuple[float, Array]:
    """Return the distance of two boundaries [m], 0 where they cross, and a place where it is.

    From ten edges' length on it is that of the nearest nodes, which is more by a percent at most.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 (SciPy, which most runs do without)

    reach, number = cKDTree(other.points).query(one.points)
    nearest = int(np.argmin(reach))
    least = float(reach[nearest])
    place = 0.5 * (one.points[nearest] + other.points[number[nearest]])
    longest = 2.0 * (one.radii.max() + other.radii.max())
    if least > _FAR * longest:
        return least, place
    near_one = _near(one, cKDTree(other.points), least + 2.0 * other.radii.max())
    near_other = _near(other, cKDTree(one.points), least + 2.0 * one.radii.max())
    within = least + one.radii[near_one].max() + other.radii[near_other].max()
    tree = cKDTree(other.centres[near_other])
    lists = tree.query_ball_point(one.centres[near_one], within)
    first = np.repeat(near_one, [len(found) for found in lists])
    second = near_other[np.concatenate([np.asarray(found, dtype=np.int64) for found in lists])]
    between = np.linalg.norm(one.centres[first] - other.centres[second], axis=1)
    close = between <= least + one.radii[first] + other.radii[second]
    first, second = first[close], second[close]
    for start in range(0, len(first), _AT_ONCE):
        chunk = slice(start, start + _AT_ONCE)
        gaps, places = _between(one.corners[first[chunk]], other.corners[second[chunk]])
        nearest = int(np.argmin(gaps))
        if gaps[nearest] < least:
            least, place = float(gaps[nearest]), places[nearest]
    return least, place


def to_point(boundary: Boundary, point: Array) -> float:
    """Return the distance of a boundary from a point [m]."""
    gaps = np.linalg.norm(_nearest(point, boundary.corners) - point, axis=1)
    return float(gaps.min())


def pieces_at(boundary: Boundary, point: Array) -> Indices:
    """Return the pieces that a point on the boundary is on: several at an edge or a corner."""
    near = np.flatnonzero(
        np.linalg.norm(boundary.centres - point, axis=1) <= 1.001 * boundary.radii
    )
    gaps = np.linalg.norm(_nearest(point, boundary.corners[near]) - point, axis=1)
    return np.asarray(near[gaps <= 1e-9 * boundary.radii[near]])


def behind(points: Array, boundary: Boundary, deepest: float) -> tuple[Indices, Array]:
    """Return which points are behind a boundary, though not deep, and where on it they belong.

    Parameters
    ----------
    points
        Positions [m], shape [count, D].
    boundary
        That of the other body.
    deepest
        How far behind it they may be [m].
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 (SciPy, which most runs do without)

    lists = cKDTree(boundary.centres).query_ball_point(points, boundary.radii.max() + deepest)
    found, feet = [], []
    for index, pieces in enumerate(lists):
        if not pieces:
            continue
        corners = boundary.corners[pieces]
        feet_of = _nearest(points[index], corners)
        arms = points[index] - feet_of
        lengths = np.linalg.norm(arms, axis=1)
        # Pieces that share the nearest corner: the one seen most squarely decides the side.
        tied = np.flatnonzero(lengths <= lengths.min() * (1.0 + 1e-9))
        fronts = np.einsum("ij,ij->i", arms[tied], _normals(corners[tied]))
        front = fronts[np.argmax(np.abs(fronts))]
        if front < 0.0 and lengths.min() <= deepest:
            found.append(index)
            feet.append(feet_of[tied[0]])
    return np.array(found, dtype=np.int64), np.reshape(feet, (-1, points.shape[1]))


def _near(boundary: Boundary, nodes: Any, within: float) -> Indices:  # noqa: ANN401 (no types)
    """Return the pieces that may be so near to the surface of which these are the nodes [m]."""
    reach, _ = nodes.query(boundary.centres)
    return np.flatnonzero(reach <= within + boundary.radii)


def _normals(corners: Array) -> Array:
    """Return unit normals that look outward, zero of pieces without length."""
    if corners.shape[1] == 2:
        along = corners[:, 1] - corners[:, 0]
        normals = np.stack([along[:, 1], -along[:, 0]], axis=1)
    else:
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(lengths > 0.0, lengths, 1.0))


def _between(one: Array, other: Array) -> tuple[Array, Array]:
    """Return distances of pairs of segments or triangles, and places where they are."""
    gaps, places = [], []
    corners = range(one.shape[1])
    edges = list(combinations(corners, 2))
    for a, b in edges:
        for c, d in edges:
            p, q = _nearest_of_segments(one[:, a], one[:, b], other[:, c], other[:, d])
            gaps.append(np.linalg.norm(p - q, axis=1))
            places.append(0.5 * (p + q))
    if one.shape[1] == 3:
        for these, those in ((one, other), (other, one)):
            for corner in corners:
                feet = _nearest(these[:, corner], those)
                gaps.append(np.linalg.norm(these[:, corner] - feet, axis=1))
                places.append(0.5 * (these[:, corner] + feet))
            for a, b in edges:
                pierced, at = _pierced(these[:, a], these[:, b], those)
                gaps.append(np.where(pierced, 0.0, np.inf))
                places.append(at)
    best = np.argmin(gaps, axis=0)
    rows = np.arange(len(one))
    return np.array(gaps)[best, rows], np.array(places)[best, rows]


def _nearest(point: Array, corners: Array) -> Array:
    """Return the points of segments or triangles that are nearest to one point, or one each."""
    point = np.broadcast_to(point, corners[:, 0].shape)
    edges = [(0, 1)] if corners.shape[1] == 2 else [(0, 1), (1, 2), (2, 0)]
    feet = [_on_segment(point, corners[:, a], corners[:, b]) for a, b in edges]
    if corners.shape[1] == 3:
        normal = _normals(corners)
        foot = point - np.einsum("ij,ij->i", point - corners[:, 0], normal)[:, None] * normal
        inside = _is_in_triangle(foot, corners, normal)
        feet.append(np.where(inside[:, None], foot, np.inf))
    with np.errstate(invalid="ignore"):
        lengths = [np.linalg.norm(foot - point, axis=1) for foot in feet]
    return np.asarray(np.array(feet)[np.argmin(lengths, axis=0), np.arange(len(corners))])


def _on_segment(point: Array, start: Array, end: Array) -> Array:
    along = end - start
    square = np.einsum("ij,ij->i", along, along)
    at = np.einsum("ij,ij->i", point - start, along) / np.where(square > 0.0, square, 1.0)
    return np.asarray(start + np.clip(at, 0.0, 1.0)[:, None] * along)


def _is_in_triangle(point: Array, corners: Array, normal: Array) -> NDArray[np.bool_]:
    inside = np.einsum("ij,ij->i", normal, normal) > 0.5
    for a, b in ((0, 1), (1, 2), (2, 0)):
        side = np.cross(corners[:, b] - corners[:, a], point - corners[:, a])
        inside &= np.einsum("ij,ij->i", side, normal) >= 0.0
    return np.asarray(inside)


def _pierced(start: Array, end: Array, corners: Array) -> tuple[NDArray[np.bool_], Array]:
    """Return which segments go through triangles, and where they meet their planes."""
    normal = _normals(corners)
    before = np.einsum("ij,ij->i", start - corners[:, 0], normal)
    after = np.einsum("ij,ij->i", end - corners[:, 0], normal)
    change = before - after
    share = np.where(change != 0.0, before, 0.0) / np.where(change != 0.0, change, 1.0)
    at = start + share[:, None] * (end - start)
    return (before * after < 0.0) & _is_in_triangle(at, corners, normal), at


def _nearest_of_segments(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Return the nearest points of pairs of segments ab and cd.

    Inside of both where that is so (Ericson, Real-Time Collision Detection, 5.1.9), else one of
    the four ends and its foot on the other segment.
    """
    u, v, w = b - a, d - c, a - c
    uu, vv, uv = (np.einsum("ij,ij->i", x, y) for x, y in ((u, u), (v, v), (u, v)))
    uw, vw = np.einsum("ij,ij->i", u, w), np.einsum("ij,ij->i", v, w)
    determinant = uu * vv - uv * uv
    is_plain = determinant > 1e-12 * uu * vv  # parallel segments are nearest at an end too
    divisor = np.where(is_plain, determinant, 1.0)
    s, t = (uv * vw - vv * uw) / divisor, (uu * vw - uv * uw) / divisor
    inside = is_plain & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    pairs = [
        (a, _on_segment(a, c, d)),
        (b, _on_segment(b, c, d)),
        (_on_segment(c, a, b), c),
        (_on_segment(d, a, b), d),
        (a + s[:, None] * u, c + t[:, None] * v),
    ]
    lengths = np.array([np.linalg.norm(p - q, axis=1) for p, q in pairs])
    lengths[4, ~inside] = np.inf
    best, rows = np.argmin(lengths, axis=0), np.arange(len(a))
    first, second = (np.array([pair[k] for pair in pairs])[best, rows] for k in (0, 1))
    return first, second
