"""Which facets of two boundaries face one another, for mortar rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Mask
from carom.auditing.targets.clipping import common, oriented
from carom.auditing.targets.covering import Covering
from carom.auditing.targets.seen import View

OPPOSED = 0.5
"""Facets face one another if their normals are opposite to 60°."""

REACH = 0.5
"""And if they are no farther from one another than this part of both diameters."""

DEPTH = 0.25
"""How deep a facet may be behind another, in the diameters of the smaller."""


@dataclass(frozen=True)
class Look:
    """A facet as others see it.

    Parameters
    ----------
    view
        Its plane.
    corners
        Its corners [m], shape [corner, D].
    middle
        The middle of its nodes [m], shape [D].
    diameter, radius
        The largest distances of two of its nodes, and of one from the middle [m].
    """

    view: View
    corners: Array
    middle: Array
    diameter: float
    radius: float

    @classmethod
    def at(cls, side: Covering, facet: int, position: Array) -> Look:
        """Return a facet where the nodes of its body are at `position` [m]."""
        nodes = position[side.facets[facet]]
        corners = nodes[: side.corner_count(facet)]
        middle = nodes.mean(axis=0)
        return cls(
            view=View.of(corners),
            corners=corners,
            middle=middle,
            diameter=float(np.linalg.norm(nodes[:, None] - nodes[None], axis=2).max()),
            radius=float(np.linalg.norm(nodes - middle, axis=1).max()),
        )

    def reaches(self, other: Look) -> bool:
        """Return whether another is not far behind: neither its middle nor all that it covers."""
        limit = DEPTH * min(self.diameter, other.diameter)
        outlines = [oriented(self.view.of_points(one.corners)) for one in (self, other)]
        depths = [-float(self.view.normal @ (other.view.origin - self.view.origin))]
        depths += [-self.view.height(other.view, point) for point in common(*outlines)]
        return min(depths) < limit


def facing_facets(
    source: Covering, target: Covering, positions: tuple[Array, Array]
) -> Iterator[tuple[int, list[int]]]:
    """Yield facets of the source, each with those of the target that it faces.

    Nodes of either are at these positions [m], shape [node_count, D].
    """
    mine, theirs = (
        [Look.at(side, facet, position) for facet in range(len(side.facets))]
        for side, position in zip((source, target), positions, strict=True)
    )
    for facet, near in enumerate(_opposite(mine, theirs)):
        faced = [g for g in np.flatnonzero(near).tolist() if mine[facet].reaches(theirs[g])]
        if faced:
            yield facet, faced


def _opposite(mine: list[Look], theirs: list[Look]) -> Mask:
    """Return which facets are near one another and look at one another, shape [count, count]."""
    (normals, middles, rooms), (others, places, spaces) = (
        (
            np.array([look.view.normal for look in looks]),
            np.array([look.middle for look in looks]),
            np.array([look.radius + REACH * look.diameter for look in looks]),
        )
        for looks in (mine, theirs)
    )
    apart = np.linalg.norm(middles[:, None] - places[None], axis=2)
    opposite: Mask = (normals @ others.T < -OPPOSED) & (apart <= rooms[:, None] + spaces)
    return opposite
