"""Stored energies and stresses of the materials, over arrays of points.

Everything is written for F in space: in plane strain F₃₃ = 1, and F₁₃ = F₂₃ = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.materials.rubber import LawOfC, law_of_c
from carom.auditing.materials.tensors import (
    IDENTITY,
    contracted,
    discrete_gradient,
    transposed,
)
from carom.case.body import InitialStress
from carom.case.material import (
    LinearElastic,
    Material,
    SaintVenantKirchhoff,
)
from carom.errors import InputError


@dataclass(frozen=True)
class Law:
    """A hyperelastic law.

    Parameters
    ----------
    kind
        Its name in the case file.
    first, second
        Lamé's λ and μ [Pa].
    initial
        Stress where nothing has moved [Pa], shape [3, 3].
    of_c
        The law as a function of C, if it is one.
    free
        Along how many axes there is strain: 2 in plane strain.
    """

    kind: str
    first: float
    second: float
    initial: Array
    of_c: LawOfC | None = None
    free: int = 3

    @classmethod
    def of(cls, material: Material, free: int, stress: InitialStress | None = None) -> Law:
        """Return the law of a material under an initial stress, in plane strain if `free` is 2.

        Raises
        ------
        InputError
            The auditor does not know the law.
        """
        s = stress or InitialStress()
        initial = np.array([[s.xx, s.xy, s.xz], [s.xy, s.yy, s.yz], [s.xz, s.yz, s.zz]])
        of_c = law_of_c(material)
        if of_c is not None:
            return cls(material.kind, *of_c.moduli, initial, of_c, free)
        if not isinstance(material, SaintVenantKirchhoff | LinearElastic):
            raise InputError(f"cannot audit the law {material.kind!r} yet")
        young, poisson = material.young, material.poisson
        first = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        second = young / (2 * (1 + poisson))
        return cls(material.kind, first, second, initial, free=free)

    @classmethod
    def none(cls) -> Law:
        """Return the law of a rigid body: no stress and no energy."""
        return cls("saint-venant-kirchhoff", first=0.0, second=0.0, initial=np.zeros((3, 3)))

    @property
    def objective(self) -> bool:
        """Whether a rotation strains nothing."""
        return self.kind != "linear-elastic"

    @property
    def subtracts(self) -> bool:
        """Whether ψ is a small difference of terms of the size of its moduli."""
        return self.of_c is not None

    def wave_speed(self, density: float) -> float:
        """Return the speed of pressure waves [m/s] at a density [kg/m³]."""
        return float(np.sqrt(self.modulus / density))

    @property
    def modulus(self) -> float:
        """λ + 2μ [Pa], the stiffness against a strain with no way to yield."""
        return self.first + 2 * self.second

    @property
    def _stored(self) -> float:
        """½ S₀:E₀ [J/m³] where E₀ is the strain that S₀ takes along the axes that are free."""
        stress = self.initial[: self.free, : self.free]
        if not stress.any():
            return 0.0
        pressure = self.first / (self.free * self.first + 2 * self.second) * np.trace(stress)
        strained = stress - pressure * np.eye(self.free)
        return 0.25 / self.second * float(np.sum(stress * strained))

    def _initial_piola(self, f: Array) -> Array:
        """Return what the initial stress is at F, or at the mean F of a step, [..., 3, 3]."""
        return f @ self.initial if self.objective else np.broadcast_to(self.initial, f.shape)

    def energy(self, f: Array) -> Array:
        """Return ψ [J/m³] of F, shape [..., 3, 3], shape [...].

        An initial stress adds its work S₀:E and what it has stored at F = 1.
        """
        strain = self._strain(f)
        energy: Array = self._energy(f) + contracted(self.initial, strain) + self._stored
        return energy

    def stress(self, f: Array) -> Array:
        """Return the first Piola–Kirchhoff stress P = ∂ψ/∂F [Pa], shape [..., 3, 3]."""
        return self._stress(f) + self._initial_piola(f)

    def cauchy_stress(self, f: Array) -> Array:
        """Return P Fᵀ/J [Pa], shape [..., 3, 3]."""
        j = np.linalg.det(f)[..., None, None]
        stress: Array = self.stress(f) @ transposed(f) / j
        return stress

    def discrete_stress(self, f0: Array, f1: Array) -> Array:
        """Return the stress P̄ [Pa] with P̄ : (F₁ − F₀) = ψ(F₁) − ψ(F₀), shape [..., 3, 3].

        P̄ = ½(F₀ + F₁) S̄. A law that is quadratic in its strain has the mean of both stresses for
        S̄ (Simo & Tarnow 1992), another the discrete gradient in the strain (Gonzalez 2000).
        """
        return self._discrete_stress(f0, f1) + self._initial_piola(0.5 * (f0 + f1))

    def _energy(self, f: Array) -> Array:
        if self.of_c is not None:
            return self.of_c.energy(transposed(f) @ f)
        strain = self._strain(f)
        trace = np.trace(strain, axis1=-2, axis2=-1)
        energy: Array = 0.5 * self.first * trace**2 + self.second * contracted(strain, strain)
        return energy

    def _stress(self, f: Array) -> Array:
        if self.kind == "linear-elastic":
            return self._hooke(self._strain(f))
        return f @ self._second_piola(f)

    def _discrete_stress(self, f0: Array, f1: Array) -> Array:
        mean = 0.5 * (f0 + f1)
        if self.kind == "linear-elastic":
            return self._hooke(self._strain(mean))
        if self.of_c is None:
            return mean @ self._hooke(0.5 * (self._strain(f0) + self._strain(f1)))
        gained = self._energy(f1) - self._energy(f0)
        return discrete_gradient(f0, f1, self.of_c.second_piola, gained)

    def potential(self, f: Array) -> Array:
        """Return ψ [J/m³], to which nothing that flows adds, shape [...]."""
        return self.energy(f)

    def stress_difference(self, f0: Array, f1: Array) -> Array:
        """Return ½(F₀ + F₁)(S₁ − S₀) [Pa], which has no moment, shape [..., 3, 3]."""
        if self.kind == "linear-elastic":
            return self._stress(f1) - self._stress(f0)
        return 0.5 * (f0 + f1) @ (self._second_piola(f1) - self._second_piola(f0))

    def _strain(self, f: Array) -> Array:
        if self.kind == "linear-elastic":
            return 0.5 * (f + transposed(f)) - IDENTITY
        return 0.5 * (transposed(f) @ f - IDENTITY)

    def _hooke(self, strain: Array) -> Array:
        trace = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
        stress: Array = self.first * trace * IDENTITY + 2 * self.second * strain
        return stress

    def _second_piola(self, f: Array) -> Array:
        if self.of_c is not None:
            return self.of_c.second_piola(transposed(f) @ f)
        return self._hooke(self._strain(f))
