"""The areas of facets that bear a contact at their node."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.mesh.facets import node_counts
from carom.auditing.model import AuditModel
from carom.auditing.steps.contacts import BEARS


def bearing_area(
    model: AuditModel, source: int, node: int, pushes: Array, position: Array, *, turn: float = 0.0
) -> tuple[float, float]:
    """Return the area around a node that bears what pushes it along a direction [m²], as bounds.

    Both are the same but where a facet faces it just well enough to bear, or just not.

    Parameters
    ----------
    model
        The model.
    source, node
        The body, and the node of it in the numbering of the model.
    pushes
        The direction, shape [D].
    position
        Where all nodes are [m], shape [node_count, D].
    turn
        How far directions may be off.
    """
    body = model.bodies[source]
    around = np.flatnonzero((body.facets == node - body.span.start).any(axis=1))
    facing = -body.faces(body.facets[around]).normals(position[body.span]) @ pushes
    best = facing.max()
    shares = body.facet_areas[around] / node_counts(body.facets[around])
    if best <= 0.0:
        return float(shares.sum()), float(shares.sum())
    least, most = (
        float(shares[facing >= BEARS * best + sign * turn].sum()) for sign in (1.0, -1.0)
    )
    return least, most
