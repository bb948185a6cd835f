"""Forces on bodies, as functions of time."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import Description, InSpace, Vector
from carom.case.signal import Signal, SignalVector
from carom.messages import problem


class Force(Description):
    """The same force on every node of a set.

    Parameters
    ----------
    body
        Name of the body.
    on
        Name of a set of its mesh; ``"all"`` is every node.
    force
        Force on each node [N], shape [D]; numbers, formulas of ``t`` or tables.
    """

    kind: Literal["force"] = "force"
    body: str
    on: str
    force: SignalVector


class Traction(Description):
    """A force per area on the facets of a set, in a direction that stays.

    Parameters
    ----------
    body
        Name of the body.
    on
        Name of a set of facets of its mesh; ``"all"`` is the whole boundary.
    traction
        Force per area of the reference configuration [Pa], shape [D]; numbers, formulas of ``t``
        or tables.
    """

    kind: Literal["traction"] = "traction"
    body: str
    on: str
    traction: SignalVector


class Pressure(Description):
    """A pressure against the facets of a set.

    Parameters
    ----------
    body
        Name of the body.
    on
        Name of a set of facets of its mesh; ``"all"`` is the whole boundary.
    pressure
        The pressure [Pa], positive into the body; a number, a formula of ``t`` or a table.
    follower
        Whether it acts on the present area against the present normal, or on those of the
        reference configuration for ever.
    """

    kind: Literal["pressure"] = "pressure"
    body: str
    on: str
    pressure: Signal
    follower: Annotated[bool, Field(strict=True)] = False


class Resultant(Description):
    """A force and a moment on a rigid body, in directions that stay.

    Parameters
    ----------
    body
        Name of the rigid body.
    force
        The force [N], shape [D]; numbers, formulas of ``t`` or tables.
    moment
        The moment [N m]: in 2D a number, a formula of ``t`` or a table, in 3D one per axis.
    point
        Where the force acts, as the body is drawn [m], shape [D]: a point that moves with the body.
        None is its centre of mass.
    """

    kind: Literal["resultant"] = "resultant"
    body: str
    force: SignalVector | None = None
    moment: Signal | Annotated[tuple[Signal, ...], InSpace] | None = None
    point: Vector | None = None

    @property
    def on(self) -> str:
        """The set of the body that it acts on: none, as it acts on all of it."""
        return ""

    @model_validator(mode="after")
    def _acts(self) -> Self:
        if self.force is None and self.moment is None:
            raise problem("give a force or a moment")
        return self


Load = Annotated[Force | Traction | Pressure | Resultant, Field(discriminator="kind")]
