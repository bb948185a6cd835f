"""What closest points of targets are found as, and what targets have to say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask

BEYOND = 0.5
"""How far a facet, or the end of a smooth part, reaches beyond its edge, in facets."""

FLAT = np.cos(np.radians(1))
"""Cosine of the angle up to which a smooth target is straight, and stays where its facets are."""

CORNER = np.cos(np.radians(40)) - 1e-9
"""Cosine of the angle from which on a smooth target keeps its corner; the slack is for polygons
whose angles are 40° up to round-off."""

TIE = 1e-9
"""Distances closer than this part of a facet are the same: a corner."""


@dataclass(frozen=True)
class Feet:
    """Points of a target where the distance from given points is stationary.

    Parameters
    ----------
    point
        Index of the given point, shape [count].
    facet
        Index of the facet, shape [count].
    gap
        Distance along the normal, negative behind the target [m], shape [count].
    normal
        Outward normal, shape [count, D].
    nodes, weights
        The nodes that the foot follows, in the body's numbering, and how much, shape [count, n].
    beyond
        How far the foot is beyond the edge of its facet, in facets, shape [count].
    """

    point: Indices
    facet: Indices
    gap: Array
    normal: Array
    nodes: Indices
    weights: Array
    beyond: Array


class Target(Protocol):
    """The boundary of a body that nodes of others are checked against."""

    @property
    def width(self) -> int:
        """The most nodes that a foot follows."""

    @property
    def facets(self) -> Indices:
        """Nodes of its facets in the body's numbering, shape [facet_count, a]."""

    @property
    def smooth(self) -> Mask:
        """Over which facets it goes on to the next without a kink, shape [facet_count]."""

    def feet(self, x: Array, position: Array) -> Feet:
        """Return all places where distances are smallest on a facet or beyond a free end.

        Parameters
        ----------
        x
            Points [m], shape [point_count, D].
        position
            Positions of the body's nodes [m], shape [node_count, D].
        """

    def signed_distance(self, x: Array, position: Array) -> Array:
        """Return the distances of points from the target, negative inside [m], shape [point_count].

        Of facets that share the closest point, a corner, the one seen most squarely says which
        side the point is on. What is beyond the rim of an open surface is on neither side of it:
        its distance is infinite.
        """
