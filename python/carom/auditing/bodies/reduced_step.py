"""Reduced bodies in a step: their motion, taken from that of their nodes, and what they ask for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, solved, turned
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.reduced import MeanAxes

SETTLED = 1e-5
"""Modes are found until their frequencies change by no more than 1e-10 of themselves, and so their
shapes to the root of that."""


@dataclass(frozen=True)
class Weights:
    """How a scheme weighs start and end of a step.

    Parameters
    ----------
    theta, xi
        θ of velocities, and ξ of forces.
    stress
        How much of the end counts in stresses.
    dt
        Length of the step [s].
    """

    theta: float
    xi: float
    stress: float
    dt: float


@dataclass(frozen=True)
class ReducedStep:
    """The motion of a reduced body in a step.

    Parameters
    ----------
    body
        The body.
    start, end
        Its frames at both ends.
    shift
        How far its centre moves [m], shape [D].
    turn
        ϑ: the frame turns by 2 arctan(|ϑ|/2) about it.
    """

    body: AuditBody
    start: MeanAxes
    end: MeanAxes
    shift: Array
    turn: Array

    @classmethod
    def of(cls, body: AuditBody, u0: Array, u1: Array) -> ReducedStep:
        """Return that between two displacements of the nodes [m]."""
        start, end = (MeanAxes.of(body.mass, body.points, u) for u in (u0, u1))
        rotation = end.rotation @ start.rotation.T
        skew = rotation - rotation.T
        if len(skew) == 2:
            turn = 2.0 * skew[1:, 0] / (2.0 + np.trace(rotation))
        else:
            parts = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
            turn = 2.0 * parts / (1.0 + np.trace(rotation))
        return cls(body, start, end, body.mass.mean(u1 - u0), turn)

    @property
    def arms(self) -> tuple[Array, Array, Array]:
        """Arms of nodes at the start, in the mean and at the end [m], each [node_count, D]."""
        ends = [(at.arms + at.own) @ at.rotation.T for at in (self.start, self.end)]
        half_way = self.start.arms + 0.5 * (self.start.own + self.end.own)
        return ends[0], half_way @ self._mean.T, ends[1]

    @property
    def _mean(self) -> Array:
        """Return ½ (R₀ + R₁), shape [D, D]."""
        mean: Array = 0.5 * (self.start.rotation + self.end.rotation)
        return mean

    @property
    def stretch(self) -> Array:
        """How displacements change that deform it, in its frame [m], shape [node_count, D]."""
        stretch: Array = self.end.own - self.start.own
        return stretch

    def scheme(self, v0: Array, weights: Weights) -> Array:
        """Return the velocities of nodes at the end that the scheme makes of the motion [m/s]."""
        kept, rate = 1.0 - 1.0 / weights.theta, 1.0 / (weights.theta * weights.dt)
        drift, spin, own = self.start.rates(v0)
        later = kept * drift + rate * self.shift
        turning = kept * self._carried(spin) + rate * self.turn
        vibrating = kept * own + rate * self.stretch
        velocity: Array = later + turned(self.arms[2], turning) + vibrating @ self.end.rotation.T
        return velocity

    def _carried(self, spin: Array) -> Array:
        """Return a spin that has turned with the body [rad/s]."""
        if len(spin) == 1:
            return spin
        carried: Array = self.end.rotation @ self.start.rotation.T @ spin
        return carried

    def accelerated(self, impulse: Array) -> Array:
        """Return the velocities that impulses at the end give the nodes [m/s]."""
        drift = impulse.sum(axis=0) / self.body.mass.total
        spin = solved(self.end.inertia, cross(self.arms[2], impulse).sum(axis=0))
        own = self.body.vibrations.yielding(impulse @ self.end.rotation)
        velocity: Array = drift + turned(self.arms[2], spin) + own @ self.end.rotation.T
        return velocity

    def borne(self, impulse: Array) -> Array:
        """Return M Δv of the velocities that impulses at the end give the nodes [N s]."""
        return self.body.mass.times(self.accelerated(impulse))

    def residual(
        self,
        velocities: tuple[Array, Array, Array],
        forces: tuple[Array, Array],
        weights: Weights,
    ) -> Array:
        """Return what momenta and amplitudes lack, as forces on nodes [N], shape [node_count, D].

        Forces of the step count by their resultant, their moments by mean arms, and as R̄ᵀ f on
        amplitudes, impulses by what all of these are at the end.

        Parameters
        ----------
        velocities
            Of nodes at the start, by the scheme, and at the end [m/s].
        forces
            Forces of the step on the nodes, and impulses at its end over Δt [N].
        weights
            How the scheme weighs both ends.
        """
        body, (during, impulses) = self.body, forces
        (c0, s0, w0), (_, _, w1), (c2, s2, w2) = (
            at.rates(v) for at, v in zip((self.start, self.end, self.end), velocities, strict=True)
        )
        force = body.mass.total * (c2 - c0) / weights.dt - (during + impulses).sum(axis=0)
        spun = self.end.inertia @ s2 - self.start.inertia @ s0
        moment = spun / weights.dt - cross(self.arms[1], during).sum(axis=0)
        moment -= cross(self.arms[2], impulses).sum(axis=0)
        own = body.mass.times(w2 - w0) / weights.dt
        own += body.linear_force(self._at(weights.stress, self.start.own, self.end.own))
        own += body.damping * body.linear_force(self._at(weights.xi, w0, w1))
        own -= during @ self._mean + impulses @ self.end.rotation
        turn = solved(body.nodal_inertia(self.arms[1]), moment)
        whole = force / body.mass.total + turned(self.arms[1], turn)
        lacking: Array = body.mass.nodal[:, None] * whole
        if body.vibrations.doubt:
            return lacking
        lacking += body.vibrations.borne(own) @ self._mean.T
        return lacking

    def taken(self, v0: Array, v1: Array, weights: Weights) -> tuple[float, float]:
        """Return what the scheme takes in a step to these velocities, and damping [J]."""
        body = self.body
        (c0, s0, w0), (c1, s1, w1) = self.start.rates(v0), self.end.rates(v1)
        spins = [
            spin if len(spin) == 1 else at.rotation.T @ spin
            for at, spin in ((self.start, s0), (self.end, s1))
        ]
        gained = spins[1] - spins[0]
        # That of mean axes as they are drawn.
        inertia = MeanAxes.of(body.mass, body.points, np.zeros_like(v0)).inertia
        jump = body.mass.total * float((c1 - c0) @ (c1 - c0)) + float(gained @ inertia @ gained)
        jump += float(((w1 - w0) * body.mass.times(w1 - w0)).sum())
        resisted = float((self.stretch * body.linear_force(self.stretch)).sum())
        scheme = (weights.theta - 0.5) * jump + (weights.stress - 0.5) * resisted
        mean = body.linear_force(self._at(weights.xi, w0, w1))
        return scheme, body.damping * float((mean * self.stretch).sum())

    @staticmethod
    def _at(weight: float, start: Array, end: Array) -> Array:
        between: Array = (1.0 - weight) * start + weight * end
        return between


def unshaped(body: AuditBody, u: Array) -> tuple[Array, float]:
    """Return what nodes have at displacements u beside the shapes of a reduced body [m].

    And how far these may be off, as the run knows them.
    """
    own = MeanAxes.of(body.mass, body.points, u).own
    return own - body.vibrations.projected(own), SETTLED * float(np.abs(own).max())
