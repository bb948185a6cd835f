"""Cones of friction, which may be elliptic, and what forces and slips are in terms of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, einsum, sizes


@dataclass(frozen=True)
class Ellipse:
    """(r₁/μ₁)² + (r₂/μ₂)² ≤ r_n² with the sliding along its normal; a circle where μ₁ = μ₂.

    With μ the larger of both it is |r̃| ≤ μ r_n for r̃_k = r_k μ/μ_k, and w̃_k = w_k μ_k/μ is against
    r̃: the law of Coulomb, with r̃·w̃ = r·w.

    Parameters
    ----------
    grain
        Direction of μ₁ in the tangent plane, zero where there is none, shape [count, D].
    normal
        Unit normals, shape [count, D].
    coefficients
        μ₁ and μ₂, shape [count, 2].
    """

    grain: Array
    normal: Array
    coefficients: Array

    @property
    def largest(self) -> Array:
        """μ, shape [count]."""
        largest: Array = self.coefficients.max(axis=1)
        return largest

    @property
    def lengths(self) -> Array:
        """μ₁/μ and μ₂/μ, shape [count, 2]; 1 where friction is alike in all directions."""
        whole = self.largest[:, None]
        drawn = self.grain.any(axis=1, keepdims=True)
        alike = ~(drawn & np.isfinite(whole) & (whole > 0.0))
        lengths: Array = self.coefficients / np.where(alike, 1.0, whole)
        return np.where(alike, 1.0, lengths)

    def force(self, across: Array) -> Array:
        """Return |r̃| of tangential forces [N], shape [count, D], shape [count]."""
        return self._measured(across, 1.0 / self.lengths)

    def slip(self, across: Array) -> Array:
        """Return |w̃| of tangential motions, shape [count, D], shape [count]."""
        return self._measured(across, self.lengths)

    def _measured(self, across: Array, factors: Array) -> Array:
        whole = sizes(across)
        drawn = self.grain.any(axis=1)
        if not drawn.any():
            return whole
        first = self.grain[drawn]
        second = cross(self.normal[drawn], first)
        parts = [einsum("ki,ki->k", across[drawn], axis) for axis in (first, second)]
        whole[drawn] = np.hypot(*(np.stack(parts) * factors[drawn].T))
        return whole
