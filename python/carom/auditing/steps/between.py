"""Edges that touch facets between their nodes, where one of the two is of second order."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.model import AuditModel
from carom.auditing.steps.place import Place
from carom.auditing.steps.sites import BETWEEN_NODES
from carom.auditing.targets.feet import Feet

Stencil = list[tuple[int, float]]


def between_nodes(
    model: AuditModel, stencil: Stencil, number: int, position: Array, *, resolves: bool
) -> list[Place]:
    """Return the places of a point of an edge on the facets of a body.

    Parameters
    ----------
    model, position
        The model, and where its nodes are [m], shape [node_count, 3].
    stencil
        What the point follows.
    number
        The body whose facets it is before.
    resolves
        Whether overlaps are being taken up, so that it matters how deep it was as drawn.
    """
    span, target = model.bodies[number].span, model.targets[number]
    feet = target.feet(_point(stencil, position)[None], position[span])
    depth = 0.0
    if resolves:
        drawn = target.signed_distance(_point(stencil, model.points)[None], model.points[span])
        depth = max(-float(drawn[0]), 0.0)
    return [_place(feet, row, stencil, span.start, depth) for row in range(len(feet.gap))]


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


def _point(stencil: Stencil, position: Array) -> Array:
    nodes, weights = zip(*stencil, strict=True)
    point: Array = np.array(weights) @ position[list(nodes)]
    return point
