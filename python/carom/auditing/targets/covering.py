"""Boundaries that mortar rows are integrated over: their places, and what of them faces a point."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.mesh.facets import node_counts
from carom.auditing.mesh.kinds import Kind, kind_with
from carom.auditing.targets.curve import Curve
from carom.auditing.targets.fans import fans
from carom.auditing.targets.feet import CORNER, Feet, Target
from carom.auditing.targets.sheet import Sheet
from carom.auditing.targets.tiles import TILES

_HALVES = {2: [[0, 1]], 3: [[0, 2], [2, 1]]}
"""Ends of the parts of a facet of the plane by its number of nodes."""


class Covering:
    """A boundary.

    Parameters
    ----------
    facets
        Its facets in the body's numbering, shape [facet_count, a].
    points
        Reference positions of the body's nodes [m], shape [node_count, D].
    target
        What it is to nodes of others.
    revolution
        Whether it is the meridian of a body of revolution.
    """

    def __init__(self, facets: Indices, points: Array, target: Target, *, revolution: bool) -> None:
        self.dimension, self.revolution = points.shape[1], revolution
        self._counts = node_counts(facets)
        self.facets = [facet[:n] for facet, n in zip(facets, self._counts, strict=True)]
        """The nodes of every facet."""
        self.fans = fans(facets, points)
        self._target = target

    @property
    def multiplier_count(self) -> int:
        """How many multipliers it has: one of every fan around every node."""
        both = zip(self.facets, self.fans, strict=True)
        return len({pair for nodes, own in both for pair in zip(nodes.tolist(), own, strict=True)})

    def kind(self, facet: int) -> Kind:
        """Return the kind of a facet."""
        return kind_with(self.dimension - 1, int(self._counts[facet]))

    def parts(self, facet: int) -> list[list[int]]:
        """Return the corners of its parts with straight edges, by their numbers in the facet."""
        return (_HALVES if self.dimension == 2 else TILES)[int(self._counts[facet])]

    def is_smooth(self, facet: int) -> bool:
        """Return whether it is more than what its shape functions say over a facet."""
        if isinstance(self._target, Curve):
            return bool(self._target.joined[facet].any())
        assert isinstance(self._target, Sheet), "there is nothing else"
        return self._target.patch_over(facet, 0) is not None

    def over(self, facet: int, part: int, shapes: Array, of_part: Array) -> tuple[Indices, Array]:
        """Return the nodes that points over a part of a facet follow, and weights, [count, n].

        Parameters
        ----------
        facet, part
            The facet, and the number of its part.
        shapes, of_part
            Shape functions of the facet, [count, a], and linear ones of the part, [count, corner].
        """
        if not self.is_smooth(facet):
            return self.facets[facet], shapes
        if isinstance(self._target, Curve):
            return self._target.over(facet, shapes[:, 1])
        assert isinstance(self._target, Sheet), "there is nothing else"
        corners = kind_with(2, of_part.shape[1]).nodes
        patch = self._target.patch_over(facet, part)
        assert patch is not None, "all parts of a facet are smooth, or none"
        return self._target.over(patch, of_part @ corners)

    def facing(self, facets: Indices, x: Array, position: Array) -> tuple[Indices, Array]:
        """Return the nodes that the closest points to others follow, and weights, [count, n].

        They are over facets or, where these go on smoothly, over the next ones.

        Parameters
        ----------
        facets
            The facet of each point, shape [count].
        x
            Points [m], shape [count, D].
        position
            Where the nodes of the body are [m], shape [node_count, D].
        """
        feet = self._target.feet(x, position)
        order = np.argsort(feet.point, kind="stable")
        ends = np.cumsum(np.bincount(feet.point, minlength=len(x)))[:-1]
        each = zip(facets.tolist(), np.split(order, ends), strict=True)
        chosen = [self._foot(facet, feet, mine) for facet, mine in each]
        return feet.nodes[chosen], feet.weights[chosen]

    def _foot(self, facet: int, feet: Feet, mine: Indices) -> int:
        """Return which of the feet `mine` of a point goes on from a facet."""
        owners = [self._owner(patch) for patch in feet.facet[mine].tolist()]
        own = np.array([owner == facet for owner in owners], dtype=bool)
        on = feet.beyond[mine] == 0.0
        around = set(self.facets[facet].tolist())
        beside = np.array([not around.isdisjoint(self.facets[o].tolist()) for o in owners])
        if own.any():
            # What is beyond a corner is not beside it.
            beside &= feet.normal[mine] @ feet.normal[mine[own.argmax()]] > CORNER
        for chosen in (own & on, beside & on, own, beside, np.ones_like(own)):
            if chosen.any():
                break
        among = mine[chosen]
        return int(among[np.abs(feet.gap[among]).argmin()])

    def _owner(self, patch: int) -> int:
        """Return the facet that a piece of the target is over."""
        return self._target.owner(patch) if isinstance(self._target, Sheet) else patch
