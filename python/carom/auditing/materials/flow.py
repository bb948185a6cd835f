"""Metal that flows: von Mises' criterion at large strain, point by point from what it remembers."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, einsum
from carom.auditing.materials.tensors import discrete_gradient, transposed
from carom.case.material import J2Plasticity

NO_FLOW = 1e-14
"""Increments below this are round-off of a point that is at its yield stress."""

ITERATIONS = 100
"""Most bisections to the increment of plastic strain; Newton's steps within them take a few."""


class Flow:
    """ψ = ½ κ (tr ε)² + μ |dev ε|² of ε = ln Vᵉ, with √(3/2) |dev τ| ≤ σ_y(α) (Simo 1992).

    A step from what a point remembers, C_p⁻¹ and α, has the potential ψ + ∫σ_y dα, whose minimum
    over Δα is the flow (Ortiz & Stainier 1999). Until `advance` all functions are of steps that
    start from there.

    Parameters
    ----------
    material
        Its constants.
    """

    objective, subtracts = True, True

    def __init__(self, material: J2Plasticity) -> None:
        self._given = material
        young, poisson = material.young, material.poisson
        self.first = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        self.second = young / (2 * (1 + poisson))
        self._inverse: Array = np.eye(3)
        """C_p⁻¹, shape [cell_count, q, 3, 3] once something has flowed."""
        self._alpha: Array = np.zeros(())
        """Equivalent plastic strain, shape [cell_count, q] then."""

    @property
    def modulus(self) -> float:
        """λ + 2μ [Pa]."""
        return self.first + 2 * self.second

    def wave_speed(self, density: float) -> float:
        """Return the speed of pressure waves [m/s] at a density [kg/m³]."""
        return float(np.sqrt(self.modulus / density))

    def energy(self, f: Array) -> Array:
        """Return the elastic energy ψ [J/m³] once it has flowed to F, shape [..., 3, 3]."""
        strains, _, increment = self._returned(f)
        mean = strains.mean(axis=-1, keepdims=True)
        shear = np.sqrt(((strains - mean) ** 2).sum(axis=-1))
        # What flows shortens dev ε by √(3/2) Δα.
        left = shear - np.sqrt(1.5) * increment
        bulk = self.first + 2.0 / 3.0 * self.second
        energy: Array = 0.5 * bulk * strains.sum(axis=-1) ** 2 + self.second * left**2
        return energy

    def plastic_work(self, f: Array) -> Array:
        """Return ∫σ_y dα [J/m³] of flow to F, shape [...]."""
        m, alpha = self._given, self._alpha
        _, _, more = self._returned(f)
        work = m.yield_stress * more + m.hardening * more * (alpha + 0.5 * more)
        if m.saturation_rate > 0.0 and m.saturation_stress is not None:
            rate = m.saturation_rate
            grown = more + np.exp(-rate * alpha) * np.expm1(-rate * more) / rate
            work = work + (m.saturation_stress - m.yield_stress) * grown
        return np.asarray(work, dtype=np.float64)

    def potential(self, f: Array) -> Array:
        """Return ψ and the plastic work together [J/m³], shape [...]."""
        return self.energy(f) + self.plastic_work(f)

    def plastic_strain(self, f: Array) -> Array:
        """Return the equivalent plastic strain after flow to F, shape [...]."""
        return self._alpha + self._returned(f)[2]

    def advance(self, f: Array) -> None:
        """Remember what flow to F leaves."""
        strains, axes, increment = self._returned(f)
        mean = strains.mean(axis=-1, keepdims=True)
        shear = np.sqrt(((strains - mean) ** 2).sum(axis=-1))
        ratio = np.sqrt(1.5) * increment / np.where(shear > 0, shear, 1.0)
        shrunk = np.exp(-2.0 * ratio[..., None] * (strains - mean))
        q = self._root()
        inverse = q @ einsum("...ik,...k,...jk->...ij", axes, shrunk, axes) @ transposed(q)
        flowed = (increment > 0.0)[..., None, None]
        before = np.broadcast_to(self._inverse, inverse.shape)
        self._inverse = np.where(flowed, 0.5 * (inverse + transposed(inverse)), before)
        self._alpha = self._alpha + increment

    def go_on(self, before: Flow) -> None:
        """Remember what another one does."""
        self._inverse, self._alpha = before._inverse, before._alpha

    def stress(self, f: Array) -> Array:
        """Return P [Pa], shape [..., 3, 3]."""
        stress: Array = f @ self._second_piola(transposed(f) @ f)
        return stress

    def cauchy_stress(self, f: Array) -> Array:
        """Return P Fᵀ/J [Pa], shape [..., 3, 3]."""
        stress: Array = self.stress(f) @ transposed(f) / np.linalg.det(f)[..., None, None]
        return stress

    def discrete_stress(self, f0: Array, f1: Array) -> Array:
        """Return the stress of a step whose work is the change of the potential."""
        gained = self.potential(f1) - self.potential(f0)
        return discrete_gradient(f0, f1, self._second_piola, gained)

    def stress_difference(self, f0: Array, f1: Array) -> Array:
        """Return ½(F₀ + F₁)(S₁ − S₀) [Pa], shape [..., 3, 3]."""
        s0, s1 = (self._second_piola(transposed(f) @ f) for f in (f0, f1))
        difference: Array = 0.5 * (f0 + f1) @ (s1 - s0)
        return difference

    def _second_piola(self, c: Array) -> Array:
        """Return S = Q [Σ τ_a/λ_a² n_a ⊗ n_a] Qᵀ [Pa], τ after the return, shape [..., 3, 3]."""
        strains, axes, increment = self._of_c(c)
        volume = strains.sum(axis=-1, keepdims=True)
        shear = np.sqrt(((strains - volume / 3.0) ** 2).sum(axis=-1))
        left = 1.0 - np.sqrt(1.5) * increment / np.where(shear > 0, shear, 1.0)
        bulk = self.first + 2.0 / 3.0 * self.second
        tau = bulk * volume + 2.0 * self.second * left[..., None] * (strains - volume / 3.0)
        q = self._root()
        relative = einsum("...ik,...k,...jk->...ij", axes, tau * np.exp(-2.0 * strains), axes)
        stress: Array = q @ relative @ transposed(q)
        return stress

    def _root(self) -> Array:
        """Return Q with Q Qᵀ = C_p⁻¹, shape [..., 3, 3]."""
        return np.asarray(np.linalg.cholesky(self._inverse), dtype=np.float64)

    def _returned(self, f: Array) -> tuple[Array, Array, Array]:
        return self._of_c(transposed(f) @ f)

    def _of_c(self, c: Array) -> tuple[Array, Array, Array]:
        """Return logarithmic trial strains, their axes and Δα, shapes [..., 3], [..., 3, 3], [...].

        They are of QᵀCQ, the deformation since the plastic one.
        """
        q = self._root()
        squares, axes = np.linalg.eigh(transposed(q) @ c @ q)
        strains = 0.5 * np.log(squares)
        mean = strains.mean(axis=-1, keepdims=True)
        trial = np.sqrt(6.0) * self.second * np.sqrt(((strains - mean) ** 2).sum(axis=-1))
        return strains, np.asarray(axes, dtype=np.float64), self._increment(trial)

    def _yield(self, alpha: Array) -> Array:
        m = self._given
        stress = m.yield_stress + m.hardening * alpha
        if m.saturation_stress is not None:
            more = m.saturation_stress - m.yield_stress
            stress = stress - more * np.expm1(-m.saturation_rate * alpha)
        return np.asarray(stress, dtype=np.float64)

    def _increment(self, trial: Array) -> Array:
        """Return Δα with q − 3 μ Δα = σ_y(α + Δα), zero below yield, by bisection and secants."""
        alpha = np.broadcast_to(self._alpha, trial.shape)

        def excess(more: Array) -> Array:
            return trial - 3.0 * self.second * more - self._yield(alpha + more)

        low, high = np.zeros(trial.shape), np.maximum(trial, 0.0) / (3.0 * self.second)
        above, below = excess(low), excess(high)
        flows = above > 0.0
        for turn in range(ITERATIONS):
            span = above - below
            share = np.where(span > 0, above / np.where(span > 0, span, 1.0), 0.5)
            middle = low + (high - low) * (0.5 if turn % 3 == 2 else share)
            value = excess(middle)
            rises = value > 0.0
            low, above = np.where(rises, middle, low), np.where(rises, value, above)
            high, below = np.where(rises, high, middle), np.where(rises, below, value)
            if not (flows & (high - low > np.finfo(np.float64).eps * high)).any():
                break
        best = np.where(np.abs(above) < np.abs(below), low, high)
        return np.where(flows & (best > NO_FLOW), best, 0.0)
