"""Obstacles as the auditor sees them: how far points are from them, and how they move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.signals import Travel, Uniform
from carom.case.obstacle import Obstacle, Plane, RigidSphere
from carom.errors import InputError


class Shape(Protocol):
    """The surface of an obstacle where it is drawn."""

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, 2]."""


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


def obstacle_of(entry: Obstacle) -> AuditObstacle:
    """Return an obstacle of the case."""
    motion = entry.motion
    moves = Uniform(np.array(entry.velocity or (0.0, 0.0)))
    travel = moves if motion is None else Travel((motion.x, motion.y))
    return AuditObstacle(_shape(entry), travel)


def _shape(entry: Obstacle) -> Shape:
    if isinstance(entry, Plane):
        normal = np.array(entry.normal)
        return HalfSpace(np.array(entry.point), normal / np.linalg.norm(normal))
    if isinstance(entry, RigidSphere):
        return Circle(np.array(entry.centre), entry.radius, -1.0 if entry.cavity else 1.0)
    # Their corners are checked against the facets of bodies too.
    raise InputError(f"cannot audit obstacles of kind {entry.kind!r} yet")


@dataclass(frozen=True)
class HalfSpace:
    """A plane.

    Parameters
    ----------
    point
        A point of it [m], shape [2].
    normal
        Unit normal, shape [2].
    """

    point: Array
    normal: Array

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, 2]."""
        return (x - self.point) @ self.normal, np.broadcast_to(self.normal, x.shape)


@dataclass(frozen=True)
class Circle:
    """A disc, or what is around a hole of that shape.

    Parameters
    ----------
    centre
        Centre [m], shape [2].
    radius
        Radius [m].
    sign
        1, or −1 of a hole.
    """

    centre: Array
    radius: float
    sign: float

    def nearest(self, x: Array) -> tuple[Array, Array]:
        """Return signed distances of points [m] and unit normals, shapes [count], [count, 2]."""
        arms = x - self.centre
        far = np.linalg.norm(arms, axis=1)
        towards = arms / np.where(far > 0, far, 1.0)[:, None]
        return self.sign * (far - self.radius), self.sign * towards
