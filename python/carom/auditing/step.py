"""One step, from its two states: the equation of motion, momenta, energy and Coulomb's law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from carom.auditing import contacts
from carom.auditing.arrays import Array, Indices, cross, rotation, turned
from carom.auditing.body import HEAVIEST, MUCH_SHORTER, STEADYING, AuditBody
from carom.auditing.contacts import Contacts
from carom.auditing.model import AuditModel
from carom.auditing.rigid import RigidStep
from carom.ledger_terms import names

BODY_ENERGIES = ("kinetic", "strain", "external", "viscous", "scheme")
"""Terms of the ledger that are sums over the bodies."""


@dataclass(frozen=True)
class BodyForces:
    """Forces on the nodes of a body in a step [N], each of shape [node_count, 2].

    Parameters
    ----------
    inertia
        M (v₁ − v₀)/Δt, before vibration takes or gives what the blend leaves over.
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
    missing, available
        What the body received through contact with the blend α = 0, and how much less with α = 1
        [J]; zero without a blend.
    """

    inertia: Array
    gravity: Array
    viscous: Array
    internal: Array
    end: Array
    start: Array
    steadying: Array
    missing: float
    available: float


@dataclass(frozen=True)
class ContactWork:
    """What contacts do to the energy in a step [J], each of shape [count].

    Parameters
    ----------
    found
        The contacts.
    terms
        Those of the ledger of pairs.
    whole
        With a blend of stresses: friction less prescribed, had the reactions the whole weight.
    doubt
        How sure friction is.
    """

    found: Contacts
    terms: Mapping[str, Array]
    whole: Array
    doubt: Array


class Step:
    """A step as stored in ``audit.h5``, and what the auditor makes of it.

    Parameters
    ----------
    model
        The model.
    stored
        ``start``, ``end``, ``blend``, ``vibration`` and ``ledger``, see `carom.io.audit`.
    """

    def __init__(self, model: AuditModel, stored: Mapping[str, Any]) -> None:
        self.model = model
        self.start, self.end = stored["start"], stored["end"]
        self.blend: Array = stored["blend"]
        self._impulses = [stored["landing"], stored["settling"]]
        self.ledger: Mapping[str, float] = stored["ledger"]
        self.time = float(self.end["time"])
        self.dt, self.off_grid, self.parts = self._length()
        self.u0: Array = self.start["displacement"]
        self.u1: Array = self.end["displacement"]
        self.v0: Array = self.start["velocity"]
        self.shares: Array = stored["vibration"]
        self.v1, self.vibration = self._before_repaying()
        self.d: Array = self.u1 - self.u0
        self.motion = self._motion()
        self.v_scheme = self._scheme_velocity()

    def _length(self) -> tuple[float, float, float]:
        """Return the length of the step, how far it is from one of the time grid, and its parts.

        Both are in s, and the parts are how often a nominal step has the length.

        Nominal steps are equal but for a shorter last one, and those that failed are halved; the
        difference of two times has more round-off than a step may have.
        """
        analysis = self.model.analysis
        nominal, end = analysis.time_step, analysis.end_time
        raw = self.time - float(self.start["time"])
        steps = max(int(np.ceil(end / nominal - 1e-6)), 1)
        last = end - (steps - 1) * nominal
        # A last step that is shorter by no more than round-off is as long as the others.
        lengths = np.array([nominal, last if last < (1 - 1e-6) * nominal else nominal])
        halvings = np.arange(analysis.max_halvings + 1)
        grid = (lengths[:, None] * 0.5**halvings).ravel()
        best = int(np.abs(grid - raw).argmin())
        parts = 2.0 ** halvings[best % len(halvings)]
        return float(grid[best]), float(abs(grid[best] - raw)), float(parts)

    def _before_repaying(self) -> tuple[Array, Array]:
        """Return what the equations of the step made of velocities, and what vibrated then.

        These are the velocities before vibration took or gave what the blend left over [m/s], and
        the energy of vibration of the bodies that had a part in that, else zero [J], [body_count].
        """
        before: Array = self.end["velocity"].copy()
        energy = np.zeros(len(self.model.bodies))
        for index in np.flatnonzero(self.shares):
            body, share = self.model.bodies[index], self.shares[index]
            v, u = before[body.span], self.u1[body.span]
            field = body.vibration(u, v) / (1.0 + share)
            energy[index] = body.kinetic_energy(u, field)
            v -= share * field
        return before, energy

    @property
    def repaid(self) -> Array:
        """What vibration gave of what the blend left over [J], shape [body_count]."""
        repaid: Array = self.vibration * self.shares * (2.0 + self.shares)
        return repaid

    def _motion(self) -> float:
        """Return the largest motion of a node in the step, or that of free flight if larger [m]."""
        speed = max(np.linalg.norm(self.v0, axis=1).max(), self.model.fastest_plane)
        predicted = (speed + np.linalg.norm(self.model.gravity) * self.dt) * self.dt
        return float(max(np.abs(self.d).max(), predicted))

    def _scheme_velocity(self) -> Array:
        """Return the velocities that the scheme makes of the motion, before impulses [m/s]."""
        theta = self.model.theta
        velocity: Array = (1 - 1 / theta) * self.v0 + self.d / (theta * self.dt)
        for body in self.model.bodies:
            if len(body.massless):
                mean = self.d[body.span] / self.dt
                faster = body.mass.mean(velocity[body.span] - mean)
                velocity[body.span][body.massless] = (mean + faster)[body.massless]
            if body.rigid:
                u0, v0 = self.u0[body.span], self.v0[body.span]
                velocity[body.span] = self.rigid(body).scheme(u0, v0, theta, self.dt)[0]
        return velocity

    @cached_property
    def met(self) -> Array:
        """Velocities at the start [m/s], of rigid bodies where they have turned half way."""
        met: Array = self.v0.copy()
        for body in self.model.bodies:
            if body.rigid:
                u0, v0 = self.u0[body.span], self.v0[body.span]
                arms = self.rigid(body).arms[1]
                met[body.span] = body.mass.mean(v0) + turned(arms, body.spin(u0, v0))
        return met

    def rigid(self, body: AuditBody) -> RigidStep:
        """Return the motion of a rigid body."""
        return RigidStep.of(body, self.u0[body.span], self.d[body.span])

    def position(self, weight: float) -> Array:
        """Return the positions between start (0) and end (1) of the step [m]."""
        return self.model.points + self.u0 + weight * self.d

    @cached_property
    def contacts(self) -> Contacts:
        """The contacts of the step, where the condition is written, with their whole reactions."""
        written = 1.0 if self.model.condition in ("gap", "massless") else 0.5
        found = self._find(self.end, written)
        if not self.model.mixed:
            return found
        return found.placed(found.massless, self._find(self.end, 0.5))

    @cached_property
    def impulses(self) -> list[Contacts]:
        """The same contacts at the end of the step.

        Their reactions are the parts that are impulses there: those of landing, and of settling.
        """
        at_end = self._find(self.end, 1.0)
        return [replace(at_end, reaction=reaction) for reaction in self._impulses]

    @cached_property
    def pressed(self) -> Contacts:
        """The contacts of the step with the reactions that bore its motion."""
        return self.contacts.less(self.impulses)

    @property
    def whole_force(self) -> tuple[Array, Array]:
        """r_n and r_t with impulses, each part in the frame in which it acts [N], [count]."""
        parts = [self.pressed, *self.impulses]
        normal, across = np.zeros(len(self.contacts)), np.zeros(len(self.contacts))
        for part in parts:
            normal += part.normal_force
            across += part.friction_force
        return normal, across

    @cached_property
    def start_gaps(self) -> Array:
        """Gaps of the contacts of the step at its start [m], shape [count]."""
        return self._find(self.end, 0.0).gap

    def impulse(self, body: AuditBody) -> Array:
        """Return the impulses on the nodes of a body at the end of the step [N s]."""
        forces = contacts.all_forces(self.impulses, len(self.model.points))
        impulse: Array = self.dt * forces[body.span]
        return impulse

    @cached_property
    def start_contacts(self) -> Contacts:
        """The contacts that the step started with, where the start of the step is.

        Only those of pairs without mass have a part in the step, if there are others.
        """
        found = self._find(self.start, 0.0)
        return found.only(found.massless) if self.model.mixed else found

    @cached_property
    def balanced(self) -> Contacts:
        """The contacts of the step whose pairs have a side without mass."""
        return self.pressed.only(self.pressed.massless)

    @cached_property
    def moved(self) -> Contacts:
        """The others, whose pairs are ruled by the motion."""
        return self.pressed.only(~self.pressed.massless)

    def on_mass(self, body: AuditBody) -> tuple[Array, Array]:
        """Return what contacts of the other kind do to a body with mass in the step [N].

        The part without the blend and that which goes with it, each with the couple that gives the
        moments of the start where that is and of the end where that is; see docs/theory.md.
        """
        xi, span = self.model.xi, body.span
        start, end = (
            found.nodal_forces(len(self.model.points))[span]
            for found in (self.start_contacts, self.balanced)
        )
        parts = [(1 - xi) * start + xi * end, end - start]
        if not self.model.blended:
            return parts[0], np.zeros_like(start)
        d = self.d[span]
        if body.turns:
            middle = body.points + 0.5 * (self.u0 + self.u1)[span]
            weight = body.mass.nodal[:, None]
            arms = middle - (weight * middle).sum(axis=0) / weight.sum()
            inertia = float((weight * arms**2).sum())
            leads = (0.5 * (xi * end - (1 - xi) * start), 0.5 * (start + end))
            for k, lead in enumerate(leads):
                parts[k] += weight * turned(arms, float(cross(d, lead).sum()) / inertia)
        return parts[0], parts[1]

    def _find(self, state: Mapping[str, Any], weight: float) -> Contacts:
        time = float(self.start["time"]) + weight * self.dt
        return contacts.find(self.model, state, self.position(weight), time)

    @cached_property
    def forces(self) -> list[BodyForces]:
        """The forces on every body."""
        return [self._forces(i, body) for i, body in enumerate(self.model.bodies)]

    def _forces(self, index: int, body: AuditBody) -> BodyForces:
        model, span, dt = self.model, body.span, self.dt
        u0, u1, v0, v1, d = (a[span] for a in (self.u0, self.u1, self.v0, self.v1, self.d))
        mean = (1 - model.xi) * v0 + model.xi * self.v_scheme[span]
        mean[body.massless] = d[body.massless] / dt
        viscous = body.damping_force(u0 + 0.5 * dt * v0, mean)
        start, end = body.internal_force(u0), body.internal_force(u1)
        steadying, missing, available = np.zeros_like(d), 0.0, 0.0
        # A body that moves rigidly, or falls as it does, is not resisted.
        turn = rotation(dt * body.spin(u0, v0) if body.turns else 0.0)
        drift = body.mass.mean(v0)
        pressed = self.start["contact_force"][span].sum(axis=0)
        fall = dt * dt * model.theta * (model.gravity + pressed / body.mass.total)
        resisted = (d - fall - dt * (drift + (v0 - drift) @ turn.T))[body.massless]
        share = STEADYING * max(self.parts / MUCH_SHORTER, 1.0) ** 2
        resistance = np.minimum(share * body.holding, HEAVIEST * body.mass.moved / dt**2)
        steadying[body.massless] = resistance[:, None] * resisted
        if model.blended and not body.rigid:
            held = end + viscous + steadying
            internal, missing, available = self._blended(index, body, viscous, held)
        elif model.conserving:
            internal = body.conserving_force(u0, u1)
        else:
            internal = (1 - model.xi) * start + model.xi * end
        if model.mixed and model.blended and not len(body.massless):
            without, beside = self.on_mass(body)
            missing += float((without * d).sum())
            available -= float((beside * d).sum())
        return BodyForces(
            inertia=body.mass.times(v1 - v0) / dt,
            gravity=body.mass.nodal[:, None] * model.gravity,
            viscous=viscous,
            internal=internal,
            end=end,
            start=start,
            steadying=steadying,
            missing=missing,
            available=available,
        )

    def _blended(
        self, index: int, body: AuditBody, viscous: Array, held: Array
    ) -> tuple[Array, float, float]:
        """Return f_a + d_a + α (f_d + d_d), what is missing and what is available [J].

        See docs/theory.md.
        """
        u0, u1 = self.u0[body.span], self.u1[body.span]
        middle = body.points + 0.5 * (u0 + u1)
        centre = body.mass.mean(middle)
        x0, x1 = body.points + u0 - centre, body.points + u1 - centre
        b = body.massless
        p0, p1 = self.start["contact_force"][body.span][b], held[b]
        arms = body.mass.times(middle - centre)
        inertia = float(((middle - centre) * arms).sum())
        parts = []
        for inner, shares in (
            (body.conserving_force(u0, u1), (0.5, 0.5)),
            (body.difference_force(u0, u1), (-1.0, 1.0)),
        ):
            # What the forces of the boundary have more than the reactions of start and end.
            lacking = inner[b] + (viscous[b] if shares[0] > 0 else 0.0)
            excess = (lacking - shares[0] * p0 - shares[1] * p1).sum(axis=0)
            moment = cross((middle - centre)[b], lacking).sum()
            moment -= (shares[0] * cross(x0[b], p0) + shares[1] * cross(x1[b], p1)).sum()
            spin = float(moment / inertia) if body.turns else 0.0
            rigid = body.mass.nodal[:, None] * excess / body.mass.total + turned(arms, spin)
            parts.append((inner, rigid))
        (mean, given), (difference, moved) = parts
        d = u1 - u0
        missing = float(((mean + viscous)[b] * d[b]).sum() - (given * d).sum())
        rest = difference + moved
        available = float((rest * d).sum() - (rest[b] * d[b]).sum())
        return mean + given + self.blend[index] * rest, missing, available

    def contact_force(self, body: AuditBody) -> Array:
        """Return the stored contact forces on a body as its equation of the step has them [N]."""
        force: Array = self.end["contact_force"][body.span]
        if self.model.mixed and not len(body.massless):
            without, beside = self.on_mass(body)
            at_end = self.balanced.nodal_forces(len(self.model.points))[body.span]
            alpha = float(self.blend[self.model.bodies.index(body)])
            return force - at_end + without + alpha * beside
        return force

    def residual(self, index: int) -> Array:
        """Return what the equation of motion lacks, node by node [N], shape [node_count, 2].

        M (v₁ − v₀)/Δt = M g − f̄ − C v̄ + contact forces. Nodes without mass are in static balance
        at the end of the step, but for the force that steadies them.
        """
        body, f = self.model.bodies[index], self.forces[index]
        contact = self.contact_force(body)
        if body.rigid:
            states = (self.u1[body.span], self.v0[body.span], self.v1[body.span])
            impulses = self.impulse(body) / self.dt
            forces = (contact - impulses + f.gravity, impulses)
            return self.rigid(body).residual(states, forces, self.dt)
        residual = f.inertia - f.gravity + f.internal + f.viscous - contact
        static = f.end + f.viscous + f.steadying - contact
        residual[body.massless] = static[body.massless]
        return body.folded(residual)

    def energy_terms(self) -> dict[str, float]:
        """Return the terms of the ledger of the step, each from its own definition [J]."""
        terms = {name: sum(body[name] for body in self.body_terms) for name in BODY_ENERGIES}
        terms.update(dict.fromkeys(names("pair"), 0.0))
        for work in self.contact_work:
            for name, values in work.terms.items():
                terms[name] += float(values.sum())
        return terms

    @cached_property
    def body_terms(self) -> list[dict[str, float]]:
        """The terms of the ledger of every body, and what it received through contact [J]."""
        return [self._body_terms(i, body) for i, body in enumerate(self.model.bodies)]

    def _body_terms(self, index: int, body: AuditBody) -> dict[str, float]:
        model, f = self.model, self.forces[index]
        u0, u1, v0, d = (a[body.span] for a in (self.u0, self.u1, self.v0, self.d))
        end = self.end["velocity"][body.span]
        jump = self.v_scheme[body.span] - v0
        if body.rigid:
            jump = self.rigid(body).scheme(u0, v0, model.theta, self.dt)[1]
        scheme = (model.theta - 0.5) * 2 * body.kinetic_energy(u0, jump)
        scheme += (model.xi - 0.5) * float(((f.end - f.start) * d).sum())
        if model.blended:
            contact = f.missing - float(self.blend[index]) * f.available
            contact += float(self.repaid[index])
            if model.mixed:
                received = self.moved.nodal_forces(len(model.points))[body.span]
                contact += self._received(body, received)
        else:
            force = np.zeros_like(model.points)
            for found, share in self._shares():
                force += share * found.nodal_forces(len(model.points))
            received = force[body.span]
            contact = self._received(body, received)
            # What rows that are static at the end of a step leave of its mean forces.
            b = body.massless
            scheme += float(((received - f.viscous - f.internal)[b] * d[b]).sum())
        return {
            "kinetic": body.kinetic_energy(u1, end) - body.kinetic_energy(u0, v0),
            "strain": body.strain_energy(u1) - body.strain_energy(u0),
            "external": float((f.gravity * d).sum()),
            "viscous": float((f.viscous * d).sum()),
            "scheme": scheme,
            "contact": contact,
        }

    def _received(self, body: AuditBody, force: Array) -> float:
        """Return the work of a force over the step, and of impulses at its end, on a body [J]."""
        mean = 0.5 * (self.v_scheme + self.v1)[body.span]
        return float((force * self.d[body.span]).sum() + (self.impulse(body) * mean).sum())

    def _shares(self) -> list[tuple[Contacts, float]]:
        """Return the contacts whose work is booked one by one, and how much of it counts."""
        model = self.model
        if model.blended:
            return [(self.moved, 1.0)] if model.mixed else []
        if not model.massless:
            return [(self.pressed, 1.0)]
        ends = [(self.balanced, model.xi), (self.start_contacts, 1 - model.xi)]
        return [*ends, (self.moved, 1.0)]

    @cached_property
    def contact_work(self) -> list[ContactWork]:
        """The work of the reactions at the end of the step, then of those at its start.

        Each counts as much as the scheme lets it.
        """
        work = list(self.rubbing) if self.model.blended else []
        for found, share in self._shares():
            w_n, w_t = found.relative(self.d, self.dt)
            work.append(
                ContactWork(
                    found=found,
                    terms={
                        "friction": -share * found.friction_force * w_t,
                        "normal_contact": -share * found.normal_force * w_n,
                        "prescribed": share * found.prescribed_work(self.dt),
                    },
                    whole=np.zeros(len(found)),
                    doubt=np.zeros(len(found)),
                )
            )
        if self.model.blended and not self.model.mixed:
            return work
        return [*work, *self._impulse_work()]

    def _impulse_work(self) -> list[ContactWork]:
        """Return the work of impulses at the end of the step, by the mean of v before and after."""
        landing, settling = self.impulses
        mean = 0.5 * (self.v_scheme + self.v1)
        works = []
        for found, normal, across in (
            (landing, "normal_contact", "friction"),
            (settling, "settling", "settling"),
        ):
            v_n, v_t = found.relative(mean, 1.0)
            terms = dict.fromkeys(names("pair"), np.zeros(len(found)))
            terms[normal] = terms[normal] - self.dt * found.normal_force * v_n
            terms[across] = terms[across] - self.dt * found.friction_force * v_t
            terms["prescribed"] = found.prescribed_work(self.dt)
            nothing = np.zeros(len(found))
            works.append(ContactWork(found=found, terms=terms, whole=nothing, doubt=nothing))
        return works

    @property
    def doubt(self) -> float:
        """How sure the dissipation by friction is [J]."""
        return sum(float(work.doubt.sum()) for work in self.contact_work)

    @cached_property
    def groups(self) -> Indices:
        """The first body of the group of bodies that share a blend with each, [body_count]."""
        return self._connected([self.balanced, self.start_contacts])

    @cached_property
    def books(self) -> Indices:
        """The first body of the group of bodies in contact that each belongs to, [body_count]."""
        return self._connected([self.balanced, self.start_contacts, self.moved])

    def _connected(self, contacts: Sequence[Contacts]) -> Indices:
        leader = np.arange(len(self.model.bodies))
        for found in contacts:
            for pair in zip(found.source, found.target, strict=True):
                if min(pair) >= 0 and max(pair) < len(leader):
                    members = np.isin(leader, leader[list(pair)])
                    leader[members] = leader[members].min()
        return leader

    def balance(self) -> tuple[Array, Array]:
        """Return what the blend of each group has to make up for, and what it can move [J].

        Both are of shape [body_count], at the first body of every group.
        """
        missing, available = self._start_debt(self.groups), np.zeros(len(self.model.bodies))
        for f, leader in zip(self.forces, self.groups, strict=True):
            missing[leader] += f.missing
            available[leader] += f.available
        for sign, work in zip((1.0, -1.0), self.rubbing, strict=True):
            known = work.found.source < len(self.groups)
            leader = self.groups[work.found.source[known]]
            np.add.at(missing, leader, 0.5 * work.whole[known])
            np.add.at(available, leader, -sign * work.whole[known])
        return missing, available

    def blend_range(self, largest: float) -> tuple[Array, Array]:
        """Return the least and the largest α of each group, of shape [body_count].

        Up to `largest`, no mean normal reaction ½ (r₀ + r₁) + α (r₁ − r₀) pulls.
        """
        ends: dict[tuple[int, int], list[float]] = {}
        source = {}
        for end, found in enumerate((self.start_contacts, self.balanced)):
            for k, key in enumerate(_keys(found)):
                ends.setdefault(key, [0.0, 0.0])[end] = max(float(found.normal_force[k]), 0.0)
                source[key] = int(found.source[k])
        lower = np.full(len(self.groups), -largest)
        upper = np.full(len(self.groups), largest)
        for key, (r0, r1) in ends.items():
            if source[key] >= len(self.groups) or r0 == r1:
                continue
            leader = self.groups[source[key]]
            bound = 0.5 * (r0 + r1) / (r0 - r1)
            if bound > 0:
                upper[leader] = min(upper[leader], bound)
            else:
                lower[leader] = max(lower[leader], bound)
        return lower, upper

    def left_over(self) -> Array:
        """Return what the groups have yet to give back after the step, [body_count] [J]."""
        left = self._start_debt(self.books)
        for terms, leader in zip(self.body_terms, self.books, strict=True):
            left[leader] += terms["kinetic"] + terms["strain"] + terms["viscous"]
            left[leader] -= terms["external"]
        for work in self.contact_work:
            known = work.found.source < len(self.books)
            leader = self.books[work.found.source[known]]
            nothing = np.zeros(len(work.found))
            taken = -work.terms["prescribed"]
            for name in ("friction", "normal_contact", "settling"):
                taken = taken + work.terms.get(name, nothing)
            np.add.at(left, leader, taken[known])
        return left

    def _start_debt(self, groups: Indices) -> Array:
        """Return what groups had yet to give back before the step, [body_count] [J]."""
        debt = np.zeros(len(self.model.bodies))
        np.add.at(debt, groups, self.start["energy_debt"])
        return debt

    @cached_property
    def rubbing(self) -> list[ContactWork]:
        """What friction, μ r̄_n |w_t|, and obstacles do, r̄ = (½ − α) r₀ + (½ + α) r₁.

        Slip is measured in the frame of the end. Where a contact has no reaction there, it is not
        stored whether the run measured it there or, with the contact out of reach, at the start.
        """
        ended = {key: k for k, key in enumerate(_keys(self.balanced))}
        end_slip = np.abs(self.balanced.relative(self.d, self.dt)[1])
        late = self._find(self.start, 1.0)
        frames = (late.only(late.massless) if self.model.mixed else late, self.start_contacts)
        moved, left = (np.abs(found.relative(self.d, self.dt)[1]) for found in frames)
        for k, key in enumerate(_keys(self.start_contacts)):
            if key in ended:
                moved[k] = left[k] = end_slip[ended[key]]
        blend = np.append(self.blend, 0.0)  # the last is of nodes of no body
        work = []
        for sign, found, slip, off in (
            (1.0, self.balanced, end_slip, np.zeros(len(end_slip))),
            (-1.0, self.start_contacts, moved, np.abs(moved - left)),
        ):
            share = 0.5 + sign * blend[found.source]
            force, driven = found.friction * found.normal_force, found.prescribed_work(self.dt)
            work.append(
                ContactWork(
                    found=found,
                    terms={
                        "friction": share * force * slip,
                        "normal_contact": np.zeros(len(found)),
                        "prescribed": share * driven,
                    },
                    whole=force * slip - driven,
                    doubt=np.maximum(share, 0.5) * np.abs(force) * off,
                )
            )
        return work


def _keys(found: Contacts) -> list[tuple[int, int]]:
    return list(zip(found.node.tolist(), found.target.tolist(), strict=True))
