"""A body of another code in a scenario."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

from pydantic import Field, PrivateAttr

from carom.case.description import Description, Name, Positive

CONTACT_SET = "contact"
"""The facets that may touch others, among the sets of a scenario."""


class GivenMesh(Description):
    """The mesh of a body of another code, which comes along with it."""

    dimension: ClassVar[int | None] = None
    facet_sets: ClassVar[tuple[str, ...] | None] = None

    kind: Literal["given"] = "given"


class ForeignEntry(Description):
    """A body of another code, as the case file of a run that has one tells of it.

    Its law is code and its mesh are arrays, which no file holds: it runs from Python alone, where a
    `carom.ForeignBody` is among the bodies of a scenario.

    Parameters
    ----------
    name
        Unique over bodies, obstacles and tracked points.
    thickness
        Thickness in the third direction [m], by which forces are pressures in the plane.
    mesh
        Where its cells come from: along with it.
    contact_sets
        Sets of facets that may touch others; None for all.
    self_contact
        Whether it may touch itself.
    """

    hypothesis: ClassVar[Literal["plane-strain"]] = "plane-strain"
    spin: ClassVar[None] = None
    velocity: ClassVar[None] = None

    kind: Literal["foreign"] = "foreign"
    name: Name
    thickness: Positive = 1.0
    mesh: GivenMesh = Field(default_factory=GivenMesh)
    contact_sets: tuple[str, ...] | None = None
    self_contact: bool = False

    _code: Any = PrivateAttr(default=None)

    @property
    def code(self) -> Any:  # noqa: ANN401 (a `carom.ForeignBody`, which is made of this)
        """Mass, law and mesh; None of an entry that was read from a file."""
        return self._code

    def with_code(self, code: object) -> ForeignEntry:
        """Return the same with its mass, law and mesh."""
        own = self.model_copy()
        own._code = code
        return own
