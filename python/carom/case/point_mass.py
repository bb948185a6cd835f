"""Masses at points of bodies."""

from __future__ import annotations

from pydantic import model_validator
from typing_extensions import Self

from carom.case.description import Description, Positive, Vector
from carom.messages import problem


class PointMass(Description):
    """A mass at a point of a body, beside that of its volume.

    It moves with the body, is accelerated by gravity and damped as the mass of the body is, and has
    no inertia of its own. On a rigid body it moves the centre of mass.

    Parameters
    ----------
    body
        Name of the body.
    point
        Where it is as the case is drawn [m], shape [D]. Of a body that deforms the nearest node has
        it, which must not be far; of a rigid body any point moves with it.
    on
        Name of a set of the mesh in place of a point: its nodes have equal parts.
    mass
        Mass [kg].
    """

    body: str
    point: Vector | None = None
    on: str | None = None
    mass: Positive

    @model_validator(mode="after")
    def _is_somewhere(self) -> Self:
        if (self.on is None) == (self.point is None):
            raise problem("a mass is at a point, or on a set; give one of them")
        return self
