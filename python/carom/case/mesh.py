"""Meshes that carom generates, and those it reads from files.

Every class says of which ``dimension`` its bodies are and what ``facet_sets`` they have; None is
what only the mesh itself can tell.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from carom.case.description import (
    Count,
    Description,
    FilePath,
    InPlane,
    InSpace,
    PlaneVector,
    Positive,
    SpaceVector,
    Vector,
)
from carom.messages import problem

PlaneCell = Literal["quad4", "quad8", "quad9", "tri3", "tri6"]
"""Quadrilaterals and triangles, by their number of nodes."""

SolidCell = Literal["hex8", "hex20", "hex27", "tet4", "tet10"]
"""Hexahedra and tetrahedra, by their number of nodes."""

SweptCell = Literal["hex8", "hex20", "hex27", "tet4", "tet10", "wedge6", "wedge15"]
"""Cells of bodies that are a plane mesh in layers: wedges too."""


def _not_zero(axis: tuple[float, ...]) -> tuple[float, ...]:
    if not any(axis):
        raise ValueError("must not be the zero vector")
    return axis


def _enough_around(divisions: tuple[int, ...]) -> tuple[int, ...]:
    if divisions[0] < 3:
        raise ValueError("must begin with 3 cells around or more")
    return divisions


def _rings_of_equal_width(mesh: _Round) -> _Round:
    if mesh.rings is None and mesh.divisions % 2:
        raise problem(
            f"must be even (take {mesh.divisions + 1}), or give rings",
            key="divisions",
            value=mesh.divisions,
        )
    return mesh


def _radii_grow(mesh: _Hollow) -> _Hollow:
    if mesh.outer_radius <= mesh.inner_radius:
        raise problem(
            f"must be greater than inner_radius ({mesh.inner_radius:g} m)",
            key="outer_radius",
            value=mesh.outer_radius,
        )
    return mesh


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
    cell: PlaneCell = "quad4"

    _check = model_validator(mode="after")(_rings_of_equal_width)


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
    cell: PlaneCell = "quad4"
    periodic: Annotated[bool, Field(strict=True)] = False


class Ring(Description):
    """The plane between two circles of one centre.

    Its sets of facets are ``inner`` and ``outer``.

    Parameters
    ----------
    centre
        Centre [m], shape [2].
    inner_radius
        Radius of the hole [m].
    outer_radius
        Radius of the outer circle [m].
    divisions
        Cells around, 3 or more, and from the inside to the outside, shape [2].
    cell
        Kind of cell.
    """

    dimension: ClassVar[int | None] = 2
    facet_sets: ClassVar[tuple[str, ...] | None] = ("all", "inner", "outer")

    kind: Literal["ring"] = "ring"
    centre: PlaneVector
    inner_radius: Positive
    outer_radius: Positive
    divisions: Annotated[tuple[Count, ...], InPlane, AfterValidator(_enough_around)]
    cell: PlaneCell = "quad4"

    _check = model_validator(mode="after")(_radii_grow)


class Box(Description):
    """An upright box of equal cells.

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
    cell
        Kind of cell; tetrahedra are six to a hexahedron, wedges two.
    """

    dimension: ClassVar[int | None] = 3
    facet_sets: ClassVar[tuple[str, ...] | None] = (
        *("all", "left", "right", "front", "back", "bottom", "top"),
    )

    kind: Literal["box"] = "box"
    corner: SpaceVector
    size: Annotated[tuple[Positive, ...], InSpace]
    divisions: Annotated[tuple[Count, ...], InSpace]
    cell: SweptCell = "hex8"


class Ball(Description):
    """A ball meshed as an O-grid: a cubic core of n³ cells within shells of 6n² cells.

    Its set of facets is ``surface``.

    Parameters
    ----------
    centre
        Centre [m], shape [3].
    radius
        Radius [m].
    divisions
        Cells along an edge of the core; even unless `rings` is given.
    rings
        Shells around the core; None is half of `divisions`.
    cell
        Kind of cell; tetrahedra are six to a hexahedron.
    """

    dimension: ClassVar[int | None] = 3
    facet_sets: ClassVar[tuple[str, ...] | None] = ("all", "surface")

    kind: Literal["ball"] = "ball"
    centre: SpaceVector
    radius: Positive
    divisions: Count
    rings: Count | None = None
    cell: SolidCell = "hex8"

    _check = model_validator(mode="after")(_rings_of_equal_width)


class Cylinder(Description):
    """A solid cylinder: layers of a disc meshed as an O-grid.

    Its sets of facets are ``bottom``, ``top`` and ``side``.

    Parameters
    ----------
    base
        Centre of the bottom [m], shape [3].
    axis
        Direction from the bottom to the top, of any length, shape [3].
    radius
        Radius [m].
    height
        Distance between bottom and top [m].
    divisions
        Cells along a side of the core; even unless `rings` is given.
    rings
        Rings around the core; None is half of `divisions`.
    layers
        Cells along the axis.
    cell
        Kind of cell; tetrahedra are six to a hexahedron, wedges two.
    """

    dimension: ClassVar[int | None] = 3
    facet_sets: ClassVar[tuple[str, ...] | None] = ("all", "bottom", "top", "side")

    kind: Literal["cylinder"] = "cylinder"
    base: SpaceVector
    axis: Annotated[SpaceVector, AfterValidator(_not_zero)] = (0.0, 0.0, 1.0)
    radius: Positive
    height: Positive
    divisions: Count
    rings: Count | None = None
    layers: Count
    cell: SweptCell = "hex8"

    _check = model_validator(mode="after")(_rings_of_equal_width)


class Tube(Description):
    """A tube: layers of a ring.

    Its sets of facets are ``inner``, ``outer``, ``bottom`` and ``top``.

    Parameters
    ----------
    base
        Centre of the bottom [m], shape [3].
    axis
        Direction from the bottom to the top, of any length, shape [3].
    inner_radius
        Radius of the hole [m].
    outer_radius
        Radius of the outside [m].
    height
        Distance between bottom and top [m].
    divisions
        Cells around, 3 or more, from the inside to the outside, and along the axis, shape [3].
    cell
        Kind of cell; tetrahedra are six to a hexahedron, wedges two.
    """

    dimension: ClassVar[int | None] = 3
    facet_sets: ClassVar[tuple[str, ...] | None] = ("all", "inner", "outer", "bottom", "top")

    kind: Literal["tube"] = "tube"
    base: SpaceVector
    axis: Annotated[SpaceVector, AfterValidator(_not_zero)] = (0.0, 0.0, 1.0)
    inner_radius: Positive
    outer_radius: Positive
    height: Positive
    divisions: Annotated[tuple[Count, ...], InSpace, AfterValidator(_enough_around)]
    cell: SweptCell = "hex8"

    _check = model_validator(mode="after")(_radii_grow)


class MeshFile(Description):
    """A mesh from a file: Gmsh, Abaqus, VTK, MED, Exodus and what else meshio reads.

    Physical groups and sets of nodes, elements and surfaces become the sets of the body under
    their names. Cells of fewer dimensions than the case count only as members of sets. With
    Gmsh installed (``pip install "carom[gmsh]"``) geometries (``.geo``, ``.step``, ``.brep``) are
    meshed, with quadratic cells unless the script says otherwise.

    Parameters
    ----------
    file
        The file; in a case file a path relative to it.
    body
        Physical group or set of cells that makes the body; None takes all cells.
    scale
        What coordinates are multiplied by to be in metres: 0.001 for a file in millimetres.
    move
        By how much the body is moved from where the file has it, after scaling [m], shape [D]; None
        is not at all.
    """

    dimension: ClassVar[int | None] = None
    facet_sets: ClassVar[tuple[str, ...] | None] = None

    kind: Literal["file"] = "file"
    file: FilePath
    body: str | None = None
    scale: Positive = 1.0
    move: Vector | None = None


_Round = Disc | Ball | Cylinder
_Hollow = Ring | Tube


def _file_is_a_kind(mesh: object) -> object:
    if isinstance(mesh, Mapping) and "file" in mesh and "kind" not in mesh:
        return {"kind": "file", **mesh}
    return mesh


Mesh = Annotated[
    Annotated[
        Disc | Rectangle | Ring | Box | Ball | Cylinder | Tube | MeshFile,
        Field(discriminator="kind"),
    ],
    BeforeValidator(_file_is_a_kind),
]
"""A table with a ``file`` is of the kind "file"."""
