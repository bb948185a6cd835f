"""Rigid obstacles of the plane as what is solid of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.case.obstacle import Obstacle, Plane, RigidBox, RigidPolygon, RigidSphere

FINE = 360
"""Edges around what is round: beside a large obstacle a small body shows how round it is."""


@dataclass(frozen=True)
class Solid:
    """What of the plane an obstacle takes, as it is drawn.

    Parameters
    ----------
    rings
        What is solid: closed curves, the second a hole in the first, shape [count, 2] each [m].
    edge
        The boundary that bodies meet, shape [count, 2] [m], from its first point to its last.
    """

    rings: tuple[NDArray[np.float64], ...]
    edge: NDArray[np.float64]


def solid(obstacle: Obstacle, middle: NDArray[np.float64], size: float) -> Solid:
    """Return an obstacle where it has not moved; what has no end reaches out of the picture.

    Parameters
    ----------
    obstacle
        The obstacle, of a case in the plane.
    middle
        Middle of the picture [m], shape [2].
    size
        What is larger than the picture [m].
    """
    if isinstance(obstacle, Plane):
        normal = np.array(obstacle.normal) / np.linalg.norm(obstacle.normal)
        along = size * np.array([-normal[1], normal[0]])
        foot = middle - normal * float((middle - np.array(obstacle.point)) @ normal)
        below = foot - size * normal
        edge = np.array([foot - along, foot + along])
        return Solid((np.array([*edge, below + along, below - along]),), edge)
    if isinstance(obstacle, RigidSphere):
        circle = _circle(np.array(obstacle.centre), obstacle.radius)
        if not obstacle.cavity:
            return Solid((circle,), circle)
        around = _circle(np.array(obstacle.centre), obstacle.radius + size)
        return Solid((around, circle), circle)
    if isinstance(obstacle, RigidBox):
        (x, y), (width, height) = obstacle.corner, obstacle.size
        corners = np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]])
    else:
        assert isinstance(obstacle, RigidPolygon), f"{obstacle.kind} is no obstacle of the plane"
        corners = np.array(obstacle.points)
    return Solid((corners,), np.concatenate([corners, corners[:1]]))


def _circle(centre: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    angle = np.linspace(0.0, 2.0 * np.pi, FINE + 1)
    return centre + radius * np.column_stack([np.cos(angle), np.sin(angle)])
