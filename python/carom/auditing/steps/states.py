"""The two states of a step, and the motion between them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, turned
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.reduced_step import ReducedStep, Weights
from carom.auditing.bodies.rigid import RigidStep
from carom.auditing.model import AuditModel


class States:
    """The states of a step as stored in ``audit.h5``.

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
        self.landing: Array = stored["landing"]
        self.settling: Array = stored["settling"]
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

    @property
    def starts_elsewhere(self) -> bool:
        """Whether the contacts at its start are not where that is: see `AuditModel`."""
        model = self.model
        return model.starts_elsewhere and float(self.start["time"]) == model.stage.start_time

    @property
    def settles(self) -> bool:
        """Whether it is the load step in which what went on with inertia comes to rest.

        The time of loads stands still in it.
        """
        return self.model.stabilised and float(self.start["time"]) == self.time

    @property
    def uses_start(self) -> bool:
        """Whether the reactions of its start count in it."""
        return self.model.static or self.model.massless

    def _length(self) -> tuple[float, float, float]:
        """Return the length of the step, how far it is from one of the time grid, and its parts.

        Both are in s, and the parts are how often a nominal step has the length.

        Nominal steps are equal but for a shorter last one, and those that failed are halved; the
        difference of two times has more round-off than a step may have.
        """
        if self.settles:
            return 0.0, 0.0, 1.0
        analysis = self.model.analysis
        nominal, end = analysis.time_step, self.model.stage.duration
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
            field = body.vibration(u, v, self.model.supports[index].held) / (1.0 + share)
            energy[index] = body.kinetic_energy(u, field)
            v -= share * field
        return before, energy

    @property
    def repaid(self) -> Array:
        """What vibration gave of what the blend left over [J], shape [body_count]."""
        repaid: Array = self.vibration * self.shares * (2.0 + self.shares)
        return repaid

    @property
    def ends(self) -> list[tuple[Array, float]]:
        """Displacements [m] and times [s] of start and end."""
        return [(self.u0, float(self.start["time"])), (self.u1, self.time)]

    def grown(self, body: AuditBody) -> tuple[float, float]:
        """Return how a body has grown at start and end: its linear strain."""
        return body.growth.at(float(self.start["time"])), body.growth.at(self.time)

    def _growing(self) -> float:
        """Return by how much the size of a body would change by what it grows [m]."""
        changes = []
        for body in self.model.bodies:
            before, after = self.grown(body)
            changes.append(abs(after - before) * float(np.linalg.norm(np.ptp(body.points, axis=0))))
        return max(changes)

    def _motion(self) -> float:
        """Return the largest motion of a node in the step, or that of free flight if larger [m]."""
        if self.model.static:
            driven = max(self.model.fastest_obstacle * self.dt, self._growing())
            return float(max(np.abs(self.d).max(), driven))
        speed = max(np.linalg.norm(self.v0, axis=1).max(), self.model.fastest_obstacle)
        predicted = (speed + np.linalg.norm(self.model.gravity) * self.dt) * self.dt
        return float(max(np.abs(self.d).max(), predicted, self._growing()))

    def _scheme_velocity(self) -> Array:
        """Return the velocities that the scheme makes of the motion, before impulses [m/s]."""
        theta = self.model.theta
        if self.model.static:
            return np.zeros_like(self.d)
        velocity: Array = (1 - 1 / theta) * self.v0 + self.d / (theta * self.dt)
        for body, supports in zip(self.model.bodies, self.model.supports, strict=True):
            if len(body.massless):
                mean = self.d[body.span] / self.dt
                faster = body.mass.mean(velocity[body.span] - mean)
                velocity[body.span][body.massless] = (mean + faster)[body.massless]
            if body.rigid:
                u0, v0 = self.u0[body.span], self.v0[body.span]
                velocity[body.span] = self.rigid(body).scheme(u0, v0, theta, self.dt)[0]
            elif body.modes is not None:
                v0 = self.v0[body.span]
                velocity[body.span] = self.reduced(body).scheme(v0, self.weights)
            elif len(supports):
                given = supports.velocity(self.time)
                velocity[body.span][supports.held] = given[supports.held]
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

    @property
    def held_d(self) -> Array:
        """The motion of what supports hold, zero elsewhere [m], shape [node_count, D]."""
        return self._held(self.d)

    @property
    def held_v(self) -> Array:
        """The same of velocities at the end [m/s]."""
        return self._held(self.end["velocity"])

    def _held(self, motion: Array) -> Array:
        held = np.zeros_like(motion)
        for body, supports in zip(self.model.bodies, self.model.supports, strict=True):
            held[body.span] = np.where(supports.held, motion[body.span], 0.0)
        return held

    @property
    def weights(self) -> Weights:
        """How the scheme weighs both ends."""
        model = self.model
        stress = 0.5 if model.conserving else model.xi
        return Weights(theta=model.theta, xi=model.xi, stress=stress, dt=self.dt)

    def whole(self, body: AuditBody) -> RigidStep | ReducedStep:
        """Return the motion of a body whose equations are those of its momenta."""
        return self.rigid(body) if body.rigid else self.reduced(body)

    def reduced(self, body: AuditBody) -> ReducedStep:
        """Return the motion of a reduced body."""
        return ReducedStep.of(body, self.u0[body.span], self.u1[body.span])

    def rigid(self, body: AuditBody) -> RigidStep:
        """Return the motion of a rigid body."""
        guiding = self.model.supports[self.model.bodies.index(body)].guiding(self.time)
        return RigidStep.of(body, self.u0[body.span], self.d[body.span], guiding)

    def position(self, weight: float) -> Array:
        """Return the positions between start (0) and end (1) of the step [m]."""
        return self.model.points + self.u0 + weight * self.d
