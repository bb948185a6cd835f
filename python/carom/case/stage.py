"""Stages: analyses in sequence, and what changes from one to the next."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator
from typing_extensions import Self

from carom.case.analysis import Analysis, with_kind
from carom.case.contact import Condition
from carom.case.description import Description, Name, Number, Positive, SpaceVector, Vector
from carom.case.friction import Friction
from carom.case.load import Load
from carom.case.motion import Motion
from carom.messages import problem


class RemovedLoad(Description):
    """Loads that act no longer.

    Parameters
    ----------
    kind
        Their kind.
    body
        Name of the body.
    on
        Name of the set that they act on.
    """

    kind: Literal["force", "traction", "pressure"]
    body: str
    on: str


class RemovedMotion(Description):
    """Supports that are there no longer: what they held is free.

    Parameters
    ----------
    body
        Name of the body.
    on
        Name of the set that they hold or move.
    """

    body: str
    on: str


class GivenVelocity(Description):
    """The velocity that a body is given when a stage starts, as by a blow.

    The work of that is in the ledger as ``external``. Nodes that are held move as prescribed.

    Parameters
    ----------
    body
        Name of the body.
    velocity
        Velocity of the centre of mass [m/s], shape [D]; None is none.
    spin
        Angular velocity about the centre of mass [rad/s]: a number in 2D, a vector in 3D.
    """

    body: str
    velocity: Vector | None = None
    spin: Number | SpaceVector | None = None

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if self.velocity is None and self.spin is None:
            raise problem("give velocity or spin; [0, 0] stops the body")
        return self


class StagePair(Description):
    """What one pair does differently from a stage on.

    Parameters
    ----------
    between
        Names of two bodies, or of a body and an obstacle.
    friction
        Coulomb's coefficient, or a law: see `Contact`.
    """

    between: tuple[str, ...]
    friction: Friction

    @model_validator(mode="after")
    def _of_two(self) -> Self:
        if len(self.between) != 2:
            raise problem("must be two names", key="between", value=self.between)
        return self


class StageContact(Description):
    """What of the law of contact is another from a stage on.

    Parameters
    ----------
    condition
        Where in time a dynamic stage writes the unilateral condition, see `Contact`; None
        is as before. A static stage rules the gap at the end of the step.
    friction
        Friction of every pair that has none of its own, see `Contact`; None is as before.
    pairs
        Friction of single pairs.
    """

    condition: Condition | None = None
    friction: Friction | None = None
    pairs: tuple[StagePair, ...] = ()

    @model_validator(mode="after")
    def _changes_something(self) -> Self:
        if self.condition is None and self.friction is None and not self.pairs:
            raise problem("changes nothing; give condition, friction or pairs, or leave it out")
        return self


class StageOutput(Description):
    """How often a stage is recorded, counted from its start.

    Parameters
    ----------
    fields_every
        Time between two frames of fields [s]; None takes that of `Output`, or else a 200th of the
        stage. There is one at the end of every stage.
    history_every
        Time between two rows of history [s]; None takes that of `Output`, or else a 1000th of the
        stage. There is one at the end of every stage.
    """

    fields_every: Positive | None = None
    history_every: Positive | None = None

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if self.fields_every is None and self.history_every is None:
            raise problem("says nothing; give fields_every or history_every, or leave it out")
        return self


class Stage(Description):
    """An analysis among several of a case, which goes on where the one before ended.

    Time runs on, and functions of time see the time of the case. What a stage does not name goes
    on as before: loads, supports, gravity, friction. Bodies keep displacements, velocities, plastic
    strain and contact forces. A static stage ends the motion that it starts with; what that had of
    energy is in the ledger as ``scheme``.

    Parameters
    ----------
    name
        Unique among the stages.
    analysis
        How the motion is computed. Its ``end_time`` is on the clock of the case, on which the stage
        starts where the one before ended. ``gravity`` that is left out goes on as before.
    loads
        Forces on bodies from here on. They take the place of those of the same kind on the same
        set; all others go on.
    removed_loads
        Loads that end here.
    motions
        Prescribed motion from here on. It takes the place of all that is prescribed on the same
        set; what is prescribed elsewhere goes on. Displacements are those since the stage started,
        0 there, and what is fixed stays where it is.
    removed_motions
        Supports that end here.
    contact
        What of the law of contact is another from here on; None is as before.
    velocities
        Velocities that bodies are given when the stage starts, which is dynamic.
    output
        How often this stage is recorded; None is as the case says.
    """

    name: Name
    analysis: Analysis
    loads: tuple[Load, ...] = ()
    removed_loads: tuple[RemovedLoad, ...] = ()
    motions: tuple[Motion, ...] = ()
    removed_motions: tuple[RemovedMotion, ...] = ()
    contact: StageContact | None = None
    velocities: tuple[GivenVelocity, ...] = ()
    output: StageOutput | None = None

    @model_validator(mode="before")
    @classmethod
    def _kind_of_analysis(cls, data: object) -> object:
        """Take an analysis that names no kind for dynamic, as that of a case is."""
        return with_kind(data)

    @model_validator(mode="after")
    def _suits_its_kind(self) -> Self:
        if self.analysis.kind != "static":
            return self
        if self.velocities:
            raise problem(
                "a static stage knows no velocities; leave them out, or make the stage dynamic",
                key="velocities",
            )
        condition = None if self.contact is None else self.contact.condition
        if condition not in (None, "gap"):
            raise problem(
                "a static stage rules the gap at the end of the step; leave the condition out",
                key="contact.condition",
                value=condition,
            )
        return self
