"""Laws that are functions of C = FᵀF, over arrays of points: of rubber and of foam."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, einsum
from carom.case import material as case

_IDENTITY = np.eye(3)


class LawOfC(Protocol):
    """A stored energy as a function of C, shape [..., 3, 3]."""

    @property
    def moduli(self) -> tuple[float, float]:
        """λ and μ where nothing has moved [Pa]."""

    def energy(self, c: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""

    def second_piola(self, c: Array) -> Array:
        """Return S = 2 ∂ψ/∂C [Pa], shape [..., 3, 3]."""


def law_of_c(material: case.Material) -> LawOfC | None:
    """Return the law of a material, if it is one of C."""
    if isinstance(material, case.MooneyRivlin | case.Yeoh):
        return Rubber.of(material)
    if isinstance(material, case.NeoHookean):
        young, poisson = material.young, material.poisson
        second = young / (2 * (1 + poisson))
        return NeoHookean(2 * second * poisson / (1 - 2 * poisson), second)
    if isinstance(material, case.Ogden):
        return Ogden(np.array(material.mu), np.array(material.alpha), material.bulk)
    if isinstance(material, case.BlatzKo):
        return BlatzKo(material.shear, material.poisson, material.fraction)
    return None


@dataclass(frozen=True)
class NeoHookean:
    """ψ = ½ μ (I₁ − 3 − 2 ln J) + ½ λ (ln J)².

    Parameters
    ----------
    first, second
        λ and μ [Pa].
    """

    first: float
    second: float

    @property
    def moduli(self) -> tuple[float, float]:
        """λ and μ [Pa]."""
        return self.first, self.second

    def energy(self, c: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""
        log_j = 0.5 * np.log(np.linalg.det(c))
        shear: Array = 0.5 * self.second * (einsum("...ii->...", c) - 3.0 - 2.0 * log_j)
        energy: Array = shear + 0.5 * self.first * log_j**2
        return energy

    def second_piola(self, c: Array) -> Array:
        """Return S = μ(I − C⁻¹) + λ ln J C⁻¹ [Pa], shape [..., 3, 3]."""
        log_j = 0.5 * np.log(np.linalg.det(c))[..., None, None]
        along: Array = (self.first * log_j - self.second) * np.linalg.inv(c)
        return self.second * _IDENTITY + along


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
    def of(cls, material: case.MooneyRivlin | case.Yeoh) -> Rubber:
        """Return the law of a material."""
        if isinstance(material, case.Yeoh):
            return cls((material.c10, material.c20, material.c30), 0.0, material.bulk)
        return cls((material.c10, 0.0, 0.0), material.c01, material.bulk)

    @property
    def moduli(self) -> tuple[float, float]:
        """λ and μ where nothing has moved [Pa]."""
        return _lame(self.bulk, 2.0 * (self.first[0] + self.second))

    def energy(self, c: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""
        j2, one, two = _invariants(c)
        x = one * j2 ** (-1 / 3) - 3.0
        a, b, d = self.first
        volume = _energy_of_volume(self.bulk, j2)
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


@dataclass(frozen=True)
class Ogden:
    """ψ = Σ (μ_p/α_p) (Σ λ̄^α_p − 3) + ¼ κ (J² − 1 − 2 ln J), λ̄ the stretches less that of volume.

    Parameters
    ----------
    constants, exponents
        μ_p [Pa] and α_p, shape [p].
    bulk
        κ [Pa].
    """

    constants: Array
    exponents: Array
    bulk: float

    @property
    def moduli(self) -> tuple[float, float]:
        """λ and μ where nothing has moved [Pa]."""
        return _lame(self.bulk, 0.5 * float(self.constants @ self.exponents))

    def energy(self, c: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""
        squares = np.asarray(np.linalg.eigvalsh(c), dtype=np.float64)
        j2 = squares.prod(axis=-1)
        energy = _energy_of_volume(self.bulk, j2)
        for constant, powers in self._powers(squares, j2):
            energy = energy + constant[1] * (powers.sum(axis=-1) - 3.0)
        return energy

    def second_piola(self, c: Array) -> Array:
        """Return S = 2 ∂ψ/∂C [Pa], shape [..., 3, 3]."""
        squares, axes = (np.asarray(part, dtype=np.float64) for part in np.linalg.eigh(c))
        j2 = squares.prod(axis=-1)
        along = 0.5 * self.bulk * (j2 - 1.0)[..., None] * np.ones_like(squares)
        for constant, powers in self._powers(squares, j2):
            along = along + constant[0] * (powers - powers.mean(axis=-1, keepdims=True))
        return einsum("...ik,...k,...jk->...ij", axes, along / squares, axes)

    def _powers(self, squares: Array, j2: Array) -> list[tuple[tuple[float, float], Array]]:
        """Return for every term μ and μ/α [Pa] with λ̄^α, shape [..., 3]."""
        stretches = squares * j2[..., None] ** (-1 / 3)
        terms = zip(self.constants.tolist(), self.exponents.tolist(), strict=True)
        return [((m, m / a), stretches ** (0.5 * a)) for m, a in terms]


@dataclass(frozen=True)
class BlatzKo:
    """½ μ f (I₁ − 3 + (J^(−2β) − 1)/β) and (1 − f) of the same with I₂/J² and 1/J; β = ν/(1 − 2ν).

    Parameters
    ----------
    shear
        μ [Pa].
    poisson
        ν.
    fraction
        f.
    """

    shear: float
    poisson: float
    fraction: float

    @property
    def _beta(self) -> float:
        return self.poisson / (1.0 - 2.0 * self.poisson)

    @property
    def moduli(self) -> tuple[float, float]:
        """λ and μ where nothing has moved [Pa]."""
        return 2.0 * self.shear * self._beta, self.shear

    def energy(self, c: Array) -> Array:
        """Return ψ [J/m³], shape [...]."""
        j2, one, two = _invariants(c)
        f, beta = self.fraction, self._beta
        first = one - 3.0 + (j2**-beta - 1.0) / beta
        other = two / j2 - 3.0 + (j2**beta - 1.0) / beta
        energy: Array = 0.5 * self.shear * (f * first + (1.0 - f) * other)
        return energy

    def second_piola(self, c: Array) -> Array:
        """Return S = 2 ∂ψ/∂C [Pa], shape [..., 3, 3]."""
        j2, one, two = (x[..., None, None] for x in _invariants(c))
        f, beta, inverse = self.fraction, self._beta, np.linalg.inv(c)
        first = _IDENTITY - j2**-beta * inverse
        # ∂(I₂/J²)/∂C = (I₁ 1 − C)/J² − (I₂/J²) C⁻¹.
        other = (one * _IDENTITY - c - two * inverse) / j2 + j2**beta * inverse
        stress: Array = self.shear * (f * first + (1.0 - f) * other)
        return stress


def _lame(bulk: float, shear: float) -> tuple[float, float]:
    return bulk - 2.0 / 3.0 * shear, shear


def _energy_of_volume(bulk: float, j2: Array) -> Array:
    energy: Array = 0.25 * bulk * (j2 - 1.0 - np.log(j2))
    return energy


def _invariants(c: Array) -> tuple[Array, Array, Array]:
    """Return J², I₁ and I₂ of C, each of shape [...]."""
    trace = einsum("...ii->...", c)
    return np.linalg.det(c), trace, 0.5 * (trace**2 - einsum("...ij,...ij->...", c, c))
