"""Forces on the bodies in a step, and what they leave of the equation of motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from carom.auditing.arrays import Array, cross, inertia, rotation, solved, turned
from carom.auditing.bodies.body import HEAVIEST, MUCH_SHORTER, STEADYING, AuditBody
from carom.auditing.steps.contacts import all_forces
from carom.auditing.steps.mobility import mobilities
from carom.auditing.steps.pulling import Pulling
from carom.auditing.steps.states import States
from carom.auditing.steps.touching import Touching


@dataclass(frozen=True)
class BodyForces:
    """Forces on the nodes of a body in a step [N], each of shape [node_count, D].

    Parameters
    ----------
    inertia
        M (v₁ − v₀)/Δt, before vibration takes or gives what the blend leaves over.
    gravity
        M g.
    loads, end_loads
        As the scheme weighs them, and at the end of the step.
    connections
        Of springs and dampers, in the mean.
    end_connections
        Of springs at the end of the step.
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
    path, path_loads
        In load steps the internal force whose work is the change of the strain energy, and the
        loads half way.
    missing, available
        What the body received through contact with the blend α = 0, and how much less with α = 1
        [J]; zero without a blend.
    """

    inertia: Array
    gravity: Array
    loads: Array
    end_loads: Array
    connections: Array
    end_connections: Array
    viscous: Array
    internal: Array
    end: Array
    start: Array
    steadying: Array
    path: Array
    path_loads: Array
    missing: float
    available: float


class Forces:
    """The forces of a step.

    Parameters
    ----------
    states, touching
        The states of the step, and what touches in it.
    """

    def __init__(self, states: States, touching: Touching) -> None:
        self._states, self._touching = states, touching
        self.pulling = Pulling(states)
        """What springs and dampers do."""

    @cached_property
    def of(self) -> list[BodyForces]:
        """The forces on every body."""
        return [self._forces(i, body) for i, body in enumerate(self._states.model.bodies)]

    def _forces(self, index: int, body: AuditBody) -> BodyForces:
        s, span = self._states, body.span
        model, dt = s.model, s.dt
        u0, u1, v0, v1, d = (a[span] for a in (s.u0, s.u1, s.v0, s.v1, s.d))
        mean = (1 - model.xi) * v0 + model.xi * self._states.v_scheme[span]
        held = model.supports[index].held
        mean[body.massless] = d[body.massless] / dt
        mean[held] = d[held] / dt
        viscous = body.damping_force(u0 + 0.5 * np.where(held, d, dt * v0), mean)
        viscous += body.viscous_force(u0, u1, dt)
        grown = s.grown(body)
        start, end = body.internal_force(u0, grown[0]), body.internal_force(u1, grown[1])
        half_way = 0.5 * (grown[0] + grown[1])
        steadying, missing, available = np.zeros_like(d), 0.0, 0.0
        path, path_loads = np.zeros_like(d), np.zeros_like(d)
        # A body that moves rigidly, or falls as it does, is not resisted.
        turn = rotation(dt * body.spin(u0, v0)) if body.turns else np.eye(body.dimension)
        drift = body.mass.mean(v0)
        times = (float(s.start["time"]), s.time)
        given = model.loads[index]
        loads = given.mean(times, model.xi, u0 + model.xi * d, u0 + 0.5 * d)
        end_loads = given.at(s.time, u1)
        if model.static:
            loads = end_loads
            viscous = np.zeros_like(viscous)
            path = body.conserving_force(u0, u1, half_way)
            path_loads = given.mean(times, 0.5, u0 + 0.5 * d)
        pressed = body.mass.resultant(s.start["contact_force"][span] + given.at(times[0], u0))
        slowed = body.law.mass_damping
        driven = model.gravity + pressed / body.mass.total - slowed * drift
        fall = dt * dt * model.theta * driven / (1.0 + slowed * model.theta * dt)
        # Along what is held nothing is foretold.
        fall = np.where(held.any(axis=0), 0.0, fall)
        resisted = (d - fall - dt * (drift + (v0 - drift) @ turn.T))[body.massless]
        share = STEADYING * max(self._states.parts / MUCH_SHORTER, 1.0) ** 2
        resistance = np.minimum(share * body.holding, HEAVIEST * body.mass.moved / dt**2)
        steadying[body.massless] = resistance[:, None] * resisted
        if body.modes is not None:
            # It resists in its amplitudes, and not at nodes: see `ReducedStep`.
            viscous, start, end, internal = (np.zeros_like(d) for _ in range(4))
        elif model.blended and body.blends:
            at_end = end + viscous + steadying - end_loads
            opposed = viscous - loads
            internal, missing, available = self._blended(index, body, opposed, at_end)
        elif model.conserving:
            internal = body.conserving_force(u0, u1, half_way)
        else:
            internal = (1 - model.xi) * start + model.xi * end
        if model.mixed and model.blended and not len(body.massless):
            without, beside = self.on_mass(body)
            missing += float((without * d)[~held].sum())
            available -= float((beside * d)[~held].sum())
        return BodyForces(
            inertia=np.zeros_like(d) if model.static else body.mass.times(v1 - v0) / dt,
            gravity=body.mass.times(np.broadcast_to(model.gravity, d.shape)),
            loads=loads,
            end_loads=end_loads,
            connections=self.pulling.force[span],
            end_connections=self.pulling.end_force[span],
            viscous=viscous,
            internal=internal,
            end=end,
            start=start,
            steadying=steadying,
            path=path,
            path_loads=path_loads,
            missing=missing,
            available=available,
        )

    def _blended(
        self, index: int, body: AuditBody, viscous: Array, held: Array
    ) -> tuple[Array, float, float]:
        """Return f_a + d_a + α (f_d + d_d), what is missing and what is available [J].

        See docs/theory.md.
        """
        u0, u1 = self._states.u0[body.span], self._states.u1[body.span]
        middle = body.points + 0.5 * (u0 + u1)
        centre = body.mass.mean(middle)
        x0, x1 = body.points + u0 - centre, body.points + u1 - centre
        b = body.massless
        # What supports hold is theirs: contact neither moves it nor receives its work.
        free = ~self._states.model.supports[index].held[b]
        p0, p1 = (p[b] * free for p in (self._states.start["contact_force"][body.span], held))
        arms = body.mass.times(middle - centre)
        resists = inertia(middle - centre, body.mass.times)
        parts = []
        for inner, shares in (
            (body.conserving_force(u0, u1, 0.0), (0.5, 0.5)),
            (body.difference_force(u0, u1), (-1.0, 1.0)),
        ):
            # What the forces of the boundary have more than the reactions of start and end.
            lacking = (inner[b] + (viscous[b] if shares[0] > 0 else 0.0)) * free
            excess = body.mass.resultant(lacking - shares[0] * p0 - shares[1] * p1)
            moment = cross((middle - centre)[b], lacking)
            moment = moment - shares[0] * cross(x0[b], p0) - shares[1] * cross(x1[b], p1)
            spin = solved(resists, moment.sum(axis=0) * body.turns)
            rigid = body.mass.nodal[:, None] * excess / body.mass.total + turned(arms, spin)
            parts.append((inner, rigid))
        (mean, given), (difference, moved) = parts
        d = u1 - u0
        missing = float(((mean + viscous)[b] * free * d[b]).sum() - (given * d).sum())
        rest = difference + moved
        available = float((rest * d).sum() - (rest[b] * free * d[b]).sum())
        return mean + given + self._states.blend[index] * rest, missing, available

    def contact(self, body: AuditBody) -> Array:
        """Return the stored contact forces on a body as its equation of the step has them [N]."""
        force: Array = self._states.end["contact_force"][body.span]
        if self._states.model.mixed and not len(body.massless):
            without, beside = self.on_mass(body)
            at_end = self._touching.balanced.nodal_forces(len(self._states.model.points))[body.span]
            alpha = float(self._states.blend[self._states.model.bodies.index(body)])
            return force - at_end + without + alpha * beside
        return force

    def contact_on_held(self, body: AuditBody) -> Array:
        """Return the mean of contact forces over the step, which supports see to [N]."""
        if not len(body.massless):
            return self.contact(body)
        xi, touching = self._states.model.xi, self._touching
        parts = [touching.first.weighted(1 - xi, 1 - xi), touching.balanced.weighted(xi, xi)]
        return all_forces([*parts, touching.moved], len(self._states.model.points))[body.span]

    def residual(self, index: int) -> Array:
        """Return what the equation of motion lacks, node by node [N], shape [node_count, D].

        What is held has the forces of supports.
        """
        held = self._states.model.supports[index].held
        return np.where(held, 0.0, self._unbalanced(index))

    def support(self, index: int) -> Array:
        """Return the forces of supports on the nodes of a body [N], shape [node_count, D].

        That of a guide is shared by the nodes as their mass is.
        """
        body = self._states.model.bodies[index]
        if body.rigid:
            states, forces = self._of_rigid(index)
            rigid = self._states.rigid(body)
            static = self._states.model.static
            lacking, _ = rigid.lacking(states, forces, self._states.dt, at_end=static)
            lacking = np.where(rigid.guiding.along, lacking, 0.0)
            shared: Array = body.mass.nodal[:, None] / body.mass.total * lacking
            return shared
        held = self._states.model.supports[index].held
        return np.where(held, self._unbalanced(index), 0.0)

    def _unbalanced(self, index: int) -> Array:
        """Return what the nodes lack of balance [N], shape [node_count, D].

        M (v₁ − v₀)/Δt = M g + F̄ − f̄ − C v̄ + forces of contacts and springs. Nodes without mass are
        in static balance at the end of the step, but for the force that steadies them.
        """
        body, f = self._states.model.bodies[index], self.of[index]
        if body.modes is not None:
            return self._reduced_residual(index)
        if body.rigid:
            s, (states, forces) = self._states, self._of_rigid(index)
            return s.rigid(body).residual(states, forces, s.dt, at_end=s.model.static)
        contact = self.contact(body)
        pull = f.end_connections if self._states.model.static else f.connections
        given = f.gravity + f.loads + pull + self.contact_on_held(body)
        residual = f.inertia + f.internal + f.viscous - given
        static = f.end + f.viscous + f.steadying - f.end_loads - contact
        # What is held of nodes without mass is seen to over the whole step.
        b, held = body.massless, self._states.model.supports[index].held
        residual[b] = np.where(held[b], residual[b], static[b])
        return body.folded(residual)

    def _reduced_residual(self, index: int) -> Array:
        """Return the same of a reduced body, whose momenta and amplitudes lack it."""
        s, body = self._states, self._states.model.bodies[index]
        impulses = self._touching.impulse(body) / s.dt
        during = self.contact(body) - impulses + self.of[index].gravity
        velocities = (s.v0[body.span], s.v_scheme[body.span], s.v1[body.span])
        return s.reduced(body).residual(velocities, (during, impulses), s.weights)

    def _of_rigid(self, index: int) -> tuple[tuple[Array, Array, Array], tuple[Array, Array]]:
        """Return the states of a rigid body, and its forces of the step and of impulses [N]."""
        s, body, f = self._states, self._states.model.bodies[index], self.of[index]
        states = (s.u1[body.span], s.v0[body.span], s.v1[body.span])
        impulses = self._touching.impulse(body) / s.dt
        pull = f.end_connections if s.model.static else f.connections
        return states, (self.contact(body) - impulses + f.gravity + f.loads + pull, impulses)

    def guided(self, index: int) -> float:
        """Return the work of what guides a rigid body in a step in time [J].

        What presses on displacements that are given is no load of its: that work is of the pairs.
        """
        s, body, f = self._states, self._states.model.bodies[index], self.of[index]
        rigid = s.rigid(body)
        unheld, guiding = rigid.guiding.unheld, rigid.guiding
        v0, v1, v2 = (v[body.span] for v in (s.v0, s.v_scheme, s.v1))
        impulse = self._touching.impulse(body)
        contact = unheld(self.contact(body) - impulse / s.dt)
        during = contact + f.gravity + f.loads + f.connections
        force, moment = rigid.lacking(
            (s.u1[body.span], v0, v1), (during, np.zeros_like(during)), s.dt
        )
        work = float((force * rigid.shift)[guiding.along].sum())
        work += float((moment * rigid.turn)[guiding.about].sum())
        impulse = unheld(impulse)
        spun = cross(rigid.arms[2], impulse).sum(axis=0) * body.spin(s.u1[body.span], v2)
        work -= float((impulse.sum(axis=0) * body.mass.mean(v2))[guiding.along].sum())
        work -= float(spun[guiding.about].sum())
        return work + rigid.taken_by_scheme(v0, v1, s.model.theta, s.dt)[1]

    def on_mass(self, body: AuditBody) -> tuple[Array, Array]:
        """Return what contacts of the other kind do to a body with mass in the step [N].

        The part without the blend and that which goes with it, each with the couple that gives the
        moments of the start where that is and of the end where that is; see docs/theory.md.
        """
        xi, span = self._states.model.xi, body.span
        start, end = (
            found.nodal_forces(len(self._states.model.points))[span]
            for found in (self._touching.first, self._touching.balanced)
        )
        parts = [(1 - xi) * start + xi * end, end - start]
        if not self._states.model.blended:
            return parts[0], np.zeros_like(start)
        d = self._states.d[span]
        if body.turns:
            middle = body.points + 0.5 * (self._states.u0 + self._states.u1)[span]
            weight = body.mass.sizes[:, None]
            if body.modes is not None:
                # No force is taken inside.
                weight = np.zeros((len(middle), 1))
                weight[body.surface, 0] = 1.0 / mobilities(self._states, body)[body.surface]
            arms = middle - (weight * middle).sum(axis=0) / weight.sum()
            resists = inertia(arms, lambda field: weight * field)
            leads = (0.5 * (xi * end - (1 - xi) * start), 0.5 * (start + end))
            for k, lead in enumerate(leads):
                couple = solved(resists, cross(d, lead).sum(axis=0))
                parts[k] += weight * turned(arms, couple)
        return parts[0], parts[1]
