"""Materials."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from typing_extensions import Self

from carom.case.description import Description, NonNegative, Number, Positive
from carom.messages import problem


class Damping(Description):
    """Rayleigh damping C = mass · M + stiffness · K₀.

    Parameters
    ----------
    mass
        Factor of the mass matrix [1/s].
    stiffness
        Factor of the stiffness matrix of the undeformed body [s].
    """

    mass: NonNegative = 0.0
    stiffness: NonNegative = 0.0


class Viscosity(Description):
    """Kelvin–Voigt viscosity: the stress S = 2η dev Ė + ζ tr(Ė) I beside that of the law.

    Ė is the rate of the Green–Lagrange strain, or of the small strain if the law is
    `linear-elastic`.

    Parameters
    ----------
    shear
        Shear viscosity η [Pa s].
    bulk
        Bulk viscosity ζ [Pa s].
    """

    shear: NonNegative = 0.0
    bulk: NonNegative = 0.0


class _Elastic(Description):
    young: Positive
    poisson: Annotated[Number, Field(gt=-1, lt=0.5)]
    density: Positive
    damping: Damping = Damping()
    viscosity: Viscosity = Viscosity()


class SaintVenantKirchhoff(_Elastic):
    """Hooke's law between Green–Lagrange strain and second Piola–Kirchhoff stress.

    Parameters
    ----------
    young
        Young's modulus [Pa].
    poisson
        Poisson's ratio, in (−1, 0.5).
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["saint-venant-kirchhoff"] = "saint-venant-kirchhoff"


class LinearElastic(_Elastic):
    """Hooke's law of small strains.

    Parameters
    ----------
    young
        Young's modulus [Pa].
    poisson
        Poisson's ratio, in (−1, 0.5).
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["linear-elastic"] = "linear-elastic"


class NeoHookean(_Elastic):
    """Compressible neo-Hookean law for large strains, ψ = ½μ(I₁ − 3) − μ ln J + ½λ(ln J)².

    Parameters
    ----------
    young
        Young's modulus of small strains [Pa].
    poisson
        Poisson's ratio of small strains, in (−1, 0.5).
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["neo-hookean"] = "neo-hookean"


class MooneyRivlin(Description):
    """Mooney–Rivlin's law for rubber, ψ = c₁₀(Ī₁ − 3) + c₀₁(Ī₂ − 3) + ¼κ(J² − 1 − 2 ln J).

    Parameters
    ----------
    c10
        Constant of Ī₁ [Pa]; c10 + c01, half the shear modulus of small strains, is greater than 0.
    c01
        Constant of Ī₂ [Pa].
    bulk
        Bulk modulus κ [Pa].
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["mooney-rivlin"] = "mooney-rivlin"
    c10: Number
    c01: Number
    bulk: Positive
    density: Positive
    damping: Damping = Damping()
    viscosity: Viscosity = Viscosity()

    @model_validator(mode="after")
    def _resists_shear(self) -> Self:
        if self.c10 + self.c01 <= 0:
            what = "c10 + c01, half the shear modulus, must be greater than 0 Pa"
            raise problem(what, key="c01", value=self.c01)
        return self


class Yeoh(Description):
    """Yeoh's law for rubber, ψ = c₁₀x + c₂₀x² + c₃₀x³ + ¼κ(J² − 1 − 2 ln J), x = Ī₁ − 3.

    Parameters
    ----------
    c10
        Half the shear modulus of small strains [Pa].
    c20
        Constant of x² [Pa].
    c30
        Constant of x³ [Pa].
    bulk
        Bulk modulus κ [Pa].
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["yeoh"] = "yeoh"
    c10: Positive
    c20: Number = 0.0
    c30: Number = 0.0
    bulk: Positive
    density: Positive
    damping: Damping = Damping()
    viscosity: Viscosity = Viscosity()


class Ogden(Description):
    """Ogden's law for rubber, ψ = Σ(μ_p/α_p)(λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3) + ¼κ(J² − 1 − 2 ln J).

    Parameters
    ----------
    mu
        Constants μ_p [Pa], one per term; ½Σμ_pα_p, the shear modulus of small strains, is greater
        than 0.
    alpha
        Exponents α_p, as many as `mu`; any number but 0.
    bulk
        Bulk modulus κ [Pa].
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["ogden"] = "ogden"
    mu: Annotated[tuple[Number, ...], Field(min_length=1)]
    alpha: Annotated[tuple[Number, ...], Field(min_length=1)]
    bulk: Positive
    density: Positive
    damping: Damping = Damping()
    viscosity: Viscosity = Viscosity()

    @model_validator(mode="after")
    def _resists_shear(self) -> Self:
        if len(self.alpha) != len(self.mu):
            what = f"must have as many entries as mu, {len(self.mu)}"
            raise problem(what, key="alpha", value=self.alpha)
        if 0 in self.alpha:
            what = "an exponent cannot be 0; leave the term out"
            raise problem(what, key="alpha", value=self.alpha)
        if sum(mu * alpha for mu, alpha in zip(self.mu, self.alpha, strict=True)) <= 0:
            what = "half the sum of mu times alpha, the shear modulus, must be above 0 Pa"
            raise problem(what, key="mu", value=self.mu)
        return self


class BlatzKo(Description):
    """Blatz–Ko's law for foam and rubber.

    ψ = ½fμ[I₁ − 3 + (J^(−2β) − 1)/β] + ½(1 − f)μ[I₂/J² − 3 + (J^(2β) − 1)/β], β = ν/(1 − 2ν).
    With the defaults it is that of foamed polyurethane, ½μ(I₂/J² + 2J − 5).

    Parameters
    ----------
    shear
        Shear modulus μ [Pa].
    poisson
        Poisson's ratio ν of small strains, in (0, 0.5).
    fraction
        f, the share of the part that is linear in I₁, from 0 to 1.
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["blatz-ko"] = "blatz-ko"
    shear: Positive
    poisson: Annotated[Number, Field(gt=0, lt=0.5)] = 0.25
    fraction: Annotated[Number, Field(ge=0, le=1)] = 0.0
    density: Positive
    damping: Damping = Damping()
    viscosity: Viscosity = Viscosity()


class J2Plasticity(_Elastic):
    """Elastoplastic metal at large strain: von Mises' yield criterion, isotropic hardening.

    Hencky's elasticity of the logarithmic elastic strain; the Kirchhoff stress is bounded by
    σ_y(α) = σ₀ + Hα + (σ_∞ − σ₀)(1 − e^(−δα)), α the equivalent plastic strain. All plastic work
    ∫σ_y dα counts as dissipated.

    Parameters
    ----------
    young
        Young's modulus [Pa].
    poisson
        Poisson's ratio, in (−1, 0.5).
    yield_stress
        Initial yield stress σ₀ [Pa].
    hardening
        Linear hardening H [Pa].
    saturation_stress
        Voce's saturation stress σ_∞ [Pa], not below the yield stress; None is the yield stress.
    saturation_rate
        Voce's rate of saturation δ.
    density
        Mass per reference volume [kg/m³].
    damping
        Rayleigh damping, none by default.
    viscosity
        Kelvin–Voigt viscosity, none by default.
    """

    kind: Literal["j2-plasticity"] = "j2-plasticity"
    yield_stress: Positive
    hardening: NonNegative = 0.0
    saturation_stress: Positive | None = None
    saturation_rate: NonNegative = 0.0

    @model_validator(mode="after")
    def _does_not_soften(self) -> Self:
        if self.saturation_stress is not None and self.saturation_stress < self.yield_stress:
            what = "the saturation stress cannot be below the yield stress"
            raise problem(what, key="saturation_stress", value=self.saturation_stress)
        return self


Material = Annotated[
    SaintVenantKirchhoff
    | LinearElastic
    | NeoHookean
    | MooneyRivlin
    | Yeoh
    | Ogden
    | BlatzKo
    | J2Plasticity,
    Field(discriminator="kind"),
]
