"""The motion of a body as a whole: its momenta, its turn, and what of its energy is in these."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import (
    Array,
    Indices,
    Mask,
    cross,
    inertia,
    nearest_rotation,
    solved,
    turned,
    turning_axes,
)
from carom.auditing.bodies.mass_matrix import MassMatrix
from carom.auditing.bodies.reduced import MeanAxes

KINETIC_PARTS = ("translation", "rotation", "vibration")
"""What kinetic energy is split into, as `MovingBody.kinetic_parts` returns it."""


class MovingBody:
    """What moves of a body."""

    points: Array
    """Reference positions of its nodes [m], shape [node_count, D]."""

    dimension: int
    """D."""

    mass: MassMatrix
    """Its mass."""

    massless: Indices
    """Nodes without mass."""

    modes: int | None
    """Modes of a reduced body beside the shapes of its contact surface."""

    images: Indices
    """Nodes that move with another: of a body that repeats itself."""

    turns: bool
    """Whether it can turn without storing energy."""

    revolution: bool
    """Whether it is one of revolution, which moves along its axis only."""

    more: Array
    """What a rigid body has more of inertia than its cells have, as drawn [kg m²]."""

    def rotation(self, u: Array) -> Array:
        """Return the mean rotation of the body: the polar factor of Σ m (x − c) ⊗ (X − C)."""
        return self.turned_to(u) if self.turns else np.eye(self.dimension)

    def turned_to(self, u: Array) -> Array:
        """Return how the nodes have turned, whatever the body is."""
        x, reference = self.points + u, self.points
        weight = self.mass.nodal[:, None]
        arms = reference - self.mass.mean(reference)
        moment = (weight * (x - self.mass.mean(x))).T @ arms
        return nearest_rotation(moment @ np.linalg.inv((weight * arms).T @ arms))

    def inertia(self, u: Array) -> Array:
        """Return its inertia about its centre [kg m²], shape [1, 1] or [3, 3].

        That of a rigid body may be another than that of its cells, and turns with it.
        """
        if self.modes is not None:
            return self._axes(u).inertia
        whole = inertia(self.arms(u), self.mass.times)
        if self.more.any():
            turn = self.turned_to(u) if self.dimension == 3 else np.eye(1)
            whole = whole + turn @ self.more @ turn.T
        return whole

    def arms(self, u: Array) -> Array:
        """Return the arms of nodes about the centre [m], shape [node_count, D]."""
        x = self.points + u
        return x - self.mass.mean(x)

    def _more_at(self, u: Array, v: Array) -> Array:
        """Return the angular momentum that the cells of a rigid body do not have [kg m²/s]."""
        if not self.more.any():
            return np.zeros(turning_axes(self.dimension))
        more = self.inertia(u) - inertia(self.arms(u), self.mass.times)
        return more @ self.spin(u, v)

    def kinetic_energy(self, u: Array, v: Array) -> float:
        """Return ½ vᵀMv [J]; a rigid body may have another inertia than its cells."""
        if self.modes is not None:
            return self._axes(u).kinetic_energy(v)
        energy = 0.5 * float((v * self.mass.times(v)).sum())
        return energy + 0.5 * float(self.spin(u, v) @ self._more_at(u, v))

    def angular_momentum(self, u: Array, v: Array) -> Array:
        """Return that about the origin [kg m²/s]."""
        if self.revolution:
            return np.zeros(1)
        if self.modes is not None:
            return self._axes(u).angular_momentum(self.mass.mean(self.points + u), v)
        own: Array = cross(self.points + u, self.mass.times(v)).sum(axis=0)
        return own + self._more_at(u, v)

    def momentum(self, v: Array) -> Array:
        """Return Σ M v [kg m/s], shape [D]."""
        return self.mass.resultant(self.mass.times(v))

    def kinetic_parts(self, u: Array, v: Array) -> tuple[float, float, float]:
        """Return that of the centre, of the turn as a rigid body, and the rest [J].

        A body that repeats itself does not turn.
        """
        momentum = self.momentum(v)
        translation = 0.5 * float(momentum @ momentum) / float(self.mass.nodal.sum())
        rotation = 0.0
        if not self.images.size and not self.revolution:
            centre = self.mass.mean(self.points + u)
            moment = self.angular_momentum(u, v) - cross(centre, momentum)
            rotation = 0.5 * float(moment @ solved(self.inertia(u), moment))
        return translation, rotation, self.kinetic_energy(u, v) - translation - rotation

    def vibration(self, u: Array, v: Array, held: Mask) -> Array:
        """Return v less a rigid motion of the same momenta [m/s]; zero at nodes without mass.

        Where something is `held`, shape [node_count, D], only translations are left that supports
        leave free, and nothing where supports move. Reduced bodies neither take nor give.
        """
        if v[held].any() or self.modes is not None:
            return np.zeros_like(v)
        arms, momenta = self.arms(u), self.mass.times(v)
        drift = self.mass.resultant(momenta) / self.mass.total
        field: Array = v - np.where(held.any(axis=0), 0.0, drift)
        if not held.any() and not self.images.size and not self.revolution:
            moment = cross(arms, momenta).sum(axis=0)
            field -= turned(arms, solved(inertia(arms, self.mass.times), moment))
        field[self.massless] = 0.0
        return field

    def nodal_inertia(self, arms: Array) -> Array:
        """Return the inertia of nodes with the row sums of the mass [kg m²]."""
        return inertia(arms, lambda field: self.mass.nodal[:, None] * field)

    def spin(self, u: Array, v: Array) -> Array:
        """Return the mean spin about the centre [rad/s], by row sums of the mass; of mean axes."""
        if self.revolution:
            return np.zeros(1)
        if self.modes is not None:
            return self._axes(u).rates(v)[1]
        arms = self.arms(u)
        moment = self.mass.nodal @ cross(arms, v - self.mass.mean(v))
        return solved(self.nodal_inertia(arms), moment)

    def _axes(self, u: Array) -> MeanAxes:
        return MeanAxes.of(self.mass, self.points, u)
