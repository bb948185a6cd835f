"""Prescribed motion: supports of bodies, and how obstacles move."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import Description
from carom.case.signal import Signal
from carom.messages import problem


class Displacement(Description):
    """A displacement over time, by components; those left out are zero.

    Parameters
    ----------
    x
        Along x [m], 0 at t = 0: a number, a formula of ``t`` or a table.
    y
        Along y [m], likewise.
    z
        Along z [m], likewise.
    """

    x: Signal | None = None
    y: Signal | None = None
    z: Signal | None = None

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.x is None and self.y is None and self.z is None:
            raise problem("give one of x, y, z at least")
        return self


class Fixed(Description):
    """A set of nodes that does not move from where it is.

    Parameters
    ----------
    body
        Name of the body.
    on
        Name of a set of its mesh.
    components
        Components of the displacement that are held; None is all. The others are free.
    """

    kind: Literal["fixed"] = "fixed"
    body: str
    on: str
    components: tuple[Literal["x", "y", "z"], ...] | None = None


class Prescribed(Description):
    """A set of nodes whose displacement is given; components that are left out are free.

    The work of what moves them is in the ledger as ``prescribed``, and its force in the history
    as ``BODY.SET.force_x`` and so on.

    Parameters
    ----------
    body
        Name of the body.
    on
        Name of a set of its mesh.
    x
        Displacement along x [m], 0 at t = 0, or where the stage starts that names it: a number, a
        formula of ``t`` or a table.
    y
        Displacement along y [m], likewise.
    z
        Displacement along z [m], likewise.
    """

    kind: Literal["prescribed"] = "prescribed"
    body: str
    on: str
    x: Signal | None = None
    y: Signal | None = None
    z: Signal | None = None

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.x is None and self.y is None and self.z is None:
            raise problem("give one of x, y, z at least; those left out are free")
        return self


class Guided(Description):
    """The part of the motion of a rigid body that is given; what is left out is free.

    The work of what guides it is in the ledger as ``prescribed``, and its force in the history as
    ``BODY.force_x`` and so on.

    Parameters
    ----------
    body
        Name of the rigid body.
    x
        Displacement of the centre of mass along x [m], 0 at t = 0, or where the stage starts that
        names it: a number, a formula of ``t`` or a table.
    y
        Displacement along y [m], likewise.
    z
        Displacement along z [m], likewise.
    turn_x
        Angle by which the body has turned about x [rad], likewise; in 3D.
    turn_y
        Angle about y [rad], likewise; in 3D.
    turn_z
        Angle about z [rad], likewise. Where a body turns about several axes at once, these are the
        turns of every time step.
    """

    kind: Literal["guided"] = "guided"
    body: str
    x: Signal | None = None
    y: Signal | None = None
    z: Signal | None = None
    turn_x: Signal | None = None
    turn_y: Signal | None = None
    turn_z: Signal | None = None

    @property
    def on(self) -> str:
        """The set of the body that it moves: none, as it moves all of it."""
        return ""

    @model_validator(mode="after")
    def _moves(self) -> Self:
        given = (self.x, self.y, self.z, self.turn_x, self.turn_y, self.turn_z)
        if all(signal is None for signal in given):
            raise problem(
                "give one of x, y, z, turn_x, turn_y, turn_z at least; those left out are free"
            )
        return self


Motion = Annotated[Fixed | Prescribed | Guided, Field(discriminator="kind")]
