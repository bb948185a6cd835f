"""Obstacles as the auditor sees them: how far points are from them, and how they move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import AXES, Array
from carom.auditing.functions.signals import Travel, Uniform
from carom.case.obstacle import Obstacle, Plane, RigidCylinder, RigidSphere
from carom.errors import InputError


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
    # Their corners are checked against the facets of bodies too.
    raise InputError(f"cannot audit obstacles of kind {entry.kind!r} yet")


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
