"""How the motion is computed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import Count, Description, Number, Positive, Vector
from carom.messages import problem


class Theta(Description):
    """The paper's first-order scheme.

    θ = ξ = ½ neither creates nor dissipates energy in linear problems; larger values dissipate.

    Parameters
    ----------
    theta
        Weight of the end of the step in the velocity, in (0, 1].
    xi
        Weight of the end of the step in the forces, in [0, 1].
    """

    kind: Literal["theta"] = "theta"
    theta: Annotated[Number, Field(gt=0, le=1)] = 0.5
    xi: Annotated[Number, Field(ge=0, le=1)] = 0.5


class Conserving(Description):
    """The energy–momentum scheme: the stress of a step does exactly the change of stored energy.

    θ = ξ = ½ with that stress. What normal reactions and friction do is left of the energy's
    change: with the contact condition ``"midpoint"``, friction alone.
    """

    kind: Literal["conserving"] = "conserving"


Scheme = Annotated[Theta | Conserving, Field(discriminator="kind")]


class Newton(Description):
    """Newton's iteration within a step.

    Parameters
    ----------
    tolerance
        Largest correction of a displacement in the last iteration, relative to the largest motion
        of a node in the step. With a larger one than 1e-3 a step would be no solution of its
        equation, and nothing else of the run would tell.
    max_iterations
        Iterations before the step counts as failed.
    """

    tolerance: Annotated[Number, Field(gt=0, le=1e-3)] = 1e-10
    max_iterations: Count = 50


class Dynamic(Description):
    """Motion in time.

    Parameters
    ----------
    end_time
        Time at which it ends [s].
    time_step
        Length of a step [s].
    scheme
        Time scheme.
    newton
        Newton's iteration.
    max_halvings
        How often a step that failed is halved before the run stops.
    gravity
        Acceleration of all bodies [m/s²], shape [D]; None is none.
    """

    kind: Literal["dynamic"] = "dynamic"
    end_time: Positive
    time_step: Positive
    scheme: Scheme = Conserving()
    newton: Newton = Newton()
    max_halvings: Annotated[int, Field(strict=True, ge=0, le=30)] = 8
    gravity: Vector | None = None

    @model_validator(mode="after")
    def _at_least_one_step(self) -> Self:
        _refuse_less_than_a_step(self)
        return self


class Static(Description):
    """Balance of forces without inertia, as loads and supports change with time.

    Time only says how far they have come. Each step balances the forces at its end; steps that
    fail are halved, and doubled again, up to `time_step`, after steps that were easy. The contact
    condition is ``"gap"``. Bodies that nothing holds but contact are allowed, if forces press them
    on; what friction does depends on the path, and so on the steps.

    Parameters
    ----------
    end_time
        Time at which it ends [s].
    time_step
        Largest length of a step [s].
    newton
        Newton's iteration.
    max_halvings
        How often a step that failed is halved before the run stops.
    stabilisation
        What a step does that finds no equilibrium near the last one, as where a body snaps through
        or loses its hold. With ``"none"`` it fails; with ``"dynamic"`` the bodies move on with
        inertia, as damped as the time scheme can make them, until they rest in another. The ledger
        has what that dissipates in `scheme`.
    gravity
        Acceleration of all bodies [m/s²], shape [D]; None is none.
    """

    kind: Literal["static"] = "static"
    end_time: Positive
    time_step: Positive
    newton: Newton = Newton()
    max_halvings: Annotated[int, Field(strict=True, ge=0, le=30)] = 12
    stabilisation: Literal["none", "dynamic"] = "none"
    gravity: Vector | None = None

    @model_validator(mode="after")
    def _at_least_one_step(self) -> Self:
        _refuse_less_than_a_step(self)
        return self


def _refuse_less_than_a_step(analysis: Dynamic | Static) -> None:
    """Refuse an analysis that is shorter than a step."""
    if analysis.end_time < analysis.time_step:
        raise problem(
            f"must be at least one time_step ({analysis.time_step:g} s)",
            key="end_time",
            value=analysis.end_time,
        )


Analysis = Annotated[Dynamic | Static, Field(discriminator="kind")]


def with_kind(data: object) -> object:
    """Return a table of the case file whose analysis, if it names no kind, is dynamic."""
    analysis = data.get("analysis") if isinstance(data, Mapping) else None
    if not isinstance(data, Mapping) or not isinstance(analysis, Mapping) or "kind" in analysis:
        return data
    return {**data, "analysis": {"kind": "dynamic", **analysis}}
