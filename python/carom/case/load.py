"""Forces on bodies, as functions of time."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from carom.case.description import Description
from carom.case.signal import Signal, SignalVector


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


Load = Annotated[Force | Traction | Pressure, Field(discriminator="kind")]
