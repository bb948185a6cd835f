"""Bodies: deformable, rigid and reduced ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import (
    PER_DIMENSION,
    Description,
    InSpace,
    Name,
    Number,
    Positive,
    SpaceVector,
    Vector,
)
from carom.case.foreign_body import ForeignEntry
from carom.case.mesh import Ball, Disc, Mesh, Rectangle
from carom.case.signal import Signal
from carom.messages import known, problem


class InitialStress(Description):
    """The stress that a body is under where it is drawn, the same everywhere in it.

    It is Cauchy's stress there. As the body moves it stays with it, as a second Piola–Kirchhoff
    stress, beside what the law adds. Nothing needs to balance it: a static analysis finds the
    equilibrium in its first step, a dynamic one starts to move.

    Parameters
    ----------
    xx
        Normal stress along x [Pa], positive in tension.
    yy
        Along y [Pa].
    zz
        Along z [Pa]; around the axis of a body of revolution.
    xy
        Shear stress [Pa].
    yz
        Shear stress [Pa], in 3D.
    xz
        Shear stress [Pa], in 3D.
    """

    xx: Number = 0.0
    yy: Number = 0.0
    zz: Number = 0.0
    xy: Number = 0.0
    yz: Number = 0.0
    xz: Number = 0.0


class Region(Description):
    """Cells of a body that are of another material than the rest.

    They share their nodes with the rest: the materials are bonded. A cell is of one material: it is
    in one region at most, and some cell of the body is in none.

    Parameters
    ----------
    material
        Name of one of the scenario's materials.
    on
        Name of a set of cells of the mesh.
    corner
        In place of a set: the corner with the smallest coordinates of an upright box [m],
        shape [D]. Of the region are cells that have the mean of their nodes, as drawn, in it.
    size
        Sides of the box [m], shape [D].
    """

    material: str
    on: str | None = None
    corner: Vector | None = None
    size: Annotated[tuple[Positive, ...], PER_DIMENSION] | None = None

    @model_validator(mode="after")
    def _is_a_set_or_a_box(self) -> Self:
        box = [self.corner, self.size]
        if (self.on is None) != all(part is not None for part in box) or (
            self.on is not None and any(part is not None for part in box)
        ):
            raise problem("give a set of cells `on`, or `corner` and `size` of a box")
        return self


class Body(Description):
    """A deformable body.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    material
        Name of one of the scenario's materials.
    regions
        Cells that are of other materials.
    hypothesis
        What a body of the plane is in space: a slice of a long body (no strain across the plane),
        a sheet (no stress across it) or a body of revolution. In the last, x is the radius and y
        runs along the axis; masses, forces and energies are those of the whole body.
    formulation
        How the deformation follows from the displacements; mean-dilatation has one change of volume
        per quad4 or hex8 cell, so that nearly incompressible bodies do not lock.
    thickness
        Thickness in the third direction [m]; not used of a body of revolution.
    mass
        Mass matrix: consistent, or lumped to the nodes.
    mesh
        Reference geometry and its cells.
    initial_stress
        Stress that the body is under where it is drawn: residual stress, the tension of a bolt or a
        string. Its energy counts as stored. Not of plastic bodies, nor in plane stress. None is
        none.
    growth
        Linear strain by which the body would grow in all directions if nothing held it, a number or
        a function of time: for a body that is heated by ΔT, α ΔT. A static analysis applies in its
        first step what is there at t = 0; a dynamic one starts from none. None is none.
    contact_sets
        Sets of facets that may touch others, such as the sides of a rectangle; None for all.
    self_contact
        Whether the body may touch itself: its nodes its own facets, but those close to them. It may
        if nothing is said: a body that does not come near itself costs nothing.
    velocity
        Initial velocity of the centre of mass [m/s], shape [D]; None is none.
    spin
        Initial angular velocity about the centre of mass [rad/s]: a number in 2D, a vector in 3D.
    """

    kind: Literal["deformable"] = "deformable"
    name: Name
    material: str
    regions: tuple[Region, ...] = ()
    hypothesis: Literal["plane-strain", "plane-stress", "axisymmetric"] = "plane-strain"
    formulation: Literal["standard", "mean-dilatation"] = "standard"
    thickness: Positive = 1.0
    mass: Literal["consistent", "lumped"] = "consistent"
    mesh: Mesh
    initial_stress: InitialStress | None = None
    growth: Signal | None = None
    contact_sets: tuple[str, ...] | None = None
    self_contact: Annotated[bool | None, Field(strict=True)] = None
    velocity: Vector | None = None
    spin: Number | SpaceVector | None = None

    @model_validator(mode="after")
    def _what_repeats_itself_cannot_spin(self) -> Self:
        if isinstance(self.mesh, Rectangle) and self.mesh.periodic and self.spin:
            raise problem("a periodic body cannot spin; give 0", key="spin", value=self.spin)
        return self

    @model_validator(mode="after")
    def _contact_sets_exist(self) -> Self:
        _require_sets(self.mesh, self.contact_sets)
        return self


class RigidBody(Description):
    """A body that does not deform: the points of its mesh move as one.

    It can touch and be touched as a deformable body can. Its unknowns are how its centre of mass
    moves and how it turns; a body of revolution moves along its axis alone. It has no stress, and
    its cells show none.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    density
        Density [kg/m³], which with the cells of the mesh makes mass, centre and inertia; of a body
        that is `round` with the disc or ball.
    mass
        Mass [kg], in place of a density.
    inertia
        Inertia about the centre of mass [kg m²] where it is not that of the cells, or of the disc
        or ball of a body that is `round`: a number in 2D, in 3D the moments about the axes of space
        if these are principal, or three rows of three.
    hypothesis
        What a body of the plane is in space: plane-strain for a slice of `thickness`, or
        axisymmetric, a body of revolution around x = 0.
    thickness
        Thickness in the third direction [m]; not used of a body of revolution.
    mesh
        Reference geometry and its cells.
    round
        Whether the body, whose mesh is a disc or a ball, is as round as that to planes, spheres and
        cylinders, and to other round bodies, and has the mass and inertia of that. To all others it
        is its mesh.
    contact_sets
        Sets of facets that may touch others, such as the sides of a rectangle; None for all.
    velocity
        Initial velocity of the centre of mass [m/s], shape [D]; None is none.
    spin
        Initial angular velocity [rad/s]: a number in 2D, a vector in 3D.
    """

    kind: Literal["rigid"] = "rigid"
    name: Name
    density: Positive | None = None
    mass: Positive | None = None
    inertia: Positive | SpaceVector | Annotated[tuple[SpaceVector, ...], InSpace] | None = None
    hypothesis: Literal["plane-strain", "axisymmetric"] = "plane-strain"
    thickness: Positive = 1.0
    mesh: Mesh
    round: Annotated[bool, Field(strict=True)] = False
    contact_sets: tuple[str, ...] | None = None
    velocity: Vector | None = None
    spin: Number | SpaceVector | None = None

    @model_validator(mode="after")
    def _has_one_mass(self) -> Self:
        if self.density is None and self.mass is None:
            raise problem("required key is missing; give it, or the mass", key="density")
        if self.density is not None and self.mass is not None:
            raise problem(
                "a rigid body has a density or a mass, not both; leave one out",
                key="mass",
                value=self.mass,
            )
        return self

    @model_validator(mode="after")
    def _is_as_round_as_its_mesh(self) -> Self:
        if self.round and not isinstance(self.mesh, Disc | Ball):
            what = "is of bodies whose mesh is a disc or a ball; leave it out"
            raise problem(what, key="round", value=True)
        return self

    @model_validator(mode="after")
    def _is_not_periodic(self) -> Self:
        if isinstance(self.mesh, Rectangle) and self.mesh.periodic:
            raise problem(
                "a rigid body cannot be periodic; leave it out", key="mesh.periodic", value=True
            )
        return self

    @model_validator(mode="after")
    def _contact_sets_exist(self) -> Self:
        _require_sets(self.mesh, self.contact_sets)
        return self


class ReducedBody(Description):
    """An elastic body that is reduced to few shapes, in which it vibrates as it flies and turns.

    It keeps the nodes of its contact surface, each with the shape that the body takes where it
    alone moves, and the lowest modes of the body with these nodes held (Craig and Bampton). It is
    linear in the frame that moves and turns with it: for stiff parts whose strain is small, and
    whose spin is slow beside their lowest frequency. Gravity and contacts are all that acts on it.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    material
        Name of one of the scenario's materials, an elastic one; its stiffness without strain
        counts. Of damping it has that of the stiffness.
    regions
        Cells that are of other materials, which are damped alike.
    modes
        Number of modes beside the shapes of its contact surface.
    hypothesis
        What a body of the plane is in space: a slice of a long body (no strain across the plane) or
        a sheet (no stress across it).
    formulation
        How the deformation follows from the displacements: see deformable bodies.
    thickness
        Thickness in the third direction [m].
    mass
        Mass matrix: consistent, or lumped to the nodes.
    mesh
        Reference geometry and its cells.
    contact_sets
        Sets of facets that may touch others; None for all. Every node of them is kept with the
        shapes of its displacements, so name no more than may touch.
    velocity
        Initial velocity of the centre of mass [m/s], shape [D]; None is none.
    spin
        Initial angular velocity about the centre of mass [rad/s]: a number in 2D, a vector in 3D.
    """

    kind: Literal["reduced"] = "reduced"
    name: Name
    material: str
    regions: tuple[Region, ...] = ()
    modes: Annotated[int, Field(strict=True, ge=0)]
    hypothesis: Literal["plane-strain", "plane-stress"] = "plane-strain"
    formulation: Literal["standard", "mean-dilatation"] = "standard"
    thickness: Positive = 1.0
    mass: Literal["consistent", "lumped"] = "consistent"
    mesh: Mesh
    contact_sets: tuple[str, ...] | None = None
    velocity: Vector | None = None
    spin: Number | SpaceVector | None = None

    @model_validator(mode="after")
    def _is_not_periodic(self) -> Self:
        if isinstance(self.mesh, Rectangle) and self.mesh.periodic:
            raise problem(
                "a reduced body cannot be periodic; leave it out", key="mesh.periodic", value=True
            )
        return self

    @model_validator(mode="after")
    def _contact_sets_exist(self) -> Self:
        _require_sets(self.mesh, self.contact_sets)
        return self


def materials_of(body: AnyBody) -> tuple[str, ...]:
    """Return the names of the materials of a body: that of the rest, then those of its regions."""
    if isinstance(body, RigidBody | ForeignEntry):
        return ()
    return (body.material, *(region.material for region in body.regions))


DescribedBody = Annotated[Body | RigidBody | ReducedBody, Field(discriminator="kind")]
"""A body that plain data describe."""

AnyBody = Annotated[Body | RigidBody | ReducedBody | ForeignEntry, Field(discriminator="kind")]
"""A body of any kind."""


def with_kinds(data: object) -> object:
    """Return a table of the case file whose bodies, where they name no kind, are deformable."""
    bodies = data.get("bodies") if isinstance(data, Mapping) else None
    if not isinstance(data, Mapping) or not isinstance(bodies, list | tuple):
        return data
    return {**data, "bodies": [of_kind(body) for body in bodies]}


def of_kind(body: Any) -> Any:  # noqa: ANN401 (checked where it is used)
    """Return a body that, where it names no kind, is deformable, and the entry of a foreign one."""
    if callable(entry := getattr(body, "as_entry", None)):
        return entry()
    if isinstance(body, Mapping) and "kind" not in body:
        return {"kind": "deformable", **body}
    return body


def _require_sets(mesh: Mesh, names: tuple[str, ...] | None) -> None:
    """Refuse sets of facets that the mesh does not have."""
    sets = mesh.facet_sets
    for name in names or ():
        if sets is not None and name not in sets:
            what = f"no such set of facets; {known(name, sets)}"
            raise problem(what, key="contact_sets", value=name)
