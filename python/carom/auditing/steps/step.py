"""One step, from its two states: the equation of motion, momenta, energy and Coulomb's law."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, cross
from carom.auditing.bodies.body import AuditBody
from carom.auditing.model import AuditModel
from carom.auditing.steps.contact_work import Works
from carom.auditing.steps.forces import Forces
from carom.auditing.steps.groups import Groups
from carom.auditing.steps.states import States
from carom.auditing.steps.touching import Touching
from carom.ledger_terms import TERMS, names

BODY_ENERGIES = ("kinetic", "strain", "external", "viscous", "plastic", "scheme")
"""Terms of the ledger that are sums over the bodies."""

CONNECTION_ENERGIES = ("springs", "dampers")
"""Terms of the ledger that are sums over springs and dampers."""


class Step(States):
    """A step as stored in ``audit.h5``, and what the auditor makes of it.

    Parameters
    ----------
    model
        The model.
    stored
        ``start``, ``end``, ``blend``, ``vibration`` and ``ledger``, see `carom.io.audit`.
    """

    def __init__(self, model: AuditModel, stored: Mapping[str, Any]) -> None:
        super().__init__(model, stored)
        self.touching = Touching(self)
        """Its contacts."""
        self.forces = Forces(self, self.touching)
        """The forces on its bodies."""
        self.work = Works(self, self.touching)
        """The work of its contacts."""
        self.groups = Groups(self, self.touching, self.forces, self.work)
        """Its bodies in contact."""

    def energy_terms(self) -> dict[str, float]:
        """Return the terms of the ledger of the step, each from its own definition [J]."""
        terms = {name: sum(body[name] for body in self.body_terms) for name in BODY_ENERGIES}
        terms.update(dict.fromkeys((*names("pair"), *CONNECTION_ENERGIES), 0.0))
        for name, energy in self.forces.pulling.terms.items():
            terms[name] += energy
        terms["prescribed"] += sum(body["prescribed"] for body in self.body_terms)
        for work in self.work.all:
            for name, values in work.terms.items():
                terms[name] += float(values.sum())
        return terms

    def untold(self, term: float) -> bool:
        """Return whether a term of the ledger depends on what only a code that is not there says.

        Such a term is no number.
        """
        return not self.model.whole and bool(np.isnan(term))

    @cached_property
    def body_terms(self) -> list[dict[str, float]]:
        """The terms of the ledger of every body, and what it received through contact [J]."""
        return [self._body_terms(i, body) for i, body in enumerate(self.model.bodies)]

    def _body_terms(self, index: int, body: AuditBody) -> dict[str, float]:
        model, f = self.model, self.forces.of[index]
        if model.static:
            return self._path_terms(index, body)
        u0, u1, v0, d = (a[body.span] for a in (self.u0, self.u1, self.v0, self.d))
        held, grown = model.supports[index].held, self.grown(body)
        end = self.end["velocity"][body.span]
        jump = self.v_scheme[body.span] - v0
        damped = float((f.viscous * d).sum())
        scheme = (model.theta - 0.5) * 2 * body.kinetic_energy(u0, jump)
        if body.rigid:
            rigid, v1 = self.rigid(body), self.v_scheme[body.span]
            scheme = rigid.taken_by_scheme(v0, v1, model.theta, self.dt)[0]
        elif body.modes is not None:
            reduced, v1 = self.reduced(body), self.v_scheme[body.span]
            scheme, damped = reduced.taken(v0, v1, self.weights)
        elif held.any():
            # What is held moves as it is given, not as the scheme would have it.
            free = np.where(held, 0.0, jump)
            scheme = (model.theta - 0.5) * float((free * body.mass.times(jump)).sum())
        scheme += (model.xi - 0.5) * float(((f.end - f.start) * d).sum())
        if model.blended:
            contact = f.missing - float(self.blend[index]) * f.available
            contact += float(self.repaid[index])
            if model.mixed:
                received = self.touching.moved.nodal_forces(len(model.points))[body.span]
                contact += self._received(body, received)
        else:
            force = np.zeros_like(model.points)
            for found in self.work.booked():
                force += found.nodal_forces(len(model.points))
            received = force[body.span]
            contact = self._received(body, received)
            # What rows that are static at the end of a step leave of its mean forces.
            b, moved = body.massless, np.where(held, 0.0, d)
            scheme += float(((received + f.loads - f.viscous - f.internal) * moved)[b].sum())
        return {
            "kinetic": body.kinetic_energy(u1, end) - body.kinetic_energy(u0, v0),
            "strain": body.strain_energy(u1, grown[1]) - body.strain_energy(u0, grown[0]),
            "external": float(((f.gravity + f.loads) * d).sum()),
            "viscous": damped,
            "plastic": body.plastic_work(u1, grown[1]),
            "scheme": scheme,
            "contact": contact,
            "connections": float((f.connections * d).sum()),
            "prescribed": self._supported(index, body) + body.work_of_growth((u0, u1), grown),
        }

    def _path_terms(self, index: int, body: AuditBody) -> dict[str, float]:
        """Return the same of a load step: of loads and normal reactions in its mean.

        `scheme` is what the mean lacks of balance inside the body.
        """
        f, held = self.forces.of[index], self.model.supports[index].held
        grown = self.grown(body)
        u0, u1, v0, d = (a[body.span] for a in (self.u0, self.u1, self.v0, self.d))
        # What moved before load steps began comes to rest with the first.
        kinetic = body.kinetic_energy(u0, v0)
        force = np.zeros_like(self.model.points)
        for found in self.work.booked():
            force += found.nodal_forces(len(self.model.points))
        contact = float(np.where(held, 0.0, force[body.span] * d).sum())
        lacking = (f.gravity + f.path_loads + f.connections - f.path) * d
        inside = float(np.where(held, 0.0, lacking).sum())
        given = -float(lacking[held].sum())
        if body.rigid:
            inside, given = self._guided_path(index, body, force[body.span])
        return {
            "kinetic": -kinetic,
            "strain": body.strain_energy(u1, grown[1]) - body.strain_energy(u0, grown[0]),
            "external": float(((f.gravity + f.path_loads) * d).sum()),
            "viscous": 0.0,
            "plastic": body.plastic_work(u1, grown[1]),
            "scheme": inside + kinetic + (0.0 if body.rigid else contact),
            "contact": contact,
            "connections": float((f.connections * d).sum()),
            "prescribed": body.work_of_growth((u0, u1), grown) + given,
        }

    def _guided_path(self, index: int, body: AuditBody, contact: Array) -> tuple[float, float]:
        """Return the work of all forces on a rigid body in a load step along what is free [J].

        And that of guides against them along what is guided.
        """
        f, rigid = self.forces.of[index], self.rigid(body)
        during = rigid.guiding.unheld(contact) + f.gravity + f.path_loads + f.connections
        moment = cross(rigid.arms[1], during).sum(axis=0)
        shifted, turned = during.sum(axis=0) * rigid.shift, moment * rigid.turn
        along, about = rigid.guiding.along, rigid.guiding.about
        free = float(shifted[~along].sum() + turned[~about].sum())
        return free, -float(shifted[along].sum() + turned[about].sum())

    def _supported(self, index: int, body: AuditBody) -> float:
        """Return the work of what holds a body in the step [J].

        Supports bear what the equation of motion leaves to them besides contact, which moves what
        is free alone. Where v₊ is not what the scheme makes of the motion, they give the rest.
        """
        f, held = self.forces.of[index], self.model.supports[index].held
        if body.rigid:
            return self.forces.guided(index)
        if not held.any():
            return 0.0
        v0, v1, v2, d = (a[body.span] for a in (self.v0, self.v_scheme, self.v1, self.d))
        gained = body.mass.times(v1 - v0)
        borne = f.internal + f.viscous - f.gravity - f.loads - f.connections
        # Of impulses at the end they bear what bodies cannot take there.
        kept = body.mass.times(v2 - v1) - self.touching.impulse(body)
        work = 0.5 * gained * (v0 + v1) + borne * d + 0.5 * kept * (v1 + v2)
        return float(work[held].sum())

    def _received(self, body: AuditBody, force: Array) -> float:
        """Return the work of a force over the step, and of impulses at its end [J].

        It is that on what of a body is free.
        """
        free = ~self.model.supports[self.model.bodies.index(body)].held
        mean = 0.5 * (self.v_scheme + self.v1)[body.span]
        work = force * self.d[body.span] + self.touching.impulse(body) * mean
        return float(work[free].sum())

    @property
    def left_over(self) -> Array:
        """What the groups have yet to give back after the step, [body_count] [J]."""
        return self.groups.left_over(self.body_terms)


def defect(terms: Mapping[str, float]) -> float:
    """Return the change of energy that the other terms of a step do not explain [J]."""
    return sum(term.sign * terms[term.name] for term in TERMS if term.name in terms)
