"""Reduced bodies as the auditor sees them: the frame in which they vibrate, and their energies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, turned
from carom.auditing.mass import Mass


@dataclass(frozen=True)
class MeanAxes:
    """The frame in which the deformation of a body has no part that turns as a whole.

    Parameters
    ----------
    mass
        The mass of the body.
    arms
        Its nodes from its centre in the reference configuration [m], shape [node_count, 2].
    rotation
        The rotation of the frame, shape [2, 2].
    own
        The displacements that deform it, in the frame [m], shape [node_count, 2].
    """

    mass: Mass
    arms: Array
    rotation: Array
    own: Array

    @classmethod
    def of(cls, mass: Mass, points: Array, u: Array) -> MeanAxes:
        """Return that of a body with nodes at `points`, moved by u [m]."""
        arms = points - mass.mean(points)
        now = arms + u - mass.mean(u)
        moved = mass.times(now)
        # Σ X × M Rᵀ x = 0 and Σ X·M Rᵀ x > 0.
        angle = np.arctan2(cross(arms, moved).sum(), (arms * moved).sum())
        cosine, sine = np.cos(angle), np.sin(angle)
        rotation: Array = np.array([[cosine, -sine], [sine, cosine]])
        return cls(mass, arms, rotation, now @ rotation - arms)

    def rates(self, v: Array) -> tuple[Array, float, Array]:
        """Return velocity of the centre [m/s], spin [rad/s], and what deforms it [m/s]."""
        drift = self.mass.mean(v)
        local = (v - drift) @ self.rotation
        about = turned(self.arms + self.own, 1.0)
        spin = cross(self.arms, self.mass.times(local)).sum()
        spin /= cross(self.arms, self.mass.times(about)).sum()
        return drift, float(spin), local - spin * about

    def kinetic_energy(self, v: Array) -> float:
        """Return ½ m v² + ½ J ω² + ½ Σ M of what deforms it [J]."""
        drift, spin, own = self.rates(v)
        energy = self.mass.total * drift @ drift + self.inertia * spin**2
        return 0.5 * float(energy + (own * self.mass.times(own)).sum())

    def angular_momentum(self, centre: Array, v: Array) -> float:
        """Return that about the origin [kg m²/s], with the centre at this place [m]."""
        drift, spin, _ = self.rates(v)
        return float(self.inertia * spin + self.mass.total * cross(centre, drift))

    @property
    def inertia(self) -> float:
        """That about the centre [kg m²], whatever the amplitudes."""
        return float((self.arms * self.mass.times(self.arms)).sum())
