"""Cohesion of two surfaces: what holds them together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import Discriminator, Field, Tag, model_validator
from typing_extensions import Self

from carom.case.description import Description, NonNegative
from carom.messages import problem


class Cohesion(Description):
    """What holds two surfaces together where they touch.

    With the adhesion A of a contact, its normal reaction is no less than -A, and its friction no
    more than μ (r_n + A): Coulomb's cone is shifted. A contact that opens lets go at once, in the
    step in which it opens. So adhesion does no work: it has no energy of its own.

    Parameters
    ----------
    stress
        Tensile strength c of the interface [Pa]: A is c times the area of the source around its
        node, in the reference configuration. With friction the shear strength without pressure is
        μ c. Not of round bodies and of cells of second order.
    force
        A of every contact [N], whatever its area.
    unbreakable
        Whether nothing breaks the bond: what touches at the start then never parts nor slides, as
        if both were one, whatever `friction` says.
    lasting
        Whether a contact that closes in the run holds from then on too. Else only what touches at
        the start does, and once it has opened it never holds again.
    """

    stress: NonNegative | None = None
    force: NonNegative | None = None
    unbreakable: Annotated[bool, Field(strict=True)] = False
    lasting: Annotated[bool, Field(strict=True)] = False

    @model_validator(mode="after")
    def _holds_by_one(self) -> Self:
        if (self.stress is not None) + (self.force is not None) + self.unbreakable != 1:
            raise problem(
                "surfaces hold by a stress, by a force of every contact, or unbreakably; give one "
                'of "stress", "force" and "unbreakable"'
            )
        if self.unbreakable and self.lasting:
            raise problem(
                'what nothing breaks holds from the start on; leave one of "lasting" and '
                '"unbreakable" out',
                key="lasting",
                value=self.lasting,
            )
        return self


def _form(value: object) -> str:
    """Return which of the forms of cohesion a value has."""
    return "[cohesion]" if isinstance(value, Mapping | Cohesion) else "[stress]"


Holding = Annotated[
    Annotated[NonNegative, Tag("[stress]")] | Annotated[Cohesion, Tag("[cohesion]")],
    Discriminator(_form),
]
"""Cohesion: a stress [Pa], or more than that."""


def holds(cohesion: float | Cohesion | None) -> bool:
    """Return whether a cohesion is more than nothing."""
    if isinstance(cohesion, Cohesion):
        return cohesion.unbreakable or (cohesion.stress or cohesion.force or 0.0) > 0.0
    return bool(cohesion)
