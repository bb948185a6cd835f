"""Tensors of shape [..., 3, 3], and the stress of a step that does the change of stored energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.auditing.arrays import Array, einsum

IDENTITY = np.eye(3)

SMALL_STRAIN = 1e-6
"""Changes of strain below this are worked on by the mean stress: the discrete gradient divides by
their square, and its correction, of third order, is below round-off."""


def transposed(tensor: Array) -> Array:
    """Return tensors of shape [..., 3, 3] transposed."""
    return np.swapaxes(tensor, -1, -2)


def contracted(a: Array, b: Array) -> Array:
    """Return a : b of tensors of shape [..., 3, 3], shape [...]."""
    return einsum("...ij,...ij", a, b)


def deformation(c: Array) -> Array:
    """Return an F with FᵀF = C, the upper triangular one, shape [..., 3, 3]."""
    return transposed(np.linalg.cholesky(c).astype(np.float64))


def discrete_gradient(
    f0: Array,
    f1: Array,
    second_piola: Callable[[Array], Array],
    gained: Array,
    weights: Array | None = None,
) -> Array:
    """Return P̄ = ½(F₀ + F₁)(S(C̄) + κ ΔE) [Pa] whose work is the change of ψ (Gonzalez 2000).

    Parameters
    ----------
    f0, f1
        F at both ends of a step, shape [..., 3, 3].
    second_piola
        S [Pa] of C.
    gained
        Change of ψ [J/m³], shape [...].
    weights
        Volumes of points [m³], shape [cell_count, q], where κ is one number of each cell.
    """
    c0, c1 = transposed(f0) @ f0, transposed(f1) @ f1
    change = 0.5 * (c1 - c0)
    stress = second_piola(0.5 * (c0 + c1))
    missing, size = gained - contracted(stress, change), contracted(change, change)
    if weights is not None:
        share = weights / weights.sum(axis=1, keepdims=True)
        missing, size = ((share * x).sum(axis=1)[:, None] for x in (missing, size))
    large = size > SMALL_STRAIN**2
    kappa = np.where(large, missing / np.where(large, size, 1.0), 0.0)[..., None, None]
    mean: Array = 0.5 * (f0 + f1) @ (stress + kappa * change)
    return mean
