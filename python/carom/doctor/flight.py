"""Bodies in flight, rigid, until something touches."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from carom.obstacle import Obstacle, Plane, RigidBox, RigidCylinder, RigidSphere

SAMPLES = 200
"""Times at which the distance of a pair is looked at, before it is looked at closer."""

REFINEMENTS = 20
"""Halvings of the interval in which two touch."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Flight:
    """A rigid body thrown: its centre falls, and it turns; or one that supports lead.

    Parameters
    ----------
    points
        Points of its boundary at t = 0 [m], shape [count, D].
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

    points: Array
    centre: Array
    velocity: Array
    gravity: Array
    spin: Array
    led: Mapping[int, Callable[[float], float]] = field(default_factory=dict)

    def at(self, time: float) -> Array:
        """Return where the points are [m]."""
        arms = self.points - self.centre
        centre = self.centre + time * self.velocity + 0.5 * time**2 * self.gravity
        for axis, displacement in self.led.items():
            centre[axis] = self.centre[axis] + displacement(time)
        turned = arms if self.led else arms @ _rotation(self.spin * time).T
        return np.asarray(centre + turned)


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


def obstacle_gap(obstacle: Obstacle, points: Array) -> float | None:
    """Return the least distance of points from an obstacle at rest [m]; None if it is not known."""
    if isinstance(obstacle, Plane):
        normal = np.asarray(obstacle.normal) / np.linalg.norm(obstacle.normal)
        return float(np.min((points - obstacle.point) @ normal))
    if isinstance(obstacle, RigidSphere):
        distance = np.linalg.norm(points - obstacle.centre, axis=1)
        return _round(distance, obstacle.radius, cavity=obstacle.cavity)
    if isinstance(obstacle, RigidCylinder):
        axis = np.asarray(obstacle.axis) / np.linalg.norm(obstacle.axis)
        arms = points - obstacle.point
        distance = np.linalg.norm(arms - np.outer(arms @ axis, axis), axis=1)
        return _round(distance, obstacle.radius, cavity=obstacle.cavity)
    if isinstance(obstacle, RigidBox):
        low = np.asarray(obstacle.corner)
        outside = np.maximum(np.maximum(low - points, points - low - obstacle.size), 0.0)
        return float(np.min(np.linalg.norm(outside, axis=1)))
    return None


def _round(distance: Array, radius: float, *, cavity: bool) -> float:
    return float(np.min(radius - distance if cavity else distance - radius))


def body_gap(one: Array, other: Array) -> float:
    """Return the distance of the nearest points of two bodies [m]."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 (SciPy, which most runs do without)

    return float(np.min(cKDTree(other).query(one)[0]))
