"""Where bodies touch obstacles with corners: at nodes, at corners, and where edges cross."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.bodies.body import AuditBody
from carom.auditing.contact.crossings import crossings, drawn_depths
from carom.auditing.contact.edges import Edges, edges
from carom.auditing.contact.obstacles import Cornered
from carom.auditing.steps.contacts import AT_CORNER, AT_EDGES
from carom.auditing.steps.place import Place
from carom.auditing.targets.feet import BEYOND, Target

ON_END = 1e-9
"""Feet this close to the end of what a facet reaches, in facets, are there."""


def on_obstacle(shape: Cornered, shift: Array, node: int, position: Array) -> list[Place]:
    """Return the feet of a node on the facets of an obstacle that has moved by a shift [m].

    Nodes are at `position` [m], shape [node_count, D].
    """
    feet = shape.target.feet(position[[node]] - shift, shape.corners)
    return [
        Place(
            gap=float(feet.gap[foot]),
            normal=feet.normal[foot],
            facet=int(feet.facet[foot]),
            clamped=bool(feet.beyond[foot] >= BEYOND - ON_END),
            sources=[(node, 1.0)],
        )
        for foot in range(len(feet.gap))
    ]


def at_corners(
    shape: Cornered, shift: Array, body: AuditBody, target: Target, position: Array
) -> list[Place]:
    """Return where the corners of an obstacle are on the boundary of a body, its `target`."""
    feet = target.feet(shape.corners + shift, position[body.span])
    depths = np.maximum(-target.signed_distance(shape.corners, body.points), 0.0)
    return [
        Place(
            gap=float(feet.gap[foot]),
            normal=-feet.normal[foot],
            site=AT_CORNER,
            facet=int(feet.facet[foot]),
            depth=float(depths[feet.point[foot]]),
            sources=[
                (int(node) + body.span.start, float(weight))
                for node, weight in zip(feet.nodes[foot], feet.weights[foot], strict=True)
            ],
        )
        for foot in range(len(feet.gap))
    ]


def at_edges(
    shape: Cornered, shift: Array, source: tuple[AuditBody, int], position: Array, towards: Array
) -> list[Place]:
    """Return where edges around a node of a body cross those of an obstacle in space.

    Normals point along `towards` as nearly as they can.
    """
    body, node = source
    mine = edges(body).at(node)
    theirs = Edges.straight(shape.edges).numbered_from(len(position))
    places = np.concatenate([position, shape.corners + shift])
    found = crossings(places, mine, theirs, towards)
    drawn = np.concatenate([body.points, shape.corners])
    depths = drawn_depths(drawn, found, (body.span.start, len(position) - len(body.points)))
    return [
        Place(
            gap=float(found.gap[k]),
            normal=found.normal[k],
            site=AT_EDGES,
            depth=float(depths[k]),
            sources=found.source.stencil(int(k), float(found.along[k, 0])),
        )
        for k in np.flatnonzero(np.isfinite(found.gap))
    ]
