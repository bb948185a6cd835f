"""Materials."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from carom.description import Description, NonNegative, Number, Positive


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


class _Elastic(Description):
    young: Positive
    poisson: Annotated[Number, Field(gt=-1, lt=0.5)]
    density: Positive
    damping: Damping = Damping()


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
    """

    kind: Literal["neo-hookean"] = "neo-hookean"


Material = Annotated[SaintVenantKirchhoff | LinearElastic | NeoHookean, Field(discriminator="kind")]
