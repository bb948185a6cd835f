"""Rubber-like laws by invariants of C, over arrays of points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, einsum
from carom.case.material import MooneyRivlin, Yeoh

_IDENTITY = np.eye(3)


@dataclass(frozen=True)
class Rubber:
    """ψ = Σ c_k0 (Ī₁ − 3)^k + c₀₁ (Ī₂ − 3) + ¼ κ (J² − 1 − 2 ln J).

    Ī₁ = J^(−2/3) I₁ and Ī₂ = J^(−4/3) I₂ do not see the change of volume.

    Parameters
    ----------
    first
        c₁₀, c₂₀ and c₃₀ [Pa].
    second
        c₀₁ [Pa].
    bulk
        κ [Pa].
    """

    first: tuple[float, float, float]
    second: float
    bulk: float

    @classmethod
    def of(cls, material: MooneyRivlin | Yeoh) -> Rubber:
        """Return the law of a material."""
        if isinstance(material, Yeoh):
            return cls((material.c10, material.c20, material.c30), 0.0, material.bulk)
        return cls((material.c10, 0.0, 0.0), material.c01, material.bulk)

    @property
    def shear(self) -> float:
        """The shear modulus where nothing has moved [Pa]."""
        return 2.0 * (self.first[0] + self.second)

    def energy(self, c: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""
        j2, one, two = _invariants(c)
        x = one * j2 ** (-1 / 3) - 3.0
        a, b, d = self.first
        volume = 0.25 * self.bulk * (j2 - 1.0 - np.log(j2))
        energy: Array = x * (a + x * (b + x * d)) + self.second * (two * j2 ** (-2 / 3) - 3.0)
        return energy + volume

    def second_piola(self, c: Array) -> Array:
        """Return S = 2 ∂ψ/∂C [Pa], shape [..., 3, 3]."""
        j2, one, two = _invariants(c)
        x = one * j2 ** (-1 / 3) - 3.0
        a, b, d = self.first
        by_first = 2.0 * (a + x * (2.0 * b + 3.0 * d * x)) * j2 ** (-1 / 3)
        by_second = 2.0 * self.second * j2 ** (-2 / 3)
        # ∂I₁/∂C = 1 and ∂I₂/∂C = I₁ 1 − C; a change of volume takes along C⁻¹.
        along = -by_first * one / 3 - by_second * two * 2 / 3 + 0.5 * self.bulk * (j2 - 1.0)
        stress: Array = (by_first + by_second * one)[..., None, None] * _IDENTITY
        stress = stress - by_second[..., None, None] * c
        return stress + along[..., None, None] * np.linalg.inv(c)


def _invariants(c: Array) -> tuple[Array, Array, Array]:
    """Return J², I₁ and I₂ of C, each of shape [...]."""
    trace = einsum("...ii->...", c)
    return np.linalg.det(c), trace, 0.5 * (trace**2 - einsum("...ij,...ij->...", c, c))
