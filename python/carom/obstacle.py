"""Rigid obstacles, at rest or moving as prescribed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, model_validator
from typing_extensions import Self

from carom.description import Description, Name, Vector
from carom.messages import problem
from carom.motion import Displacement


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
    motion
        Displacement over time, in place of a velocity.
    """

    name: Name
    kind: Literal["plane"] = "plane"
    point: Vector
    normal: Annotated[Vector, AfterValidator(_nonzero)]
    velocity: Vector | None = None
    motion: Displacement | None = None

    @model_validator(mode="after")
    def _moves_in_one_way(self) -> Self:
        if self.velocity is not None and self.motion is not None:
            raise problem("give velocity or motion, not both", key="motion")
        return self


Obstacle = Plane
