"""Reduced bodies as the auditor sees them: the frame in which they vibrate, and their energies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, inertia, nearest_rotation, solved, turned
from carom.auditing.bodies.mass_matrix import MassMatrix


@dataclass(frozen=True)
class MeanAxes:
    """The frame in which the deformation of a body has no part that turns as a whole.

    Parameters
    ----------
    mass
        The mass of the body.
    arms
        Its nodes from its centre in the reference configuration [m], shape [node_count, D].
    rotation
        The rotation of the frame, shape [D, D].
    own
        The displacements that deform it, in the frame [m], shape [node_count, D].
    """

    mass: MassMatrix
    arms: Array
    rotation: Array
    own: Array

    @classmethod
    def of(cls, mass: MassMatrix, points: Array, u: Array) -> MeanAxes:
        """Return that of a body with nodes at `points`, moved by u [m]."""
        arms = points - mass.mean(points)
        now = arms + u - mass.mean(u)
        moved = mass.times(now)
        # Σ X × M Rᵀ x = 0 where Rᵀ Σ M x ⊗ X is symmetric.
        rotation = nearest_rotation(moved.T @ arms)
        return cls(mass, arms, rotation, now @ rotation - arms)

    def rates(self, v: Array) -> tuple[Array, Array, Array]:
        """Return velocity of the centre [m/s], spin [rad/s], and what deforms it [m/s].

        The spin is that in space, the last is in the frame.
        """
        drift = self.mass.mean(v)
        local = (v - drift) @ self.rotation
        axes = np.eye(1 if len(drift) == 2 else 3)
        about = [turned(self.arms + self.own, axis) for axis in axes]
        moments = [cross(self.arms, self.mass.times(field)).sum(axis=0) for field in about]
        moment = cross(self.arms, self.mass.times(local)).sum(axis=0)
        spin = solved(np.stack(moments, axis=1), moment)
        return drift, self._in_space(spin), local - turned(self.arms + self.own, spin)

    def _in_space(self, turn: Array) -> Array:
        return turn if len(turn) == 1 else self.rotation @ turn

    def kinetic_energy(self, v: Array) -> float:
        """Return ½ m v² + ½ ω·J ω + ½ Σ M of what deforms it [J]."""
        drift, spin, own = self.rates(v)
        energy = self.mass.total * drift @ drift + spin @ self.inertia @ spin
        return 0.5 * float(energy + (own * self.mass.times(own)).sum())

    def angular_momentum(self, centre: Array, v: Array) -> Array:
        """Return that about the origin [kg m²/s], with the centre at this place [m]."""
        drift, spin, _ = self.rates(v)
        return self.inertia @ spin + self.mass.total * cross(centre, drift)

    @property
    def inertia(self) -> Array:
        """That about the centre [kg m²] as it has turned, whatever the amplitudes."""
        own = inertia(self.arms, self.mass.times)
        if len(own) == 1:
            return own
        turned_to: Array = self.rotation @ own @ self.rotation.T
        return turned_to
