"""Springs and dampers between two places."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import Description, Name, NonNegative, Number, Vector
from carom.messages import problem


class Place(Description):
    """Where a spring is attached.

    It is a point of a body, a set of one, a point of an obstacle, with which it moves, or a point
    that stays where it is.

    Parameters
    ----------
    body
        Name of the body.
    obstacle
        Name of the obstacle.
    on
        Name of a set of the mesh of the body: its nodes take equal parts of the force, and the
        place is their mean.
    point
        Where it is as the case is drawn [m], shape [D]. Of a body that deforms the nearest node is
        taken, which must not be far; of a rigid body any point moves with it.
    """

    body: str | None = None
    obstacle: str | None = None
    on: str | None = None
    point: Vector | None = None

    @model_validator(mode="after")
    def _is_one_place(self) -> Self:
        if self.body is not None and self.obstacle is not None:
            raise problem("a place is of a body or of an obstacle; leave one out", key="obstacle")
        if self.on is not None and self.body is None:
            raise problem("is a set of a body; name the body", key="on", value=self.on)
        if (self.on is None) == (self.point is None):
            raise problem("give a point, or a set `on` a body")
        return self


class ForceTable(Description):
    """A force over the elongation of a spring, with straight lines between its points.

    Beyond the first and the last point it goes on as it does beside them.

    Parameters
    ----------
    elongation
        Length less the free length [m], ascending.
    force
        The tension at each [N]; below zero it pushes.
    """

    elongation: Annotated[tuple[Number, ...], Field(min_length=2)]
    force: Annotated[tuple[Number, ...], Field(min_length=2)]

    @model_validator(mode="after")
    def _is_a_function(self) -> Self:
        if len(self.elongation) != len(self.force):
            raise problem(
                f"must have as many entries as elongation, {len(self.elongation)}",
                key="force",
                value=self.force,
            )
        pairs = zip(self.elongation, self.elongation[1:], strict=False)
        if any(a >= b for a, b in pairs):
            raise problem("must ascend", key="elongation", value=self.elongation)
        return self


class Spring(Description):
    """A spring and a damper, side by side, on the straight line between two places.

    Parameters
    ----------
    name
        Unique over bodies, obstacles, tracked points and springs. The history has its ``length``
        and the ``force`` in it, that of the damper included.
    between
        The two places; one of a body at least.
    stiffness
        Tension per elongation [N/m].
    force
        Tension over elongation, in place of a stiffness: of a rope, which only pulls, of a stop,
        which only pushes, of what gets stiffer.
    damping
        Tension per rate of the length [N s/m]; of no effect in load steps.
    free_length
        The length without tension [m]; None is that as the case is drawn.
    """

    name: Name
    between: tuple[Place, Place]
    stiffness: NonNegative | None = None
    force: ForceTable | None = None
    damping: NonNegative = 0.0
    free_length: NonNegative | None = None

    @model_validator(mode="after")
    def _acts(self) -> Self:
        if self.stiffness is not None and self.force is not None:
            raise problem("give a stiffness or a table of forces, not both", key="force")
        if not self.stiffness and self.force is None and not self.damping:
            raise problem("give a stiffness, a table of forces, or a damping")
        return self
