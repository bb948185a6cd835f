"""Where bodies touch obstacles with corners: at nodes, at corners, and where edges cross."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.body import AuditBody
from carom.auditing.contact.crossings import crossings, drawn_depths
from carom.auditing.contact.edges import Edges
from carom.auditing.contact.obstacles import Cornered
from carom.auditing.steps.place import Place
from carom.auditing.steps.sites import AT_CORNER, AT_EDGES
from carom.auditing.targets.feet import Target


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
            sources=[(node, 1.0)],
        )
        for foot in range(len(feet.gap))
    ]


def at_corner(
    shape: Cornered, shift: Array, corner: int, body: tuple[AuditBody, Target], position: Array
) -> list[Place]:
    """Return where a corner of an obstacle is on the boundary of a body, its target."""
    if corner >= len(shape.corners):
        return []
    own, target = body
    at = shape.corners[[corner]]
    feet = target.feet(at + shift, position[own.span])
    drawn = target.signed_distance(at, own.points)
    depth = max(-float(drawn[0]), 0.0)
    return [
        Place(
            gap=float(feet.gap[foot]),
            normal=-feet.normal[foot],
            site=AT_CORNER,
            facet=int(feet.facet[foot]),
            depth=depth,
            sources=[
                (int(node) + own.span.start, float(weight))
                for node, weight in zip(feet.nodes[foot], feet.weights[foot], strict=True)
            ],
        )
        for foot in range(len(feet.gap))
    ]


def at_edges(
    shape: Cornered,
    shift: Array,
    both: tuple[Edges, Indices],
    position: tuple[Array, Array],
    towards: Array,
) -> list[Place]:
    """Return where an edge crosses that of an obstacle that has moved by a shift [m].

    Parameters
    ----------
    shape, shift
        The obstacle, and how far it has moved.
    both
        The edge of the source, and the corners at the ends of the other.
    position
        Where nodes are drawn and where they are [m], of shape [node_count, 3].
    towards
        What normals are to point along as nearly as they can.
    """
    mine, ends = both
    drawn, now = position
    theirs = Edges.straight(shape.edges).between(ends).numbered_from(len(now))
    found = crossings(np.concatenate([now, shape.corners + shift]), mine, theirs, towards)
    depths = drawn_depths(np.concatenate([drawn, shape.corners]), found)
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
