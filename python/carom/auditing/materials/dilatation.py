"""Cells with one change of volume each (Simo, Taylor & Pister 1985)."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, einsum
from carom.auditing.materials.tensors import (
    contracted,
    deformation,
    discrete_gradient,
    transposed,
)


class Response(Protocol):
    """What energies and stresses cells have at their points, shape [cell_count, q, 3, 3]."""

    def energy(self, f: Array) -> Array:
        """Return ψ [J/m³] of F, shape [cell_count, q]."""

    def potential(self, f: Array) -> Array:
        """Return ψ and the plastic work of a step to F together [J/m³], shape [cell_count, q]."""

    def plastic_work(self, f: Array) -> Array:
        """Return the plastic work of a step to F [J/m³], shape [cell_count, q]."""

    def plastic_strain(self, f: Array) -> Array:
        """Return the equivalent plastic strain after a step to F, shape [cell_count, q]."""

    def advance(self, f: Array) -> None:
        """Remember what a step to F leaves."""

    def stress(self, f: Array) -> Array:
        """Return P [Pa], whose work is the change of energy."""

    def cauchy_stress(self, f: Array) -> Array:
        """Return P Fᵀ/J [Pa]."""

    def discrete_stress(self, f0: Array, f1: Array) -> Array:
        """Return the stress of a step whose work is the change of ψ."""

    def stress_difference(self, f0: Array, f1: Array) -> Array:
        """Return ½(F₀ + F₁)(S₁ − S₀) [Pa]."""


class MeanDilatation:
    """The law sees F̂ = (J̄/J)^⅓ F with J̄ the mean of J over the cell.

    Parameters
    ----------
    law
        What the law says, cell by cell; objective.
    weights
        Volumes of the points [m³], shape [cell_count, q].
    """

    def __init__(self, law: Response, weights: Array) -> None:
        self._law, self._weights = law, weights

    def energy(self, f: Array) -> Array:
        """Return ψ(F̂) [J/m³], shape [cell_count, q]."""
        return self._law.energy(self._modified(f))

    def potential(self, f: Array) -> Array:
        """Return ψ(F̂) and the plastic work together [J/m³], shape [cell_count, q]."""
        return self._law.potential(self._modified(f))

    def plastic_work(self, f: Array) -> Array:
        """Return the plastic work of a step to F [J/m³], shape [cell_count, q]."""
        return self._law.plastic_work(self._modified(f))

    def plastic_strain(self, f: Array) -> Array:
        """Return the equivalent plastic strain after a step to F, shape [cell_count, q]."""
        return self._law.plastic_strain(self._modified(f))

    def advance(self, f: Array) -> None:
        """Remember what a step to F leaves."""
        self._law.advance(self._modified(f))

    def stress(self, f: Array) -> Array:
        """Return P [Pa]: Σ w P:δF is the change of Σ w ψ(F̂), shape [cell_count, q, 3, 3]."""
        modified = self._modified(f)
        inner = self._law.stress(modified)
        # δF̂ = α (δF − ⅓ (F⁻ᵀ:δF) F) + ⅓ (Σ w J F⁻ᵀ:δF / Σ w J) F̂ with α = (J̄/J)^⅓.
        j, mean = np.linalg.det(f), self._mean(f)
        pressure = contracted(inner, modified) / 3.0
        swelling = self._weights * j
        shared = einsum("cq,cq->c", self._weights, pressure) / swelling.sum(axis=1)
        along = (shared[:, None] * j - pressure)[..., None, None]
        alpha = ((mean / j) ** (1 / 3))[..., None, None]
        inverse = np.linalg.inv(f).astype(np.float64)
        stress: Array = alpha * inner + along * transposed(inverse)
        return stress

    def cauchy_stress(self, f: Array) -> Array:
        """Return P Fᵀ/J [Pa], shape [cell_count, q, 3, 3]."""
        stress: Array = self.stress(f) @ transposed(f) / np.linalg.det(f)[..., None, None]
        return stress

    def discrete_stress(self, f0: Array, f1: Array) -> Array:
        """Return ½(F₀ + F₁)(S + κ ΔE), with S at the mean strains and κ one number per cell."""
        gained = self.potential(f1) - self.potential(f0)
        return discrete_gradient(f0, f1, self._of_c, gained, self._weights)

    def _of_c(self, c: Array) -> Array:
        return self._second_piola(deformation(c))

    def stress_difference(self, f0: Array, f1: Array) -> Array:
        """Return ½(F₀ + F₁)(S₁ − S₀) [Pa], shape [cell_count, q, 3, 3]."""
        difference: Array = 0.5 * (f0 + f1) @ (self._second_piola(f1) - self._second_piola(f0))
        return difference

    def _second_piola(self, f: Array) -> Array:
        return np.asarray(np.linalg.solve(f, self.stress(f)), dtype=np.float64)

    def _mean(self, f: Array) -> Array:
        """Return J̄ at every point of a cell, shape [cell_count, 1]."""
        volume = (self._weights * np.linalg.det(f)).sum(axis=1, keepdims=True)
        mean: Array = volume / self._weights.sum(axis=1, keepdims=True)
        return mean

    def _modified(self, f: Array) -> Array:
        ratio = self._mean(f) / np.linalg.det(f)
        modified: Array = np.cbrt(ratio)[..., None, None] * f
        return modified
