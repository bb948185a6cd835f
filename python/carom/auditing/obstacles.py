"""Obstacles as the auditor sees them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.signals import Travel, Uniform
from carom.case.obstacle import Obstacle, Plane
from carom.errors import InputError


@dataclass(frozen=True)
class AuditPlane:
    """A plane that moves as prescribed.

    Parameters
    ----------
    point
        A point of it where it is drawn [m], shape [2].
    normal
        Unit normal, shape [2].
    travel
        How it moves.
    """

    point: Array
    normal: Array
    travel: Travel

    def distance(self, x: Array, time: float) -> Array:
        """Return the signed distance of points at a time [s], negative behind it [m]."""
        distance: Array = (x - (self.point + self.travel.displacement(time))) @ self.normal
        return distance


def plane_of(entry: Obstacle) -> AuditPlane:
    """Return the plane of an obstacle."""
    if not isinstance(entry, Plane):
        raise InputError(f"cannot audit obstacles of kind {entry.kind!r} yet")
    normal = np.array(entry.normal)
    motion = entry.motion
    moves = Uniform(np.array(entry.velocity or (0.0, 0.0)))
    return AuditPlane(
        point=np.array(entry.point),
        normal=normal / np.linalg.norm(normal),
        travel=moves if motion is None else Travel((motion.x, motion.y)),
    )
