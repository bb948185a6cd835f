"""Directions of friction that surfaces carry."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.bodies.body import AuditBody

LIES = 1e-6
"""The least sine of the angle with a normal at which a direction says how a surface is drawn on."""

FLAT = 1e-10
"""Spreads of nodes below this part of the largest are none: they lie in a plane."""


class Grain:
    """The direction of the first coefficient of friction: of an obstacle, or drawn on a body.

    Parameters
    ----------
    direction
        The direction where nothing has moved, shape [3].
    body
        The body that carries it; None of an obstacle.
    """

    def __init__(self, direction: Array, body: AuditBody | None) -> None:
        self._direction, self._body = direction, body
        self._known: dict[int, tuple[list[int], Array]] = {}

    def on(self, normal: Array, stencil: Iterable[tuple[int, float]], position: Array) -> Array:
        """Return its direction in a tangent plane, of length 1, shape [3].

        Zero where it stands on the surface, so that friction is the same in all directions.

        Parameters
        ----------
        normal
            Unit normal of the plane, shape [3].
        stencil
            Nodes of both sides of the contact, with their weights.
        position
            Where all nodes are [m], shape [node_count, 3].
        """
        whole = self._direction
        if self._body is not None:
            span, whole = self._body.span, np.zeros(3)
            for node, weight in stencil:
                if span.start <= node < span.stop:
                    own = self._at(node - span.start, position[span])
                    whole = whole + abs(weight) * own
        along = whole - normal * (normal @ whole)
        size = float(np.linalg.norm(along))
        lies = size > LIES * float(np.linalg.norm(whole))
        return along / size if lies else np.zeros(3)

    def _at(self, node: int, position: Array) -> Array:
        """Return what has become of the direction at a node of the body.

        It is Σ c (x_k − x) over the other nodes of the facets around, with the c of least norm that
        made of it, where nothing had moved, the direction or its part along these facets.
        """
        assert self._body is not None, "nodes are of a body"
        if node not in self._known:
            facets, points = self._body.facets, self._body.points
            around = np.unique(facets[(facets == node).any(axis=1)])
            others = around[around != node]
            arms = points[others] - points[node]
            if len(others):
                # Singular values are roots of spreads.
                shares = np.linalg.pinv(arms.T, rcond=np.sqrt(FLAT)) @ self._direction
            else:
                shares = np.zeros(0)
            self._known[node] = (others.tolist(), shares)
        others_of, shares = self._known[node]
        found: Array = shares @ (position[others_of] - position[node])
        return found
