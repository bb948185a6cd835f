"""Rigid bodies as the auditor sees them: their motion in a step, and what their momenta ask for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, nearest_rotation, solved, turned, turning_axes
from carom.auditing.bodies.body import AuditBody
from carom.auditing.drives.guides import Guiding


@dataclass(frozen=True)
class RigidStep:
    """The motion of a rigid body in a step, taken from that of its nodes.

    Parameters
    ----------
    body
        The body.
    shift
        How far its centre moves [m], shape [D].
    turn
        ϑ: nodes move by the shift and ϑ × the mean of their arms; it turns by 2 arctan(|ϑ|/2).
    arms
        Arms of its nodes at the start, in the mean of the step and at its end [m], shape
        [3, node_count, D].
    guiding
        What guides it.
    """

    body: AuditBody
    shift: Array
    turn: Array
    arms: Array
    guiding: Guiding

    @classmethod
    def of(cls, body: AuditBody, u0: Array, d: Array, guiding: Guiding) -> RigidStep:
        """Return the rigid motion that comes closest to these motions of the nodes [m]."""
        start = body.points + u0
        start = start - body.mass.mean(start)
        shift = body.mass.mean(d)
        beside = d - shift
        mean = start + 0.5 * beside
        moment = body.mass.nodal @ cross(mean, beside)
        turn = solved(body.nodal_inertia(mean), moment)
        return cls(body, shift, turn, np.stack([start, mean, start + beside]), guiding)

    def bending(self, d: Array) -> Array:
        """Return what the motions of nodes have beside the rigid one [m]."""
        beside: Array = d - self.shift - turned(self.arms[1], self.turn)
        return beside

    def scheme(self, u0: Array, v0: Array, theta: float, dt: float) -> tuple[Array, Array]:
        """Return the velocities at the end that the scheme makes of the motion, and their change.

        The change has the spin of a body that turns as it did: |Δv|² of it is of Δv and Δω alone.
        """
        drift, kept = self.body.mass.mean(v0), self._carried(self.body.spin(u0, v0))
        given = self.guiding
        later = (1 - 1 / theta) * drift + self.shift / (theta * dt)
        later = np.where(given.along, given.velocity, later)
        rate = (1 - 1 / theta) * kept + self.turn / (theta * dt)
        rate = np.where(given.about, given.spin, rate)
        velocity = later + turned(self.arms[2], rate)
        change = later - drift + turned(self.arms[2], rate - kept)
        return velocity, change

    def _carried(self, spin: Array) -> Array:
        """Return a spin that has turned with the body [rad/s]: by Cayley's map of ϑ."""
        half = 0.5 * self.turn
        if len(half) == 1:
            return spin
        axes = np.eye(turning_axes(len(self.shift)))
        matrix = turned(axes, half).T
        carried: Array = np.linalg.solve(axes - matrix, (axes + matrix) @ spin)
        return carried

    def borne(self, impulse: Array) -> Array:
        """Return the momenta of nodes that impulses at the end make of a rigid body [N s].

        They are M Δv of the velocities that the resultant and the moment of the impulses give.
        """
        return self.body.mass.times(self.accelerated(impulse))

    def accelerated(self, impulse: Array) -> Array:
        """Return the velocities that impulses at the end give the nodes [m/s]."""
        body, impulse = self.body, self.guiding.unheld(impulse)
        along, about = ~self.guiding.along, ~self.guiding.about
        given = np.where(along, impulse.sum(axis=0) / body.mass.total, 0.0)
        end = self.arms[2] - body.points + body.mass.mean(body.points)
        moment = cross(self.arms[2], impulse).sum(axis=0)
        spun = np.zeros_like(moment)
        if about.any():
            # About what is guided it does not spin otherwise.
            spun[about] = solved(body.inertia(end)[np.ix_(about, about)], moment[about])
        velocity: Array = given + turned(self.arms[2], spun)
        return velocity

    def residual(
        self,
        states: tuple[Array, Array, Array],
        forces: tuple[Array, Array],
        dt: float,
        *,
        at_end: bool = False,
    ) -> Array:
        """Return what momenta lack, as forces on nodes [N], shape [node_count, D].

        m (v₁ − v₀)/Δt and (J₁ω₁ − J₀ω₀)/Δt are the resultant and the moment of all forces: of those
        of the step by mean arms, of impulses by the arms at its end.

        Parameters
        ----------
        states
            u₁, v₀ and v₁ of the nodes.
        forces
            Forces of the step on the nodes, and impulses at its end over Δt [N].
        dt
            Length of the step [s].
        at_end
            Whether forces balance at the end of the step, as in load steps, where nothing moves.
        """
        body = self.body
        force, moment = self.lacking(states, forces, dt, at_end=at_end)
        force = np.where(self.guiding.along, 0.0, force)
        moment = np.where(self.guiding.about, 0.0, moment)
        weight = body.mass.nodal[:, None]
        turn = solved(body.nodal_inertia(self.arms[1]), moment)
        nodal: Array = weight * (force / body.mass.total + turned(self.arms[1], turn))
        return nodal

    def lacking(
        self,
        states: tuple[Array, Array, Array],
        forces: tuple[Array, Array],
        dt: float,
        *,
        at_end: bool = False,
    ) -> tuple[Array, Array]:
        """Return the same as a force [N] and a moment [N m], with what guides give."""
        body, (during, impulses) = self.body, forces
        u1, v0, v1 = states
        u0 = u1 - self.shift - turned(self.arms[1], self.turn)
        gained = body.mass.mean(v1) - body.mass.mean(v0)
        spun = body.inertia(u1) @ body.spin(u1, v1) - body.inertia(u0) @ body.spin(u0, v0)
        if at_end:
            gained, spun = 0.0 * gained, 0.0 * spun
        force = body.mass.total * gained / dt - (during + impulses).sum(axis=0)
        moment = spun / dt - cross(self.arms[2 if at_end else 1], during).sum(axis=0)
        moment -= cross(self.arms[2], impulses).sum(axis=0)
        return force, moment

    def taken_by_scheme(self, v0: Array, v1: Array, theta: float, dt: float) -> tuple[float, float]:
        """Return what the scheme takes of the free motion, and what guides give beside it [J].

        These do m Δv·(½(v₀ + v₁) − d/Δt), and likewise of turns, where the motion at the end is not
        what the scheme makes of the step.

        Parameters
        ----------
        v0, v1
            Velocities of the nodes at the start, and at the end before impulses [m/s].
        theta
            θ.
        dt
            Length of the step [s].
        """
        body, along = self.body, self.guiding.along
        before, after = body.mass.mean(v0), body.mass.mean(v1)
        jump = body.mass.total * (after - before)
        beside = 0.5 * (before + after) - self.shift / dt
        taken = float(((after - before) * jump)[~along].sum())
        given = float((jump * beside)[along].sum())
        u0, u1 = (arms - body.points for arms in (self.arms[0], self.arms[2]))
        # Spins as the body feels them, which the scheme is about.
        spins = [self._own(body.spin(u, v), u) for u, v in ((u0, v0), (u1, v1))]
        gained = body.inertia(np.zeros_like(u0)) @ (spins[1] - spins[0])
        if self.guiding.about.any():
            rate = 0.5 * (spins[0] + spins[1]) - self._own(self.turn, u0) / dt
            given += float(gained @ rate)
        else:
            taken += float(gained @ (spins[1] - spins[0]))
        return (theta - 0.5) * taken, given

    def _own(self, spin: Array, u: Array) -> Array:
        """Return a spin in the frame of the body."""
        return spin if len(spin) == 1 else self.body.turned_to(u).T @ spin


def bent(body: AuditBody, u: Array) -> Array:
    """Return how far nodes are from where a rigid body would have them [m]."""
    x = body.points + u
    arms = body.points - body.mass.mean(body.points)
    now = x - body.mass.mean(x)
    moment = (body.mass.nodal[:, None] * now).T @ arms
    off: Array = now - arms @ nearest_rotation(moment).T
    return off
