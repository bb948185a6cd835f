"""How deep contacts are inside as drawn, where overlaps are taken up."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.bodies.body import AuditBody
from carom.auditing.contact.crossings import Crossings, crossings
from carom.auditing.contact.edges import Edges, edges
from carom.auditing.contact.obstacles import Cornered, Round
from carom.auditing.contact.rounding import faces_before, nearest_place
from carom.auditing.mesh.facets import grouped
from carom.auditing.targets.feet import Target

BETWEEN = np.radians(6.0)
"""Normals between two others may be off by this: by three degrees on either side."""

ON = 1e-9
"""Feet that are beyond an edge by no more than this part of a facet are on it."""

Sides = dict[tuple[int, int], list[Array]]
"""Outward normals of the facets beside edges."""


def nodes_in(body: AuditBody, target: Target, position: Array) -> Array:
    """Return how deep nodes of a body that may touch are in a target as drawn [m], [source_count].

    It is before the closest of the facets that a node faces: that look against the mean normal of
    the node, where the foot is on them.

    Parameters
    ----------
    body
        The body.
    target, position
        What its nodes are checked against, and where the nodes of that are drawn [m].
    """
    faces = body.faces(body.facets)
    outward = np.zeros_like(body.points)
    for _, rows, nodes in faces.groups:
        for corner in nodes.T:
            np.add.at(outward, corner, faces.vectors(body.points)[rows])
    x = body.points[body.sources]
    feet = target.feet(x, position)
    normals = outward[body.sources][feet.point]
    faced = (einsum("ki,ki->k", feet.normal, normals) < 0.0) & (feet.beyond <= ON)
    depths: Array = np.full(len(body.sources), np.inf)
    behind = faced & (feet.gap < 0.0)
    np.minimum.at(depths, feet.point[behind], -feet.gap[behind])
    # What is beside the target is behind its far side; flush rims are on it.
    flush = ON * float(np.ptp(body.points, axis=0).max())
    outside: Mask = target.signed_distance(x, position) > flush
    outside[feet.point[faced & (feet.gap >= 0.0)]] = True
    return np.where(np.isfinite(depths) & ~outside, depths, 0.0)


def corners_in(body: AuditBody, target: Target, corners: Array) -> float:
    """Return how deep the deepest corner of an obstacle is in a body as drawn [m]."""
    gaps = target.signed_distance(corners, body.points)
    return float(np.maximum(-np.where(np.isfinite(gaps), gaps, 0.0), 0.0).max(initial=0.0))


def round_in(body: AuditBody, shape: Round) -> float:
    """Return how deep the deepest facet of a body, or edge, is in what is round as drawn [m]."""
    gaps = [nearest_place(shape, nodes, body.points).gap for nodes in faces_before(shape, body)]
    return max(-min(gaps, default=0.0), 0.0)


def crossed(body: AuditBody, other: AuditBody | Cornered) -> float:
    """Return how deep the deepest edges that cross in space are as drawn [m]."""
    mine = edges(body).numbered_from(-body.span.start)
    own = _beside(body.facets, body.points)
    if isinstance(other, Cornered):
        corners, theirs, their_own = (
            other.corners,
            Edges.straight(other.edges),
            _beside(other.facets, other.corners),
        )
    else:
        corners, theirs = other.points, edges(other).numbered_from(-other.span.start)
        their_own = _beside(other.facets, other.points)
    places = np.concatenate([body.points, corners])
    low, high = (
        np.maximum(body.points.min(axis=0), corners.min(axis=0)),
        np.minimum(body.points.max(axis=0), corners.max(axis=0)),
    )
    mine = _near(mine, body.points, low, high)
    theirs = _near(theirs, corners, low, high).numbered_from(len(body.points))
    found = crossings(places, mine, theirs, np.ones(3))
    deepest = 0.0
    for k in np.flatnonzero(np.isfinite(found.gap)):
        deepest = max(deepest, _depth(found, int(k), own, their_own, len(body.points)))
    return deepest


def _depth(found: Crossings, k: int, own: Sides, theirs: Sides, first: int) -> float:
    """Return how deep two edges are, zero of those that do not look at one another [m]."""
    source = own[_key(found.source.ends[k])]
    target = theirs[_key(found.target.ends[k] - first)]
    for sign in (1.0, -1.0):
        normal = sign * found.normal[k]
        if _is_between(normal, target) and _is_between(-normal, source):
            return max(-sign * float(found.gap[k]), 0.0)
    return 0.0


def _is_between(normal: Array, sides: list[Array]) -> bool:
    if len(sides) != 2:
        return False
    to = [np.arccos(np.clip(normal @ side, -1.0, 1.0)) for side in sides]
    apart = np.arccos(np.clip(sides[0] @ sides[1], -1.0, 1.0))
    return bool(sum(to) <= apart + BETWEEN)


def _key(ends: Indices) -> tuple[int, int]:
    a, b = sorted(ends.tolist())
    return a, b


def _beside(facets: Indices, points: Array) -> Sides:
    """Return the outward normals of the facets beside the lines from node to node around them."""
    found: Sides = defaultdict(list)
    for kind, _, nodes in grouped(facets, 3):
        middle = kind.slopes(kind.middle[None])[0]
        tangents = np.einsum("fai,ak->fki", points[nodes], middle)
        normals = np.cross(tangents[:, 0], tangents[:, 1])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        for facet, normal in zip(nodes, normals, strict=True):
            for side in kind.facets:
                ends = [side[:2]] if len(side) == 2 else [side[[0, 2]], side[[2, 1]]]
                for pair in ends:
                    found[_key(facet[pair])].append(normal)
    return found


def _near(lines: Edges, points: Array, low: Array, high: Array) -> Edges:
    """Return the edges whose boxes meet a box."""
    places = points[np.column_stack([lines.ends, lines.far])]
    meets = (places.min(axis=1) <= high) & (places.max(axis=1) >= low)
    return lines[meets.all(axis=1)]
