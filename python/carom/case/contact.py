"""Contact and friction between bodies, and of bodies with obstacles."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.cohesion import Holding
from carom.case.description import Count, Description, Number, Positive, Share
from carom.case.friction import Friction
from carom.case.signal import Signal
from carom.messages import problem

Sources = Literal["finer", "first", "second", "both"]
"""Whose nodes are checked against the facets of the other body of a pair."""

Discretisation = Literal["node-to-segment", "mortar"]
"""How contact between two bodies is written: node by node, or in the mean over the surface."""

Restitution = Annotated[Number, Field(ge=0, le=1)]
"""Coefficient of restitution."""

Condition = Literal["gap", "midpoint", "endpoint", "massless"]
"""Where in time the unilateral condition is written."""


SolverName = Literal[
    "auto",
    "gauss-seidel",
    "gauss-seidel-enumerative",
    "gauss-seidel-alart-curnier",
    "uzawa",
    "projected-gradient",
    "admm",
    "proximal",
    "newton-alart-curnier",
    "newton-natural-map",
]
"""Solvers of contact problems, as in `carom.friction.SOLVERS`."""


class FrictionSolver(Description):
    """How the reduced contact problem of a step is solved, and when that counts as done.

    Parameters
    ----------
    kind
        Solver; ``carom.friction.solve`` knows the same.
    tolerance
        Relative residual, in the natural units of the problem, at which it is solved.
    max_iterations
        Iterations before the step counts as failed: sweeps over all contacts, or linear systems of
        Newton's method.
    cross_check
        Whether the last contact problem of every step is solved again, from the same start, by a
        solver that goes another way. Differences are reported; the run does not change.
    """

    kind: SolverName = "auto"
    tolerance: Positive = 1e-12
    max_iterations: Count = 10_000
    cross_check: Annotated[bool, Field(strict=True)] = False


class Pair(Description):
    """What one pair does differently.

    Parameters
    ----------
    between
        Names of two bodies, or of a body and an obstacle; twice that of a body that touches itself.
    friction
        Coulomb's coefficient, or a law: `StaticKinetic`, `RateAndState` or `FrictionFormula`, or
        `OrthotropicFriction`; None takes the default of `Contact`.
    restitution
        Coefficient of restitution e of two rigid bodies, or of a rigid one and an obstacle; None
        takes the default of `Contact`.
    cohesion
        What holds the two together: a stress [Pa] or a `Cohesion`; None takes the default of
        `Contact`, 0 is none.
    sources
        Whose nodes are checked, as seen from `between`; None takes the default of `Contact`.
    discretisation
        How contact between the two is written; None takes the default of `Contact`.
    interference
        By how much their surfaces are pushed apart [m], a number or a function of time: contact
        sees the gap less this, so that a shaft modelled line to line with its hub presses as if it
        were that much thicker. A static analysis applies in its first step what is there at t = 0;
        ``"20e-6*t"`` spreads it. Negative values are clearance: the two may be inside one another
        by as much. None is none.
    resolve_overlap
        Whether overlaps at the start are taken up; None takes the default of `Contact`.
    enabled
        Whether the two can touch at all.
    """

    between: tuple[str, ...]
    friction: Friction | None = None
    restitution: Restitution | None = None
    cohesion: Holding | None = None
    sources: Sources | None = None
    discretisation: Discretisation | None = None
    interference: Signal | None = None
    resolve_overlap: Annotated[bool | None, Field(strict=True)] = None
    enabled: Annotated[bool, Field(strict=True)] = True

    @model_validator(mode="after")
    def _of_two(self) -> Self:
        if len(self.between) != 2:
            raise problem("must be two names", key="between", value=self.between)
        return self


class Contact(Description):
    """The law of contact.

    Parameters
    ----------
    condition
        Where in time the unilateral condition is written. ``massless`` writes it on the gap at the
        end of the step, between nodes without mass. ``gap`` does so between nodes as they are, as
        in the paper and in every static analysis. ``midpoint`` writes it on the increment over the
        step, ``endpoint`` on the velocity at its end. With the scheme ``conserving``, ``massless``
        and ``midpoint`` keep the energy. Only ``massless`` is quiet besides; it takes more time.
        With ``theta`` it takes energy: there ``midpoint`` is the default, and where a case starts
        from the result of another.
        Bodies without cells inside, plastic, growing, rigid and reduced ones keep their mass; pairs
        whose sides both do are ruled as with ``midpoint``.
    friction
        Friction of every pair that does not state its own: Coulomb's coefficient, or a law by which
        it depends on the sliding, `StaticKinetic`, `RateAndState` or `FrictionFormula`, such as
        ``{ static = 0.6, kinetic = 0.3 }``. Bodies whose friction has a law keep their mass.
    restitution
        Coefficient of restitution e of every pair of what is rigid that does not state its own,
        with the condition ``endpoint``: what meets at v_n parts at -e v_n (Moreau), and friction
        acts against the velocity that is left. None is 0.
    cohesion
        What holds every pair together that does not state its own, where it touches: a tensile
        strength [Pa], or a `Cohesion`. Such pairs are checked from one side, `sources` or else the
        finer, and their bodies keep their mass. None is none.
    solver
        Solver of the reduced contact problem.
    sources
        Whose nodes are checked in a pair of bodies that does not state its own: those of both, of
        one side, or of the body with the finer boundary. If the boundaries are alike, it is the
        lighter one, or the first-named. Left out, it is both; of mortar pairs the finer.
    targets
        What they are checked against: a smooth curve, in space a smooth surface, through the
        boundary nodes of the other body, or the facets of its mesh. Curve and surface have a
        continuous tangent but for corners and edges of more than 40°, and along sides that are
        straight or flat without deformation. In the plane, cells of second order have facets.
    discretisation
        How contact is written between two bodies that do not state their own: as gaps of the nodes
        of the source, or (mortar) as means under their shape functions. Mortar carries a uniform
        pressure exactly between meshes that do not match. `targets` says what both sides are
        between their nodes. It takes one side as the source. Obstacles are always checked node by
        node.
    certificate_tolerance
        Largest distance from Coulomb's law in a step, the sum of bi-potential gaps. It is relative
        to the largest energy of the run or, where that is more, to the largest work of a step's
        reactions over the motion that they prevent. A run with a larger one is not completed.
    penetration_tolerance
        How deep bodies and obstacles that may touch may be inside one another, or bodies inside
        themselves, at the end of a step. It is relative to the diameter of the facet that is there.
        ``endpoint`` lets in what starts too near to be stopped: what is inside after the first step
        of a stage is allowed, up to half that diameter. So are the arcs that the facets of a round
        side stand for, and how far a round obstacle bulges into a facet no larger than its radius.
        A run that goes deeper is not completed.
    resolve_overlap
        Whether bodies may overlap one another, or obstacles, at the start of a static analysis. The
        overlap of every contact is then clearance at first, which falls linearly to zero: meshes
        that are drawn with their interference press on one another as they do when fitted.
    overlap_resolved_at
        When overlaps are taken up [s]; None is at the end of the analysis.
    pairs
        What single pairs do differently.
    """

    condition: Condition = "massless"
    friction: Friction = 0.0
    restitution: Restitution | None = None
    cohesion: Holding | None = None
    solver: FrictionSolver = FrictionSolver()
    sources: Sources | None = None
    targets: Literal["smooth", "faceted"] = "smooth"
    discretisation: Discretisation = "node-to-segment"
    certificate_tolerance: Share = 1e-9
    penetration_tolerance: Positive = 0.01
    resolve_overlap: Annotated[bool, Field(strict=True)] = False
    overlap_resolved_at: Positive | None = None
    pairs: tuple[Pair, ...] = ()
