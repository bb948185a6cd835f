"""Facets as they are seen in the plane of one of them, along its normal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, einsum
from carom.auditing.mesh.kinds import Kind

STEPS = 20
"""Steps to the place of a facet that is seen at a point; straight ones need one."""

CLOSE = 1e-13
"""Changes of ξ below this end them."""


@dataclass(frozen=True)
class View:
    """A plane in space, or a line in the plane, through the corners of a facet.

    Parameters
    ----------
    origin
        The middle of the corners [m], shape [D].
    normal
        Outward unit normal, shape [D].
    across
        Unit vectors in it, shape [D − 1, D].
    """

    origin: Array
    normal: Array
    across: Array

    @classmethod
    def of(cls, corners: Array) -> View:
        """Return the one that fits the corners of a facet [m], shape [corner, D]."""
        if corners.shape[1] == 2:
            along = _unit(corners[1] - corners[0])
            normal = np.array([along[1], -along[0]])
            return cls(corners.mean(axis=0), normal, along[None])
        normal = _unit(cross(corners[2] - corners[0], corners[-1] - corners[1]))
        first = _unit(np.eye(3)[np.abs(normal).argmin()] - normal * normal[np.abs(normal).argmin()])
        return cls(corners.mean(axis=0), normal, np.stack([first, cross(normal, first)]))

    def of_points(self, x: Array) -> Array:
        """Return where points [m], shape [count, D], are seen, shape [count, D − 1]."""
        seen: Array = (x - self.origin) @ self.across.T
        return seen

    def height(self, other: View, point: Array) -> float:
        """Return how high another plane is above a point of this one [m]."""
        x = self.origin + point @ self.across
        return float(other.normal @ (other.origin - x) / (other.normal @ self.normal))


def shapes_at(kind: Kind, nodes: Array, points: Array) -> Array:
    """Return the shape functions of a facet where it is seen at points, shape [count, a].

    Places may be somewhat beyond its edges.

    Parameters
    ----------
    kind
        The kind of the facet.
    nodes
        Where its nodes are seen [m], shape [a, D − 1].
    points
        The points [m], shape [count, D − 1].
    """
    xi = np.broadcast_to(kind.middle, points.shape).copy()
    for _ in range(STEPS):
        left = points - kind.values(xi) @ nodes
        jacobians = einsum("ai,qak->qik", nodes, kind.slopes(xi))
        step = np.linalg.solve(jacobians, left[..., None])[..., 0]
        xi += step
        if np.abs(step).max() < CLOSE:
            break
    return kind.values(xi)


def _unit(vector: Array) -> Array:
    unit: Array = vector / np.linalg.norm(vector)
    return unit
