"""Checks of the contacts of a stored step: their places, and Signorini's and Coulomb's laws."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, einsum, sizes
from carom.auditing.bodies.body import AuditBody
from carom.auditing.checks.holding import HoldingChecks
from carom.auditing.mesh.facets import grouped
from carom.auditing.model import AuditModel
from carom.auditing.report import Findings
from carom.auditing.steps.contacts import Contacts, all_forces
from carom.auditing.steps.ruled import Ruled
from carom.auditing.steps.scales import ROUND_OFF, SAFETY, Scales
from carom.auditing.steps.sliding import Coefficients, Sliding
from carom.auditing.steps.step import Step


class ContactChecks:
    """Checks of contacts, step after step.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    """

    def __init__(self, model: AuditModel, scales: Scales, findings: Findings) -> None:
        self._model, self._scales, self._findings = model, scales, findings
        self._check = findings.check
        self.sliding = Sliding(model, scales)
        self._holding = HoldingChecks(model, scales, findings)
        self._facet = min(_shortest(body) for body in model.bodies)

    def step(self, step: Step, where: str) -> tuple[float, float]:
        """Check a step; return its bi-potential gap, and how far that may be off [J]."""
        ruled = Ruled.of(step)
        friction = self.sliding.coefficients(step, ruled)
        if self._model.rubs_by_law and not self.sliding.known:
            self._findings.leave(
                "what friction laws remember: how far contacts had slid before a stored step",
                store="output.fields_every = the time step",
            )
        touching = step.touching
        self._places(touching.all, step.end, step, where)
        self._cone(touching.all, step, touching.whole_force, friction.whole + friction.doubt, where)
        if self._model.condition in ("gap", "massless") and not step.starts_elsewhere:
            # Of the other conditions the contacts before are where no stored state is.
            first = touching.first
            self._places(first, step.start, step, where)
            force = (first.normal_force, first.friction_force)
            self._cone(first, step, force, first.most_friction, where)
        if self._model.coheres:
            self._holding.step(step, ruled, self.turn(step), where)
        return self._laws(step, ruled, friction, where)

    def turn(self, step: Step) -> float:
        """Return how far normals may be off: places over the length of a facet."""
        return SAFETY * self._scales.geometry(step) / self._facet + ROUND_OFF

    def _places(self, found: Contacts, state: Mapping[str, Any], step: Step, where: str) -> None:
        self._check("pairs", [float(side is None) for side in found.side], 0.0, where)
        self._check("contact gaps", found.gap_error, self._scales.geometry(step), where)
        turn = self.turn(step)
        self._check("contact normals", found.normal_error, turn, where)
        parts = [step.touching.pressed, *step.touching.impulses] if state is step.end else [found]
        error = state["contact_force"] - all_forces(parts, len(self._model.points))
        if self._model.mixed and state is not step.end:
            # Where nodes have mass the state has reactions of other pairs too.
            for body in self._model.bodies:
                error[body.span] *= len(body.massless) > 0
        total = float(np.abs(found.reaction).sum())
        off = total * turn + self._scales.least_reaction(step.dt)
        self._check("nodal reactions", error, off, where)

    def _cone(
        self,
        found: Contacts,
        step: Step,
        force: tuple[Array, Array],
        friction: Array,
        where: str,
    ) -> None:
        """Check that normal and tangential forces are in the cones of these coefficients.

        Forces have the shapes [count] and [count, D], coefficients [count, 2].
        """
        size = np.linalg.norm(found.reaction, axis=1) + found.adhesion
        total = float(np.abs(found.reaction).sum() + found.adhesion.sum())
        off = size * self.turn(step) + self._scales.reaction(step, total)
        off += self._scales.least_reaction(step.dt)
        normal, across = force[0] + found.adhesion, force[1]
        self._check("Signorini: compression", np.maximum(-normal, 0.0), off, where)
        bounded = np.asarray(np.isfinite(friction).all(axis=1), dtype=bool)
        cone = found.cone(np.where(bounded[:, None], friction, 0.0))
        excess = cone.force(across) - cone.largest * normal
        excess = np.where(bounded, np.maximum(excess, 0.0), 0.0)
        off = off / cone.lengths.min(axis=1)
        self._check("Coulomb: cone", excess, off * (1 + cone.largest), where)

    def _laws(
        self, step: Step, ruled: Ruled, friction: Coefficients, where: str
    ) -> tuple[float, float]:
        found = step.touching.pressed
        signorini = ruled.normal * found.force_in_cone
        size = np.linalg.norm(found.reaction, axis=1) + found.adhesion
        off = size * self._scales.geometry(step)
        # A reaction that is round-off is one beside an open gap, too.
        rough = np.abs(ruled.normal) * self._scales.least_reaction(step.dt)
        self._check("Signorini: complementarity", signorini, off + rough, where)
        # Where a reaction is small, the solver's tolerance of it counts for more.
        slip = sizes(found.relative(step.d, found.shift)[1])
        total = float(np.abs(found.reaction).sum() + found.adhesion.sum())
        off += slip * self._scales.reaction(step, total)
        work = einsum("ki,ki->k", found.friction_force, ruled.across)
        cone = found.cone(friction.least)
        coulomb = cone.largest * found.force_in_cone * cone.slip(ruled.across) + work
        # Where μ is only bounded, friction takes no less than the least of it, and the cone says
        # that it takes no more.
        coulomb = np.where(friction.fixed, coulomb, np.maximum(coulomb, 0.0))
        pressed = np.maximum(found.force_in_cone, 0.0)
        doubt = friction.doubt.max(axis=1) * pressed * sizes(ruled.across)
        self._check("Coulomb: slip", coulomb, off * (1 + cone.largest) + doubt, where)
        by_law = ~friction.fixed
        if by_law.any():
            force = (found.normal_force, found.friction_force)
            most = np.where(by_law[:, None], friction.most + friction.doubt, np.inf)
            self._cone(found, step, force, most, where)
        total = float(np.abs(signorini).sum() + np.abs(coulomb).sum())
        self._findings.report("largest bi-potential gap of a step", total, "J")
        return total, float(doubt.sum())


def _shortest(body: AuditBody) -> float:
    """Return the shortest distance between nodes of a facet that may touch [m]."""
    if not len(body.facets):
        return np.inf
    shortest = np.inf
    for _, _, facets in grouped(body.facets, body.dimension):
        nodes = body.points[facets]
        for a, b in combinations(range(nodes.shape[1]), 2):
            apart = np.linalg.norm(nodes[:, a] - nodes[:, b], axis=1)
            shortest = min(shortest, float(apart.min()))
    return shortest
