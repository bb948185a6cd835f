"""Meshes that carom generates."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.description import PER_DIMENSION, Count, Description, Positive, Vector
from carom.messages import problem

CellKind = Literal["quad4", "tri3"]
"""Four-node quadrilaterals, or three-node triangles (each quadrilateral cut in two)."""


class Disc(Description):
    """A disc meshed as an O-grid: a square core of n × n cells within rings of 4n cells.

    Parameters
    ----------
    centre
        Centre [m], shape [2].
    radius
        Radius [m].
    divisions
        Cells along a side of the core; even unless `rings` is given.
    rings
        Rings around the core; None is half of `divisions`.
    cell
        Kind of cell.
    """

    kind: Literal["disc"] = "disc"
    centre: Vector
    radius: Positive
    divisions: Count
    rings: Count | None = None
    cell: CellKind = "quad4"

    @model_validator(mode="after")
    def _rings_of_equal_width(self) -> Self:
        if self.rings is None and self.divisions % 2:
            raise problem(
                f"must be even (take {self.divisions + 1}), or give rings",
                key="divisions",
                value=self.divisions,
            )
        return self


class Rectangle(Description):
    """An upright rectangle of equal cells.

    Parameters
    ----------
    corner
        Lower left corner [m], shape [2].
    size
        Width and height [m], shape [2].
    divisions
        Cells along the width and the height, shape [2].
    cell
        Kind of cell.
    periodic
        Whether the right side moves as the left one does: the body repeats itself along x and
        cannot spin. Nothing else repeats itself, and contact is looked for with this period only.
    """

    kind: Literal["rectangle"] = "rectangle"
    corner: Vector
    size: Annotated[tuple[Positive, ...], PER_DIMENSION]
    divisions: Annotated[tuple[Count, ...], PER_DIMENSION]
    cell: CellKind = "quad4"
    periodic: Annotated[bool, Field(strict=True)] = False


Mesh = Annotated[Disc | Rectangle, Field(discriminator="kind")]
