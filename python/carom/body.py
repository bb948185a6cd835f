"""Deformable bodies."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator
from typing_extensions import Self

from carom.description import Description, Name, Number, Positive, Vector
from carom.mesh import Mesh, Rectangle
from carom.messages import problem


class Body(Description):
    """A deformable body.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    material
        Name of one of the scenario's materials.
    hypothesis
        What the plane model assumes about the third direction.
    thickness
        Thickness in the third direction [m].
    mass
        Mass matrix: consistent, or lumped to the nodes.
    mesh
        Reference geometry and its cells.
    contact_sides
        Sides of a rectangle that may touch others; None for all.
    velocity
        Initial velocity of the centre of mass [m/s], shape [2].
    spin
        Initial angular velocity about the centre of mass [rad/s].
    """

    name: Name
    material: str
    hypothesis: Literal["plane-strain"] = "plane-strain"
    thickness: Positive = 1.0
    mass: Literal["consistent", "lumped"] = "consistent"
    mesh: Mesh
    contact_sides: tuple[Literal["left", "right", "bottom", "top"], ...] | None = None
    velocity: Vector = (0.0, 0.0)
    spin: Number = 0.0

    @model_validator(mode="after")
    def _what_repeats_itself_cannot_spin(self) -> Self:
        if isinstance(self.mesh, Rectangle) and self.mesh.periodic and self.spin != 0.0:
            raise problem("a periodic body cannot spin; give 0", key="spin", value=self.spin)
        return self
