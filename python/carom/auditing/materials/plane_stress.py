"""Laws in a sheet that is free of stress across its plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.materials.laws import Law
from carom.auditing.materials.tensors import deformation, discrete_gradient

STEPS = 60
"""Most steps to the stretch across the plane."""

FREE = 1e-15
"""Changes of its logarithm below this end them."""

WIDTH = 1e-6
"""Of the difference by which the slope of the stress is found."""


@dataclass(frozen=True)
class PlaneStress:
    """A law with the F₃₃ that makes P₃₃ = 0; the energy of the sheet is ψ with it.

    Parameters
    ----------
    law
        The law in space.
    """

    law: Law

    @property
    def first(self) -> float:
        """λ of the sheet [Pa]: 2λμ/(λ + 2μ)."""
        return 2.0 * self.law.first * self.law.second / self.law.modulus

    @property
    def second(self) -> float:
        """μ [Pa]."""
        return self.law.second

    @property
    def modulus(self) -> float:
        """λ + 2μ of the law [Pa]."""
        return self.law.modulus

    @property
    def objective(self) -> bool:
        """Whether a rotation strains nothing."""
        return self.law.objective

    @property
    def subtracts(self) -> bool:
        """Whether ψ is a small difference of terms of the size of its moduli."""
        return self.law.subtracts

    def wave_speed(self, density: float) -> float:
        """Return the speed of pressure waves in the sheet [m/s] at a density [kg/m³]."""
        return float(np.sqrt((self.first + 2.0 * self.second) / density))

    def energy(self, f: Array) -> Array:
        """Return ψ [J/m³] of F in the plane, shape [..., 3, 3], shape [...]."""
        return self.law.energy(self._in_space(f))

    def potential(self, f: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""
        return self.energy(f)

    def stress(self, f: Array) -> Array:
        """Return P [Pa], shape [..., 3, 3]."""
        return self.law.stress(self._in_space(f))

    def cauchy_stress(self, f: Array) -> Array:
        """Return P Fᵀ/J [Pa] in space, shape [..., 3, 3]."""
        return self.law.cauchy_stress(self._in_space(f))

    def discrete_stress(self, f0: Array, f1: Array) -> Array:
        """Return the stress P̄ [Pa] of a step whose work is the change of ψ, see `Law`."""
        if not self.objective:
            return self.stress(0.5 * (f0 + f1))
        gained = self.energy(f1) - self.energy(f0)
        return discrete_gradient(f0, f1, self._of_c, gained)

    def _of_c(self, c: Array) -> Array:
        return self._second_piola(deformation(c))

    def stress_difference(self, f0: Array, f1: Array) -> Array:
        """Return ½(F₀ + F₁)(S₁ − S₀) [Pa], shape [..., 3, 3]."""
        if not self.objective:
            return self.stress(f1) - self.stress(f0)
        difference: Array = 0.5 * (f0 + f1) @ (self._second_piola(f1) - self._second_piola(f0))
        return difference

    def _second_piola(self, f: Array) -> Array:
        """Return S in the plane [Pa]; across it there is none."""
        whole = self._in_space(f)
        stress: Array = np.linalg.solve(whole, self.law.stress(whole)).astype(np.float64)
        stress[..., 2, 2] = 0.0
        return stress

    def _in_space(self, f: Array) -> Array:
        """Return F with F₃₃ where P₃₃ = 0, by secants of the Kirchhoff stress over ln F₃₃."""
        whole: Array = f.copy()
        if not self.objective:
            strain = self.law.first / self.law.modulus * (f[..., 0, 0] + f[..., 1, 1] - 2.0)
            whole[..., 2, 2] = 1.0 - strain
            return whole

        def pressed(logarithm: Array) -> Array:
            whole[..., 2, 2] = np.exp(logarithm)
            return self.law.stress(whole)[..., 2, 2] * whole[..., 2, 2]

        at: Array = np.zeros(f.shape[:-2])
        for _ in range(STEPS):
            slope = (pressed(at + WIDTH) - pressed(at - WIDTH)) / (2.0 * WIDTH)
            change = np.clip(-pressed(at) / slope, -1.0, 1.0)
            at += change
            if float(np.abs(change).max(initial=0.0)) <= FREE:
                break
        whole[..., 2, 2] = np.exp(at)
        return whole
