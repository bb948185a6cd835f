"""Facets and edges that are large beside something round touch it between their nodes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.body import AuditBody
from carom.auditing.contact.edges import edges
from carom.auditing.contact.obstacles import Round
from carom.auditing.targets.sheet import FlatPatches, Sheet


@dataclass(frozen=True)
class NearestPlace:
    """Where a facet or an edge is nearest to the middle of something round.

    Parameters
    ----------
    gap, normal
        Gap there [m] and the normal, shape [3].
    stencil
        Nodes of the body, and how much of the place each is.
    """

    gap: float
    normal: Array
    stencil: list[tuple[int, float]]


def nearest_place(shape: Round, nodes: Indices, position: Array) -> NearestPlace:
    """Return the place of a facet, or an edge before a cylinder.

    Parameters
    ----------
    shape
        The obstacle where it is drawn.
    nodes
        Those of the facet or the edge.
    position
        Where the nodes of its body are beside the obstacle as drawn [m], shape [node_count, 3].
    """
    if len(nodes) == 2:
        a, b = nodes.tolist()
        offsets = shape.offsets(position[[a, b]])
        across = offsets[1] - offsets[0]
        square = float(across @ across)
        s = float(np.clip(-(across @ offsets[0]) / square, 0.0, 1.0)) if square > 0 else 0.0
        place = position[a] + s * (position[b] - position[a])
        return _at(shape, place, [(a, 1.0 - s), (b, s)])
    weights = Sheet(FlatPatches(nodes[None])).closest_weights(shape.centre, position)
    stencil = [(int(n), float(w)) for n, w in zip(nodes, weights, strict=True)]
    return _at(shape, weights @ position[nodes], stencil)


def faces_before(shape: Round, body: AuditBody) -> Iterator[Indices]:
    """Yield the facets of a body, or edges before a cylinder, by their nodes; none in a hole."""
    if shape.sign > 0:
        yield from (
            edges(body).numbered_from(-body.span.start).ends if shape.has_axis else body.facets
        )


def _at(shape: Round, place: Array, stencil: list[tuple[int, float]]) -> NearestPlace:
    gap, normal = shape.nearest(place[None])
    return NearestPlace(float(gap[0]), normal[0], stencil)
