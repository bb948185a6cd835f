"""Deformable bodies."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import Description, Name, Number, Positive, SpaceVector, Vector
from carom.case.mesh import Mesh, Rectangle
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


class Body(Description):
    """A deformable body.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    material
        Name of one of the scenario's materials.
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

    name: Name
    material: str
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
        sets = self.mesh.facet_sets
        for name in self.contact_sets or ():
            if sets is not None and name not in sets:
                what = f"no such set of facets; {known(name, sets)}"
                raise problem(what, key="contact_sets", value=name)
        return self
