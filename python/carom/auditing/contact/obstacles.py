"""Obstacles as the auditor sees them: how far points are from them, and how they move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import AXES, Array, Indices
from carom.auditing.functions.signals import Travel, Uniform
from carom.auditing.mesh.kinds import KINDS
from carom.auditing.targets.curve import Curve
from carom.auditing.targets.feet import Target
from carom.auditing.targets.sheet import FlatPatches, Sheet
from carom.case.obstacle import (
    Obstacle,
    Plane,
    RigidBox,
    RigidCylinder,
    RigidPolygon,
    RigidSphere,
    RigidSurface,
)
from carom.mesh_file import read_surface


class Shape(Protocol):
    """The surface of an obstacle where it is drawn."""

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, D]."""


@dataclass(frozen=True)
class AuditObstacle:
    """An obstacle that moves as prescribed.

    Parameters
    ----------
    shape
        Its surface where it is drawn.
    travel
        How it moves.
    """

    shape: Shape
    travel: Travel

    def nearest(self, x: Array, time: float) -> tuple[Array, Array]:
        """Return distances of points at a time [s], negative inside [m], and unit normals."""
        return self.shape.nearest(x - self.travel.displacement(time))

    def distance(self, x: Array, time: float) -> Array:
        """Return the same without the normals."""
        return self.nearest(x, time)[0]


def obstacle_of(entry: Obstacle, dimension: int) -> AuditObstacle:
    """Return an obstacle of the case, in the plane or in space."""
    motion = entry.motion
    moves = Uniform(np.zeros(dimension) if entry.velocity is None else np.array(entry.velocity))
    travel = (
        moves if motion is None else Travel([getattr(motion, axis) for axis in AXES[:dimension]])
    )
    return AuditObstacle(_shape(entry, dimension), travel)


def _shape(entry: Obstacle, dimension: int) -> Shape:
    if isinstance(entry, Plane):
        normal = np.array(entry.normal)
        return HalfSpace(np.array(entry.point), normal / np.linalg.norm(normal))
    if isinstance(entry, RigidSphere):
        centre, across = np.array(entry.centre), np.eye(dimension)
        return Round(centre, across, entry.radius, -1.0 if entry.cavity else 1.0)
    if isinstance(entry, RigidCylinder):
        axis = np.array(entry.axis) / np.linalg.norm(entry.axis)
        point, across = np.array(entry.point), np.eye(dimension) - np.outer(axis, axis)
        return Round(point, across, entry.radius, -1.0 if entry.cavity else 1.0)
    if isinstance(entry, RigidBox):
        return Cornered.box(np.array(entry.corner), np.array(entry.size))
    if isinstance(entry, RigidPolygon):
        return Cornered.polygon(np.array(entry.points))
    assert isinstance(entry, RigidSurface), "there are no other obstacles"
    read = read_surface(entry.file, scale=entry.scale, key=f"obstacle {entry.name!r}")
    return Cornered(read.points, read.triangles)


@dataclass(frozen=True)
class HalfSpace:
    """A plane.

    Parameters
    ----------
    point
        A point of it [m], shape [D].
    normal
        Unit normal, shape [D].
    """

    point: Array
    normal: Array

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, D]."""
        return (x - self.point) @ self.normal, np.broadcast_to(self.normal, x.shape)


class Cornered:
    """What straight facets enclose: to a body they are what the facets of another body are.

    Parameters
    ----------
    corners
        Its corners [m], shape [corner_count, D].
    facets
        Its facets by their corners, outward as those of bodies, shape [facet_count, a].
    """

    def __init__(self, corners: Array, facets: Indices) -> None:
        self.corners, self.facets = corners, facets
        if corners.shape[1] == 2:
            self.target: Target = Curve(facets, corners, smooth=False)
        else:
            self.target = Sheet(FlatPatches(facets))

    @classmethod
    def box(cls, corner: Array, size: Array) -> Cornered:
        """Return a box with sides along the axes, in the plane a rectangle.

        Corner k has the far end of axis i if bit i of k is set.
        """
        dimension = len(corner)
        kind = KINDS["quad4" if dimension == 2 else "hex8"]
        far = (kind.nodes > 0.0).astype(np.int64)
        number = far @ (1 << np.arange(dimension))
        facets = number[np.array(kind.facets)]
        corners = np.zeros(far.shape)
        corners[number] = corner + size * far
        return cls(corners, facets)

    @classmethod
    def polygon(cls, points: Array) -> Cornered:
        """Return the inside of a polygon in the plane, in either sense of turning."""
        x, y = points.T
        if float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) < 0.0:
            points = points[::-1]
        numbers = np.arange(len(points))
        return cls(points, np.stack([numbers, np.roll(numbers, -1)], axis=1))

    @property
    def edges(self) -> Indices:
        """The lines around its facets, shape [count, 2]."""
        sides = np.concatenate(
            [np.roll(self.facets, -k, axis=1)[:, :2] for k in range(self.facets.shape[1])]
        )
        edges: Indices = np.unique(np.sort(sides, axis=1), axis=0)
        return edges

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, D]."""
        feet = self.target.feet(x, self.corners)
        normals = np.zeros(x.shape)
        for k in range(len(x)):
            mine = np.flatnonzero(feet.point == k)
            if len(mine):
                normals[k] = feet.normal[mine[np.abs(feet.gap[mine]).argmin()]]
        return self.target.signed_distance(x, self.corners), normals


@dataclass(frozen=True)
class Round:
    """A disc, a ball or a cylinder, or what is around a hole of that shape.

    Parameters
    ----------
    centre
        Centre, or a point of the axis [m], shape [D].
    across
        What is left of arms at right angles to the axis, shape [D, D]; all of a disc and a ball.
    radius
        Radius [m].
    sign
        1, or −1 of a hole.
    """

    centre: Array
    across: Array
    radius: float
    sign: float

    @property
    def has_axis(self) -> bool:
        """Whether it is a cylinder."""
        return bool(np.trace(self.across) < len(self.centre) - 0.5)

    def offsets(self, x: Array) -> Array:
        """Return points from the centre, or from the axis at right angles [m], [count, D]."""
        offsets: Array = (x - self.centre) @ self.across
        return offsets

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, D]."""
        arms = self.offsets(x)
        far = np.linalg.norm(arms, axis=1)
        towards = arms / np.where(far > 0, far, 1.0)[:, None]
        return self.sign * (far - self.radius), self.sign * towards
