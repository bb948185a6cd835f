"""Facets and edges that are large beside something round touch it between their nodes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.body import AuditBody
from carom.auditing.contact.edges import edges
from carom.auditing.contact.obstacles import Round, Shape
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

    @property
    def nodes(self) -> Indices:
        """Nodes of the facet or the edge that it is on."""
        return np.array([node for node, _ in self.stencil])


def nearest_places(
    shape: Shape, body: AuditBody, node: int, position: Array, known: Indices | None
) -> Iterator[NearestPlace]:
    """Yield the places of facets, or edges before a cylinder, around a node.

    Parameters
    ----------
    shape
        The obstacle where it is drawn.
    body, node
        A body and one of its nodes.
    position
        Where its nodes are beside the obstacle as drawn [m], shape [node_count, 3].
    known
        If given, the nodes of the only facet or edge that counts.
    """
    if not isinstance(shape, Round) or shape.sign < 0:
        return
    if shape.has_axis:
        around = edges(body).numbered_from(-body.span.start).at(node).ends
        for a, b in around if known is None else known[None, :2]:
            offsets = shape.offsets(position[[a, b]])
            across = offsets[1] - offsets[0]
            square = float(across @ across)
            s = float(np.clip(-(across @ offsets[0]) / square, 0.0, 1.0)) if square > 0 else 0.0
            place = position[a] + s * (position[b] - position[a])
            yield _at(shape, place, [(int(a), 1.0 - s), (int(b), s)])
        return
    facets = body.facets[(body.facets == node).any(axis=1)]
    if known is not None:
        facets = body.facets[np.isin(body.facets, known).all(axis=1)]
    for facet in facets:
        sheet = Sheet(FlatPatches(facet[None]))
        weights = sheet.closest_weights(shape.centre, position)
        stencil = [(int(n), float(w)) for n, w in zip(facet, weights, strict=True)]
        yield _at(shape, weights @ position[facet], stencil)


def _at(shape: Round, place: Array, stencil: list[tuple[int, float]]) -> NearestPlace:
    gap, normal = shape.nearest(place[None])
    return NearestPlace(float(gap[0]), normal[0], stencil)
