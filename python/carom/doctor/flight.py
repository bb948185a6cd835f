"""Bodies in flight, rigid, until something touches."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from carom.building.simplices import Boundary, distance, to_point
from carom.case.obstacle import (
    Obstacle,
    Plane,
    RigidBox,
    RigidPolygon,
    RigidSphere,
    RigidSurface,
)
from carom.mesh_file.cells import KINDS

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Flight:
    """A rigid body thrown: its centre falls, and it turns; or one that supports lead.

    Parameters
    ----------
    boundary
        Its boundary at t = 0.
    centre
        Its centre of mass [m], shape [D].
    velocity, gravity
        Velocity of the centre [m/s] and its acceleration [m/s²], shape [D].
    spin
        Angular velocity [rad/s]: a number in 2D, shape [3] in 3D.
    led
        By axis, the displacement that supports prescribe [m] over time [s]. A body that is held
        anywhere does not turn.
    """

    boundary: Boundary
    centre: Array
    velocity: Array
    gravity: Array
    spin: Array
    led: Mapping[int, Callable[[float], float]] = field(default_factory=dict)

    def at(self, time: float) -> Boundary:
        """Return where the boundary is."""
        arms = self.boundary.points - self.centre
        centre = self.centre + time * self.velocity + 0.5 * time**2 * self.gravity
        for axis, displacement in self.led.items():
            centre[axis] = self.centre[axis] + displacement(time)
        turned = arms if self.led else arms @ _rotation(self.spin * time).T
        return self.boundary.at(np.asarray(centre + turned))


def _rotation(angle: Array) -> Array:
    """Return the rotation by an angle in the plane or a rotation vector in space [rad]."""
    if angle.ndim == 0:
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, -s], [s, c]])
    size = float(np.linalg.norm(angle))
    if size == 0.0:
        return np.eye(3)
    x, y, z = angle / size
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(size) * cross + (1 - np.cos(size)) * cross @ cross)


def obstacle_gap(
    obstacle: Obstacle, boundary: Boundary, at: Callable[[Array], Array]
) -> float | None:
    """Return the distance of a boundary from an obstacle at rest [m]; None if it is not known.

    Parameters
    ----------
    obstacle
        The obstacle.
    boundary
        The boundary.
    at
        What the native core says of the distances of points from the obstacle [m].
    """
    if isinstance(obstacle, RigidSurface):
        return None
    of_nodes = float(at(boundary.points).min())
    # Nothing is nearer to a plane or the wall of a cavity than a node. What bulges may be between.
    if of_nodes <= 0.0 or isinstance(obstacle, Plane):
        return of_nodes
    if isinstance(obstacle, RigidBox | RigidPolygon):
        return distance(boundary, _sides(obstacle))[0]
    if obstacle.cavity:
        return of_nodes
    if isinstance(obstacle, RigidSphere):
        return to_point(boundary, np.asarray(obstacle.centre)) - obstacle.radius
    axis = np.asarray(obstacle.axis) / np.linalg.norm(obstacle.axis)
    arms = boundary.points - obstacle.point
    across = boundary.at(arms - np.outer(arms @ axis, axis))
    return to_point(across, np.zeros(3)) - obstacle.radius


def _sides(obstacle: RigidBox | RigidPolygon) -> Boundary:
    """Return the boundary of an obstacle."""
    if isinstance(obstacle, RigidPolygon):
        return _around(np.asarray(obstacle.points, dtype=float))
    low = np.asarray(obstacle.corner, dtype=float)
    return _box(low, low + obstacle.size)


def _around(corners: Array) -> Boundary:
    """Return the sides of a polygon."""
    ends = np.arange(len(corners))
    return Boundary(corners, np.column_stack([ends, np.roll(ends, -1)]))


def _box(low: Array, high: Array) -> Boundary:
    """Return the boundary of an upright box."""
    if len(low) == 2:
        (x, y), (u, v) = low, high
        return _around(np.array([[x, y], [u, y], [u, v], [x, v]]))
    kind = KINDS["hexahedron"]
    unit = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    pieces = [part for a, b, c, d in kind.sides for part in ((a, b, c), (a, c, d))]
    return Boundary(low + np.array(unit) * (high - low), np.array(pieces))
