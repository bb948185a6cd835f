"""Rigid obstacles, at rest or moving as prescribed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator
from typing_extensions import Self

from carom.case.description import (
    PER_DIMENSION,
    Description,
    FilePath,
    Name,
    PlaneVector,
    Positive,
    SpaceVector,
    Vector,
)
from carom.case.motion import Displacement
from carom.messages import problem


def _nonzero(vector: tuple[float, ...]) -> tuple[float, ...]:
    if not any(vector):
        raise ValueError("must not be the zero vector")
    return vector


class _Obstacle(Description):
    name: Name
    velocity: Vector | None = None
    motion: Displacement | None = None

    @model_validator(mode="after")
    def _moves_in_one_way(self) -> Self:
        if self.velocity is not None and self.motion is not None:
            raise problem("give velocity or motion, not both", key="motion")
        return self


class Plane(_Obstacle):
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

    kind: Literal["plane"] = "plane"
    point: Vector
    normal: Annotated[Vector, AfterValidator(_nonzero)]


class RigidSphere(_Obstacle):
    """A rigid ball, in 2D a disc, or a ball-shaped cavity.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    centre
        Centre [m], shape [D].
    radius
        Radius [m].
    cavity
        Whether bodies are inside, and all around is solid.
    velocity
        Constant velocity [m/s], shape [D]; None is none.
    motion
        Displacement over time, in place of a velocity.
    """

    kind: Literal["sphere"] = "sphere"
    centre: Vector
    radius: Positive
    cavity: Annotated[bool, Field(strict=True)] = False


class RigidCylinder(_Obstacle):
    """A rigid cylinder without ends in 3D, or a bore of that shape.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    point
        A point of the axis [m], shape [3].
    axis
        Direction of the axis, of any length but zero, shape [3].
    radius
        Radius [m].
    cavity
        Whether bodies are inside, and all around is solid.
    velocity
        Constant velocity [m/s], shape [3]; None is none.
    motion
        Displacement over time, in place of a velocity.
    """

    kind: Literal["cylinder"] = "cylinder"
    point: SpaceVector
    axis: Annotated[SpaceVector, AfterValidator(_nonzero)]
    radius: Positive
    cavity: Annotated[bool, Field(strict=True)] = False


class RigidBox(_Obstacle):
    """A rigid box with sides along the axes, in 2D a rectangle; bodies are outside.

    Nodes that come into it are pushed out of the nearest face; beyond its edges and corners they
    feel the nearest point.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    corner
        Corner of the smallest coordinates [m], shape [D].
    size
        Sides [m], shape [D].
    velocity
        Constant velocity [m/s], shape [D]; None is none.
    motion
        Displacement over time, in place of a velocity.
    """

    kind: Literal["box"] = "box"
    corner: Vector
    size: Annotated[tuple[Positive, ...], PER_DIMENSION]


class RigidPolygon(_Obstacle):
    """The inside of a polygon, in 2D; bodies are outside.

    It may have dents. Its sides meet at its corners alone.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    points
        Its corners [m] in order, in either sense of turning; the last side closes by itself.
    velocity
        Constant velocity [m/s], shape [2]; None is none.
    motion
        Displacement over time, in place of a velocity.
    """

    kind: Literal["polygon"] = "polygon"
    points: Annotated[tuple[PlaneVector, ...], Field(min_length=3)]


class RigidSurface(_Obstacle):
    """What a closed surface of triangles encloses, in 3D; bodies are outside.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    file
        The file with the triangles, as a rule STL; in a case file a path relative to it.
    scale
        What coordinates are multiplied by to be in metres: 0.001 for a file in millimetres.
    velocity
        Constant velocity [m/s], shape [3]; None is none.
    motion
        Displacement over time, in place of a velocity.
    """

    kind: Literal["surface"] = "surface"
    file: FilePath
    scale: Positive = 1.0


Obstacle = Annotated[
    Plane | RigidSphere | RigidCylinder | RigidBox | RigidPolygon | RigidSurface,
    Field(discriminator="kind"),
]
