"""Which facets of two boundaries face one another, for mortar rows, and how much."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.targets.covering import Covering
from carom.auditing.targets.seen import View

OPPOSED = (0.5, 0.5**0.5)
"""Cosines: normals opposite to 60° begin to face one another, to 45° they do wholly."""

REACH = (0.25, 0.5)
"""Up to where facets apart face wholly, and where they end to, in parts of both diameters."""

DEPTH = (0.125, 0.25)
"""The same of one that is behind another, in diameters of the smaller."""


def facing_facets(
    source: Covering, target: Covering, positions: tuple[Array, Array]
) -> Iterator[tuple[int, list[int]]]:
    """Yield facets of the source, each with those of the target that it may face.

    Nodes of either are at these positions [m], shape [node_count, D].
    """
    (middles, rooms), (places, spaces) = (
        _balls(side, position) for side, position in zip((source, target), positions, strict=True)
    )
    apart = np.linalg.norm(middles[:, None] - places[None], axis=2)
    for facet, near in enumerate(apart <= rooms[:, None] + spaces):
        faced = np.flatnonzero(near).tolist()
        if faced:
            yield facet, faced


def diameter(nodes: Array) -> float:
    """Return the largest distance of two of the nodes of a facet [m], shape [a, D]."""
    return float(np.linalg.norm(nodes[:, None] - nodes[None], axis=2).max())


def share_by_angle(own: View, other: View) -> float:
    """Return how much planes face one another by their angle, from 0 to 1."""
    return _rise(-float(own.normal @ other.normal), OPPOSED)


def share_by_distance(own: View, other: View, sizes: tuple[float, float], common: Array) -> float:
    """Return how much they do by how far the other is before a plane or behind it, from 0 to 1.

    Parameters
    ----------
    own, other
        The planes, not at right angles.
    sizes
        The diameters of both facets [m].
    common
        The corners of what they have in common in the first plane [m], shape [count, D − 1].
    """
    heights = [own.height(other, point) for point in common]
    ahead = 1.0 - _rise(min(heights) / sum(sizes), REACH)
    return ahead * (1.0 - _rise(-max(heights) / min(sizes), DEPTH))


def _balls(side: Covering, position: Array) -> tuple[Array, Array]:
    """Return the middles of facets [m], shape [count, D], and how far each reaches."""
    nodes = [position[facet] for facet in side.facets]
    middles = np.array([x.mean(axis=0) for x in nodes])
    reach = [
        float(np.linalg.norm(x - middle, axis=1).max()) + REACH[1] * diameter(x)
        for x, middle in zip(nodes, middles, strict=True)
    ]
    return middles, np.array(reach)


def _rise(x: float, ends: tuple[float, float]) -> float:
    """Return what rises from 0 to 1 between two ends, level at both."""
    t = min(max((x - ends[0]) / (ends[1] - ends[0]), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)
