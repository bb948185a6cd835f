"""Rigid obstacles, at rest or moving as prescribed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator

from carom.description import Description, Name, Vector


def _nonzero(vector: tuple[float, ...]) -> tuple[float, ...]:
    if not any(vector):
        raise ValueError("must not be the zero vector")
    return vector


class Plane(Description):
    """A rigid half-space bounded by a plane.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    point
        A point of the plane [m], shape [D].
    normal
        Direction towards the free side, of any length but zero, shape [D].
    velocity
        Constant velocity [m/s], shape [D]; None is none. Its work on the bodies is in the ledger as
        ``prescribed``.
    """

    name: Name
    kind: Literal["plane"] = "plane"
    point: Vector
    normal: Annotated[Vector, AfterValidator(_nonzero)]
    velocity: Vector | None = None


Obstacle = Plane
