"""Edges that touch facets between their nodes, where one of the two is of second order."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.contact.edges import edges
from carom.auditing.model import AuditModel
from carom.auditing.steps.contacts import BETWEEN_NODES
from carom.auditing.steps.place import Place
from carom.auditing.targets.feet import Feet

PARTS = 16
"""Points of an edge that may touch cut it into so many parts."""

Stencil = list[tuple[int, float]]


def between_nodes(
    model: AuditModel,
    source: tuple[int, int],
    number: int,
    position: Array,
    known: tuple[Indices, Array, int] | None,
) -> list[Place]:
    """Return the places of points of edges on the facets of a body.

    Parameters
    ----------
    model, position
        The model, and where its nodes are [m], shape [node_count, 3].
    source
        The body of the edges, and the node that takes most of what presses on them.
    number
        The body whose facets they are before.
    known
        If given, nodes and weights of the only point that counts, and its facet.
    """
    span, target = model.bodies[number].span, model.targets[number]
    stencils = _points(model, source) if known is None else [_nonzero(*known[:2])]
    if not stencils:
        return []
    at = np.array([_point(stencil, position) for stencil in stencils])
    feet = target.feet(at, position[span])
    drawn = np.array([_point(stencil, model.points) for stencil in stencils])
    depths = np.maximum(-target.signed_distance(drawn, model.points[span]), 0.0)
    rows = np.arange(len(feet.gap))
    if known is not None and (feet.facet == known[2]).any():
        rows = np.flatnonzero(feet.facet == known[2])
    return [
        _place(
            feet, int(row), stencils[feet.point[row]], span.start, float(depths[feet.point[row]])
        )
        for row in rows
    ]


def _points(model: AuditModel, source: tuple[int, int]) -> list[Stencil]:
    """Return what the points of edges follow of which a node takes most."""
    body, node = source
    own = edges(model.bodies[body])
    own = own[(np.column_stack([own.ends, own.far]) == node).any(axis=1)]
    points = [own.stencil(k, j / PARTS) for k in range(len(own)) for j in range(1, PARTS)]
    return [
        stencil for stencil in points if Place(0.0, np.zeros(3), sources=stencil).named_by(node)
    ]


def _place(feet: Feet, row: int, stencil: Stencil, first: int, depth: float) -> Place:
    followed = zip(feet.nodes[row], feet.weights[row], strict=True)
    return Place(
        gap=float(feet.gap[row]),
        normal=feet.normal[row],
        site=BETWEEN_NODES,
        facet=int(feet.facet[row]),
        depth=depth if np.isfinite(depth) else 0.0,
        sources=stencil,
        followed=[(int(node) + first, float(weight)) for node, weight in followed],
    )


def _nonzero(nodes: Indices, weights: Array) -> Stencil:
    return [(int(n), float(w)) for n, w in zip(nodes, weights, strict=True) if w != 0.0]


def _point(stencil: Stencil, position: Array) -> Array:
    nodes, weights = zip(*stencil, strict=True)
    point: Array = np.array(weights) @ position[list(nodes)]
    return point
