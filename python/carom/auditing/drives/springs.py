"""Springs and dampers as the auditor sees them: tension, energy, and the pull of a step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.places import mean_of
from carom.auditing.contact.obstacles import AuditObstacle
from carom.auditing.functions.signals import Travel
from carom.case import spring as case


@dataclass(frozen=True)
class Tension:
    """A tension that is linear in the elongation between points, and goes on beyond them.

    Parameters
    ----------
    elongation, force
        Elongations [m], ascending, and the tension at each [N], shape [count].
    """

    elongation: Array
    force: Array

    @classmethod
    def of(cls, spring: case.Spring) -> Tension:
        """Return that of a spring; a damper alone has none."""
        if spring.force is None:
            return cls(np.array([0.0, 1.0]), np.array([0.0, spring.stiffness or 0.0]))
        return cls(np.array(spring.force.elongation), np.array(spring.force.force))

    @property
    def steepest(self) -> float:
        """The largest change of the tension per elongation [N/m]."""
        return float(np.abs(np.diff(self.force) / np.diff(self.elongation)).max())

    def at(self, elongation: Array) -> Array:
        """Return the tension [N] at elongations [m], shape [count]."""
        e, f = self.elongation, self.force
        slopes = np.diff(f) / np.diff(e)
        tension: Array = np.interp(elongation, e, f)
        tension += np.minimum(elongation - e[0], 0.0) * slopes[0]
        tension += np.maximum(elongation - e[-1], 0.0) * slopes[-1]
        return tension

    def work(self, start: float, end: float) -> float:
        """Return ∫ F de between two elongations [m] [J], by trapezoids between the points."""
        low, high = min(start, end), max(start, end)
        between = self.elongation[(self.elongation > low) & (self.elongation < high)]
        places = np.array([low, *between, high])
        tension = self.at(places)
        whole = float((np.diff(places) * 0.5 * (tension[1:] + tension[:-1])).sum())
        return whole if end >= start else -whole

    def mean(self, start: float, end: float) -> float:
        """Return the mean tension between two elongations [N]."""
        if start == end:
            return float(self.at(np.array([start]))[0])
        return self.work(start, end) / (end - start)


@dataclass(frozen=True)
class AuditSpring:
    """A spring and a damper on the line between two places, r = r₀ + Σ w u.

    Parameters
    ----------
    name
        Its name.
    nodes, shares
        Nodes of the model, and what of their displacements r has.
    reference
        r where nothing has moved [m], shape [D].
    carried
        Obstacles that carry one of the places, with the sign of what their motion adds to r.
    free_length
        The length without tension [m].
    tension
        The tension over the elongation.
    damping
        Tension per rate of the length [N s/m].
    """

    name: str
    nodes: Indices
    shares: Array
    reference: Array
    carried: tuple[tuple[float, Travel], ...]
    free_length: float
    tension: Tension
    damping: float

    def span(self, displacement: Array, time: float) -> Array:
        """Return r [m], shape [D]."""
        r: Array = self.reference + self.shares @ displacement[self.nodes]
        for sign, travel in self.carried:
            r = r + sign * travel.displacement(time)
        return r

    def energy(self, displacement: Array, time: float) -> float:
        """Return ψ [J]."""
        length = float(np.linalg.norm(self.span(displacement, time)))
        return self.tension.work(0.0, length - self.free_length)

    def length_and_force(
        self, displacement: Array, velocity: Array, time: float
    ) -> tuple[float, float]:
        """Return its length [m] and the force in it, that of the damper included [N]."""
        r = self.span(displacement, time)
        length = float(np.linalg.norm(r))
        rate = self.shares @ velocity[self.nodes]
        for sign, travel in self.carried:
            rate = rate + sign * travel.velocity(time)
        speed = float(rate @ r) / length if length > 0 else 0.0
        force = float(self.tension.at(np.array([length - self.free_length]))[0])
        return length, force + self.damping * speed

    def stiffness(self, dt: float) -> float:
        """Return the largest change of its force per motion of its places in a step [N/m].

        Across its line the tension over the length resists; a spring is taken to be no shorter than
        a tenth of what it is as drawn.
        """
        length = max(float(np.linalg.norm(self.reference)), self.free_length)
        across = 0.0
        if length > 0:
            ends = np.array([-self.free_length, length])
            across = float(np.abs(self.tension.at(ends)).max()) / (0.1 * length)
        return self.tension.steepest + self.damping / dt + across


class Solids(Protocol):
    """What springs may be attached to."""

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""

    @property
    def bodies(self) -> Sequence[AuditBody]:
        """The bodies."""

    @property
    def obstacles(self) -> Sequence[AuditObstacle]:
        """The obstacles."""

    def obstacle(self, name: str) -> AuditObstacle:
        """Return an obstacle by name."""


def build_spring(given: case.Spring, model: Solids) -> AuditSpring:
    """Return a spring of the case between the bodies and obstacles of a model."""
    nodes, shares = [], []
    reference = np.zeros(model.dimension)
    carried: list[tuple[float, Travel]] = []
    for sign, end in zip((-1.0, 1.0), given.between, strict=True):
        if end.body is None:
            reference += sign * np.array(end.point)
            if end.obstacle is not None:
                carried.append((sign, model.obstacle(end.obstacle).travel))
            continue
        body = next(body for body in model.bodies if body.name == end.body)
        place = mean_of(body.places(end))
        nodes.append(place.nodes + body.span.start)
        shares.append(sign * place.shares)
        reference += sign * place.at
    length = float(np.linalg.norm(reference))
    return AuditSpring(
        name=given.name,
        nodes=np.concatenate(nodes),
        shares=np.concatenate(shares),
        reference=reference,
        carried=tuple(carried),
        free_length=length if given.free_length is None else given.free_length,
        tension=Tension.of(given),
        damping=given.damping,
    )
