"""One step, from its two states: the equation of motion, momenta, energy and Coulomb's law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from carom.audit import contacts
from carom.audit.arrays import Array, cross, rotation, turned
from carom.audit.body import STEADYING, AuditBody
from carom.audit.contacts import Contacts
from carom.audit.model import AuditModel


@dataclass(frozen=True)
class BodyForces:
    """Forces on the nodes of a body in a step [N], each of shape [node_count, 2].

    Parameters
    ----------
    inertia
        M (v₁ − v₀)/Δt.
    gravity
        M g.
    viscous
        C v̄.
    internal
        The internal force of the scheme. With a blend of stresses it includes the rigid forces
        that give what the boundary lacks back to the mass.
    end
        ∂E/∂u at the end of the step.
    start
        ∂E/∂u at its start.
    steadying
        Of the nodes without mass, zero elsewhere.
    """

    inertia: Array
    gravity: Array
    viscous: Array
    internal: Array
    end: Array
    start: Array
    steadying: Array


class Step:
    """A step as stored in ``audit.h5``, and what the auditor makes of it.

    Parameters
    ----------
    model
        The model.
    stored
        ``start``, ``end``, ``blend`` and ``ledger``, see `carom.io.audit`.
    """

    def __init__(self, model: AuditModel, stored: Mapping[str, Any]) -> None:
        self.model = model
        self.start, self.end = stored["start"], stored["end"]
        self.blend: Array = stored["blend"]
        self.ledger: Mapping[str, float] = stored["ledger"]
        self.time = float(self.end["time"])
        self.dt, self.off_grid = self._length()
        self.u0: Array = self.start["displacement"]
        self.u1: Array = self.end["displacement"]
        self.v0: Array = self.start["velocity"]
        self.v1: Array = self.end["velocity"]
        self.d: Array = self.u1 - self.u0
        self.motion = self._motion()

    def _length(self) -> tuple[float, float]:
        """Return the length of the step [s], and how far it is from one on the time grid [s].

        Nominal steps are equal but for a shorter last one, and those that failed are halved; the
        difference of two times has more round-off than a step may have.
        """
        analysis = self.model.scenario.analysis
        nominal, end = analysis.time_step, analysis.end_time
        raw = self.time - float(self.start["time"])
        steps = max(int(np.ceil(end / nominal - 1e-6)), 1)
        last = end - (steps - 1) * nominal
        # A last step that is shorter by no more than round-off is as long as the others.
        lengths = np.array([nominal, last if last < (1 - 1e-6) * nominal else nominal])
        grid = (lengths[:, None] * 0.5 ** np.arange(analysis.max_halvings + 1)).ravel()
        best = int(np.abs(grid - raw).argmin())
        return float(grid[best]), float(abs(grid[best] - raw))

    def _motion(self) -> float:
        """Return the largest motion of a node in the step, or that of free flight if larger [m]."""
        speed = np.linalg.norm(self.v0, axis=1).max()
        predicted = (speed + np.linalg.norm(self.model.gravity) * self.dt) * self.dt
        return float(max(np.abs(self.d).max(), predicted))

    def position(self, weight: float) -> Array:
        """Return the positions between start (0) and end (1) of the step [m]."""
        return self.model.points + self.u0 + weight * self.d

    @cached_property
    def contacts(self) -> Contacts:
        """The contacts of the step, where the condition is written."""
        written = 1.0 if self.model.condition in ("gap", "massless") else 0.5
        return contacts.find(self.model, self.end, self.position(written))

    @cached_property
    def start_contacts(self) -> Contacts:
        """The contacts that the step started with, where the start of the step is."""
        return contacts.find(self.model, self.start, self.position(0.0))

    @cached_property
    def forces(self) -> list[BodyForces]:
        """The forces on every body."""
        return [self._forces(i, body) for i, body in enumerate(self.model.bodies)]

    def _forces(self, index: int, body: AuditBody) -> BodyForces:
        model, span, dt = self.model, body.span, self.dt
        u0, u1, v0, v1, d = (a[span] for a in (self.u0, self.u1, self.v0, self.v1, self.d))
        mean = (1 - model.xi) * v0 + model.xi * v1
        mean[body.massless] = d[body.massless] / dt
        viscous = body.damping_force(u0 + 0.5 * dt * v0, mean)
        start, end = body.internal_force(u0), body.internal_force(u1)
        steadying = np.zeros_like(d)
        # A body that moves rigidly is not resisted.
        turn = rotation(dt * body.spin(u0, v0) if body.law.objective else 0.0)
        drift = body.mass.mean(v0)
        resisted = (d - dt * (drift + (v0 - drift) @ turn.T))[body.massless]
        steadying[body.massless] = STEADYING * body.holding[:, None] * resisted
        if model.blended:
            internal = self._blended(index, body, viscous, end + viscous + steadying)
        elif model.conserving:
            internal = body.conserving_force(u0, u1)
        else:
            internal = (1 - model.xi) * start + model.xi * end
        return BodyForces(
            inertia=body.mass.times(v1 - v0) / dt,
            gravity=body.mass.nodal[:, None] * model.gravity,
            viscous=viscous,
            internal=internal,
            end=end,
            start=start,
            steadying=steadying,
        )

    def _blended(self, index: int, body: AuditBody, viscous: Array, held: Array) -> Array:
        """Return f_a + d_a + α (f_d + d_d), see docs/theory.md."""
        u0, u1 = self.u0[body.span], self.u1[body.span]
        middle = body.points + 0.5 * (u0 + u1)
        centre = body.mass.mean(middle)
        x0, x1 = body.points + u0 - centre, body.points + u1 - centre
        b = body.massless
        p0, p1 = self.start["contact_force"][body.span][b], held[b]
        arms = body.mass.times(middle - centre)
        inertia = float(((middle - centre) * arms).sum())
        total = np.zeros_like(u0)
        for weight, inner, shares in (
            (1.0, body.conserving_force(u0, u1), (0.5, 0.5)),
            (self.blend[index], body.difference_force(u0, u1), (-1.0, 1.0)),
        ):
            # What the forces of the boundary have more than the reactions of start and end.
            lacking = inner[b] + (viscous[b] if shares[0] > 0 else 0.0)
            excess = (lacking - shares[0] * p0 - shares[1] * p1).sum(axis=0)
            moment = cross((middle - centre)[b], lacking).sum()
            moment -= (shares[0] * cross(x0[b], p0) + shares[1] * cross(x1[b], p1)).sum()
            spin = float(moment / inertia) if body.law.objective else 0.0
            rigid = body.mass.nodal[:, None] * excess / body.mass.total + turned(arms, spin)
            total += weight * (inner + rigid)
        return total

    def contact_force(self, body: AuditBody) -> Array:
        """Return the stored contact forces on a body at the end of the step [N]."""
        force: Array = self.end["contact_force"][body.span]
        return force

    def residual(self, index: int) -> Array:
        """Return what the equation of motion lacks, node by node [N], shape [node_count, 2].

        M (v₁ − v₀)/Δt = M g − f̄ − C v̄ + contact forces; nodes without mass are in static balance
        at the end of the step, but for the force that steadies them.
        """
        body, f = self.model.bodies[index], self.forces[index]
        contact = self.contact_force(body)
        residual = f.inertia - f.gravity + f.internal + f.viscous - contact
        static = f.end + f.viscous + f.steadying - contact
        residual[body.massless] = static[body.massless]
        return residual

    def energy_terms(self) -> dict[str, float]:
        """Return the terms of the ledger of the step, each from its own definition [J]."""
        model = self.model
        terms = dict.fromkeys(("kinetic", "strain", "external", "viscous", "scheme"), 0.0)
        for body, f in zip(model.bodies, self.forces, strict=True):
            u0, u1, v0, v1, d = (a[body.span] for a in (self.u0, self.u1, self.v0, self.v1, self.d))
            terms["kinetic"] += body.kinetic_energy(v1) - body.kinetic_energy(v0)
            terms["strain"] += body.strain_energy(u1) - body.strain_energy(u0)
            terms["external"] += float((f.gravity * d).sum())
            terms["viscous"] += float((f.viscous * d).sum())
            terms["scheme"] += (model.theta - 0.5) * 2 * body.kinetic_energy(v1 - v0)
            terms["scheme"] += (model.xi - 0.5) * float(((f.end - f.start) * d).sum())
        terms["friction"], terms["normal_contact"] = self._contact_work()
        return terms

    def _contact_work(self) -> tuple[float, float]:
        """Return what friction and what normal reactions took in the step [J]."""
        if self.model.blended:
            return float(self.rubbing()[0].sum()), 0.0
        shares = [(self.contacts, self.model.xi if self.model.massless else 1.0)]
        if self.model.massless:
            shares.append((self.start_contacts, 1 - self.model.xi))
        friction = normal = 0.0
        for found, share in shares:
            w_n, w_t = found.relative(self.d)
            friction -= share * float(found.friction_force @ w_t)
            normal -= share * float(found.normal_force @ w_n)
        return friction, normal

    def rubbing(self) -> tuple[Array, Array]:
        """Return μ r̄_n |w_t| of contacts, r̄ = (½ − α) r₀ + (½ + α) r₁, and how sure that is [J].

        Slip is measured in the frame of the end. Where a contact has no reaction there, it is not
        stored whether the run measured it there or, with the contact out of reach, at the start.
        """
        ended = {key: k for k, key in enumerate(_keys(self.contacts))}
        end_slip = np.abs(self.contacts.relative(self.d)[1])
        frames = (contacts.find(self.model, self.start, self.position(1.0)), self.start_contacts)
        moved, left = (np.abs(found.relative(self.d)[1]) for found in frames)
        for k, key in enumerate(_keys(self.start_contacts)):
            if key in ended:
                moved[k] = left[k] = end_slip[ended[key]]
        blend = np.append(self.blend, 0.0)  # the last is of nodes of no body
        taken, doubt = [], []
        for sign, found, slip in (
            (1.0, self.contacts, end_slip),
            (-1.0, self.start_contacts, moved),
        ):
            force = found.friction * (0.5 + sign * blend[found.source]) * found.normal_force
            taken.append(force * slip)
            doubt.append(np.abs(force * (moved - left)) if sign < 0 else np.zeros(len(found)))
        return np.concatenate(taken), np.concatenate(doubt)


def _keys(found: Contacts) -> list[tuple[int, int]]:
    return list(zip(found.node.tolist(), found.target.tolist(), strict=True))
