"""Rigid bodies as the auditor sees them: their motion in a step, and what their momenta ask for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, rotation, turned
from carom.auditing.body import AuditBody


@dataclass(frozen=True)
class RigidStep:
    """The motion of a rigid body in a step, taken from that of its nodes.

    Parameters
    ----------
    body
        The body.
    shift
        How far its centre moves [m], shape [2].
    turn
        θ: nodes move by the shift and θ × the mean of their arms; it turns by 2 arctan(θ/2).
    arms
        Arms of its nodes at the start, in the mean of the step and at its end [m], shape
        [3, node_count, 2].
    """

    body: AuditBody
    shift: Array
    turn: float
    arms: Array

    @classmethod
    def of(cls, body: AuditBody, u0: Array, d: Array) -> RigidStep:
        """Return the rigid motion that comes closest to these motions of the nodes [m]."""
        start = body.points + u0
        start = start - body.mass.mean(start)
        shift = body.mass.mean(d)
        beside = d - shift
        mean = start + 0.5 * beside
        weight = body.mass.nodal
        moment = float(weight @ cross(mean, beside))
        turn = moment / float(weight @ (mean**2).sum(axis=1))
        return cls(body, shift, turn, np.stack([start, mean, start + beside]))

    def bending(self, d: Array) -> Array:
        """Return what the motions of nodes have beside the rigid one [m]."""
        beside: Array = d - self.shift - turned(self.arms[1], self.turn)
        return beside

    def scheme(self, u0: Array, v0: Array, theta: float, dt: float) -> tuple[Array, Array]:
        """Return the velocities at the end that the scheme makes of the motion, and their change.

        The change has the spin of a body that turns as it did: |Δv|² of it is of Δv and Δω alone.
        """
        drift, spin = self.body.mass.mean(v0), self.body.spin(u0, v0)
        later = (1 - 1 / theta) * drift + self.shift / (theta * dt)
        rate = (1 - 1 / theta) * spin + self.turn / (theta * dt)
        velocity = later + turned(self.arms[2], rate)
        change = later - drift + turned(self.arms[2], rate - spin)
        return velocity, change

    def borne(self, impulse: Array) -> Array:
        """Return the momenta of nodes that impulses at the end make of a rigid body [N s].

        They are M Δv of the velocities that the resultant and the moment of the impulses give.
        """
        return self.body.mass.times(self.accelerated(impulse))

    def accelerated(self, impulse: Array) -> Array:
        """Return the velocities that impulses at the end give the nodes [m/s]."""
        body = self.body
        given = impulse.sum(axis=0) / body.mass.total
        spun = float(cross(self.arms[2], impulse).sum()) / body.inertia
        velocity: Array = given + turned(self.arms[2], spun)
        return velocity

    def residual(
        self, states: tuple[Array, Array, Array], forces: tuple[Array, Array], dt: float
    ) -> Array:
        """Return what momenta lack, as forces on nodes [N], shape [node_count, 2].

        m (v₁ − v₀)/Δt and J (ω₁ − ω₀)/Δt are the resultant and the moment of all forces: of those
        of the step by mean arms, of impulses by the arms at its end.

        Parameters
        ----------
        states
            u₁, v₀ and v₁ of the nodes.
        forces
            Forces of the step on the nodes, and impulses at its end over Δt [N].
        dt
            Length of the step [s].
        """
        body, (during, impulses) = self.body, forces
        u1, v0, v1 = states
        u0 = u1 - self.shift - turned(self.arms[1], self.turn)
        gained = body.mass.mean(v1) - body.mass.mean(v0)
        spun = body.spin(u1, v1) - body.spin(u0, v0)
        force = body.mass.total * gained / dt - (during + impulses).sum(axis=0)
        moment = body.inertia * spun / dt
        moment -= float(cross(self.arms[1], during).sum() + cross(self.arms[2], impulses).sum())
        weight = body.mass.nodal[:, None]
        size = float((weight * self.arms[1] ** 2).sum())
        nodal: Array = weight * (force / body.mass.total + turned(self.arms[1], moment / size))
        return nodal


def bent(body: AuditBody, u: Array) -> Array:
    """Return how far nodes are from where a rigid body would have them [m]."""
    x = body.points + u
    arms = body.points - body.mass.mean(body.points)
    now = x - body.mass.mean(x)
    weight = body.mass.nodal
    angle = np.arctan2(weight @ cross(arms, now), weight @ (arms * now).sum(axis=1))
    off: Array = now - arms @ rotation(float(angle)).T
    return off
