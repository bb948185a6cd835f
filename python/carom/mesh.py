"""Meshes that carom generates.

Every class says of which ``dimension`` its bodies are and what ``facet_sets`` they have; None is
what only the mesh itself can tell.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.description import (
    Count,
    Description,
    InPlane,
    InSpace,
    PlaneVector,
    Positive,
    SpaceVector,
)
from carom.messages import problem

CellKind = Literal["quad4", "tri3"]
"""Four-node quadrilaterals, or three-node triangles (each quadrilateral cut in two)."""


class Disc(Description):
    """A disc meshed as an O-grid: a square core of n × n cells within rings of 4n cells.

    Its set of facets is ``surface``.

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

    dimension: ClassVar[int | None] = 2
    facet_sets: ClassVar[tuple[str, ...] | None] = ("all", "surface")

    kind: Literal["disc"] = "disc"
    centre: PlaneVector
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

    Its sets of facets are ``left``, ``right``, ``bottom`` and ``top``.

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

    dimension: ClassVar[int | None] = 2
    facet_sets: ClassVar[tuple[str, ...] | None] = ("all", "left", "right", "bottom", "top")

    kind: Literal["rectangle"] = "rectangle"
    corner: PlaneVector
    size: Annotated[tuple[Positive, ...], InPlane]
    divisions: Annotated[tuple[Count, ...], InPlane]
    cell: CellKind = "quad4"
    periodic: Annotated[bool, Field(strict=True)] = False


class Box(Description):
    """An upright box of equal eight-node hexahedra.

    Its sets of facets are ``left`` and ``right`` (smallest and largest x), ``front`` and ``back``
    (y), ``bottom`` and ``top`` (z).

    Parameters
    ----------
    corner
        Corner of the smallest coordinates [m], shape [3].
    size
        Sides [m], shape [3].
    divisions
        Cells along the sides, shape [3].
    """

    dimension: ClassVar[int | None] = 3
    facet_sets: ClassVar[tuple[str, ...] | None] = (
        *("all", "left", "right", "front", "back", "bottom", "top"),
    )

    kind: Literal["box"] = "box"
    corner: SpaceVector
    size: Annotated[tuple[Positive, ...], InSpace]
    divisions: Annotated[tuple[Count, ...], InSpace]


Mesh = Annotated[Disc | Rectangle | Box, Field(discriminator="kind")]
