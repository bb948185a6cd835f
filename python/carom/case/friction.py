"""Friction between two surfaces: a coefficient, or a law by which it depends on the contact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import Discriminator, Field, Tag, model_validator
from typing_extensions import Self

from carom.case.description import Description, NonNegative, Number, Positive, SpaceVector
from carom.messages import problem

Coefficient = Annotated[Number, Field(ge=0, le=1000)]
"""Coulomb's coefficient."""


class StaticKinetic(Description):
    """Friction that holds more than it resists, and what is viscous in it.

    With neither `speed` nor `distance`, what sticks holds up to the static coefficient, and what
    slides has the kinetic one until it sticks again. What turns back within a step may stick there.

    Parameters
    ----------
    kinetic
        Coefficient μ_k of what slides.
    static
        Coefficient μ_s up to which what sticks holds; None is that of what slides.
    speed
        Slip speed v_s [m/s] over which the difference of both falls to 1/e (Stribeck): μ = μ_k +
        (μ_s - μ_k) exp(-v/v_s). Not in a static analysis.
    distance
        Critical distance D_c [m] of slip over which it falls linearly to zero (slip weakening),
        for every contact from the start of the run on, and for good.
    viscous
        By how much μ grows per slip speed [s/m]. Not in a static analysis.
    """

    kinetic: Coefficient
    static: Coefficient | None = None
    speed: Positive | None = None
    distance: Positive | None = None
    viscous: NonNegative = 0.0

    @model_validator(mode="after")
    def _is_a_law(self) -> Self:
        if self.speed is not None and self.distance is not None:
            raise problem(
                "static friction falls over a speed or over a distance; leave one out, or write a "
                "formula of v and s",
                key="distance",
                value=self.distance,
            )
        if self.static is None:
            for key in ("speed", "distance"):
                if getattr(self, key) is not None:
                    raise problem(
                        "there is no static friction that could fall; give it by static",
                        key=key,
                        value=getattr(self, key),
                    )
        elif self.speed is None and self.distance is None and self.static < self.kinetic:
            raise problem(
                f"is less than kinetic = {self.kinetic:g}: what sticks would slide and be held at "
                "once; give at least as much, or a speed or a distance over which friction grows",
                key="static",
                value=self.static,
            )
        return self


class RateAndState(Description):
    """Friction that depends on speed and age of a contact (Dieterich, Ruina).

    μ = μ_0 + a ln(1 + v/v*) + b ln(1 + θ v*/D_c), where the age θ [s] grows with time at rest and
    is forgotten over D_c of slip: dθ/dt = 1 - v θ/D_c. Not in a static analysis.

    Parameters
    ----------
    reference
        Coefficient μ_0 of fast sliding without the direct effect.
    direct
        Strength a of the direct effect of speed.
    evolution
        Strength b of the effect of age.
    speed
        Reference speed v* [m/s].
    distance
        Critical distance D_c [m].
    age
        Age of a contact that is new [s]; None is D_c/v*.
    """

    reference: Coefficient
    direct: NonNegative
    evolution: NonNegative
    speed: Positive
    distance: Positive
    age: NonNegative | None = None


class FrictionFormula(Description):
    """A friction coefficient as a formula.

    Parameters
    ----------
    formula
        μ of the slip speed ``v`` in m/s, of the distance ``s`` in m that a contact has slid since
        the start of the run, whichever way, and of the pressure ``p`` in Pa, such as ``"0.2 +
        0.1*exp(-v/0.05)"``, or ``"min(0.3, 2e8/p)"`` for a shear that has a limit, with the
        functions of a signal. Between 0 and 1000, and continuous; at v = 0 it is what holds. A
        static analysis knows no ``v``; ``p`` is not known of cells of second order, round bodies
        and bodies of other codes.
    """

    formula: str


def _form_of_one(value: object) -> str:
    """Return which of the forms of a direction's friction a value has."""
    if isinstance(value, FrictionFormula) or (isinstance(value, Mapping) and "formula" in value):
        return "[formula]"
    return "[law]" if isinstance(value, Mapping | StaticKinetic) else "[coefficient]"


OfDirection = Annotated[
    Annotated[Number, Field(gt=0, le=1000), Tag("[coefficient]")]
    | Annotated[StaticKinetic, Tag("[law]")]
    | Annotated[FrictionFormula, Tag("[formula]")],
    Discriminator(_form_of_one),
]
"""Friction of one direction: a coefficient, or a law that does not jump."""


class OrthotropicFriction(Description):
    """Friction that depends on the direction, of pairs in space.

    Tangential reactions stay within an ellipse, (r₁/μ₁)² + (r₂/μ₂)² ≤ rₙ², and what slides goes
    along its normal, (r₁/μ₁², r₂/μ₂²): of all reactions in the ellipse the one that dissipates
    most.

    Parameters
    ----------
    along
        Coefficient μ₁ along `direction`, greater than 0, or a law of it: a `FrictionFormula`, or
        `StaticKinetic` with a speed or a distance. Laws know the speed and distance of slip
        whichever way it goes.
    across
        Coefficient μ₂ across it, likewise.
    direction
        Direction in the reference configuration, of any length, shape [3]. Its part along the
        surface counts.
    of
        Name of the one of the pair that carries it: a body, with which it turns and deforms as a
        line drawn on its surface, or an obstacle.
    """

    along: OfDirection
    across: OfDirection
    direction: SpaceVector
    of: str


def _form(value: object) -> str:
    """Return which of the forms of friction a value has."""
    if isinstance(value, FrictionFormula) or (isinstance(value, Mapping) and "formula" in value):
        return "[formula]"
    if isinstance(value, RateAndState) or (isinstance(value, Mapping) and "reference" in value):
        return "[rate and state]"
    if isinstance(value, OrthotropicFriction) or (isinstance(value, Mapping) and "along" in value):
        return "[orthotropic]"
    return "[law]" if isinstance(value, Mapping | StaticKinetic) else "[coefficient]"


Friction = Annotated[
    Annotated[Coefficient, Tag("[coefficient]")]
    | Annotated[StaticKinetic, Tag("[law]")]
    | Annotated[RateAndState, Tag("[rate and state]")]
    | Annotated[FrictionFormula, Tag("[formula]")]
    | Annotated[OrthotropicFriction, Tag("[orthotropic]")],
    Discriminator(_form),
]
"""Friction: Coulomb's coefficient, a law by which it depends on the contact, or an ellipse."""


FrictionLaw = StaticKinetic | RateAndState | FrictionFormula | OrthotropicFriction
"""Friction that is no coefficient."""


def friction_text(friction: float | FrictionLaw) -> str:
    """Return friction as a summary shows it."""
    if isinstance(friction, FrictionFormula):
        return friction.formula
    if isinstance(friction, OrthotropicFriction):
        along, across = friction_text(friction.along), friction_text(friction.across)
        return f"{along} along {list(friction.direction)} of {friction.of}, {across} across"
    if isinstance(friction, StaticKinetic | RateAndState):
        given = friction.model_dump(exclude_defaults=True)
        return ", ".join(f"{key} {value:g}" for key, value in given.items())
    return f"{friction:g}"
