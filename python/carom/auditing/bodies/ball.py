"""Rigid bodies that are round whatever their mesh, as the auditor sees them."""

from __future__ import annotations

import math

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask
from carom.auditing.bodies.mass import affine_weights
from carom.case.body import AnyBody, RigidBody
from carom.case.mesh import Ball as BallMesh
from carom.case.mesh import Disc

ALIKE = 1e-9
"""Nodes are as far away as one another up to this part of the radius."""


class Ball:
    """A ball, in the plane a disc, to what has no corners and to others of its kind.

    Its points follow as many nodes as there are axes and one more, as affine combinations of them:
    the first of its surface, and each the farthest from those before.

    Parameters
    ----------
    centre
        Its centre where nothing has moved [m], shape [D].
    radius
        Its radius [m].
    points, surface
        Reference positions of its nodes [m], shape [node_count, D], and those that may touch.
    """

    def __init__(self, centre: Array, radius: float, points: Array, surface: Indices) -> None:
        self.radius, self._points, self._surface = radius, points, surface
        shares = affine_weights(points - centre)
        assert shares is not None, "the nodes of a disc or a ball are not on one line"
        self._shares = shares

    @classmethod
    def of(cls, entry: AnyBody, points: Array, surface: Indices) -> Ball | None:
        """Return that of a body; None of what is its mesh."""
        if not isinstance(entry, RigidBody) or not entry.round:
            return None
        assert isinstance(entry.mesh, Disc | BallMesh), "nothing else is round"
        return cls(np.array(entry.mesh.centre), entry.mesh.radius, points, surface)

    def centre(self, position: Array) -> Array:
        """Return its centre [m] where its nodes are at `position` [m], shape [D]."""
        centre: Array = self._shares @ position
        return centre

    def volume(self, entry: RigidBody) -> float:
        """Return that of a body which is this ball [m³]; around the axis it is a ring."""
        radius = self.radius
        if isinstance(entry.mesh, BallMesh):
            return 4.0 / 3.0 * math.pi * radius**3
        deep = entry.thickness
        if entry.hypothesis == "axisymmetric":
            deep = 2.0 * math.pi * float(self.centre(self._points)[0])
        return math.pi * radius**2 * deep

    def inertia(self, mass: float) -> Array:
        """Return the inertia with a mass [kg] about its centre [kg m²], shape [1, 1] or [3, 3]."""
        if self._points.shape[1] == 3:
            return np.eye(3) * (0.4 * mass * self.radius**2)
        return np.eye(1) * (0.5 * mass * self.radius**2)

    def nodes(self, pressed: Mask) -> Indices:
        """Return the nodes that it follows; of those that are as far the ones that are pressed."""
        chosen = [int(self._surface[0])]
        axes: list[Array] = []
        for _ in range(self._points.shape[1]):
            arms = self._points[self._surface] - self._points[chosen[0]]
            for axis in axes:
                arms = arms - np.outer(arms @ axis, axis)
            far = np.linalg.norm(arms, axis=1)
            alike = np.flatnonzero(far >= far.max() - ALIKE * self.radius)
            own = alike[np.argmax(pressed[self._surface[alike]])]
            axes.append(arms[own] / far[own])
            chosen.append(int(self._surface[own]))
        return np.array(chosen)

    def touching(self, normal: Array, position: Array, pressed: Mask) -> list[tuple[int, float]]:
        """Return nodes and weights of the point where it touches what is along −normal.

        Parameters
        ----------
        normal
            Unit normal towards its centre, shape [D].
        position
            Where its nodes are [m], shape [node_count, D].
        pressed
            Which of them have contact forces, shape [node_count].
        """
        nodes = self.nodes(pressed)
        place = self.centre(position) - self.radius * normal
        conditions = np.column_stack([np.ones(len(nodes)), position[nodes] - place]).T
        weights = np.linalg.solve(conditions, np.eye(len(nodes))[0])
        return list(zip(nodes.tolist(), weights.tolist(), strict=True))
