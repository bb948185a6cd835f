"""How far reactions are from the laws of Signorini and Coulomb, in NumPy alone.

The solvers measure themselves by code of their own; an answer is checked again by this one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LARGEST_REACTIONS = 1e3
"""‖r‖ over ρ‖q‖ above which reactions are out of proportion."""


@dataclass(frozen=True)
class Measure:
    """Distance from the law.

    Parameters
    ----------
    residual
        ‖r − proj_K(r − (w + μ|w_t| n))‖ / max(‖q‖, ‖r‖, ‖w‖), in the units of the problem, as
        published codes have it.
    natural_residual
        The same with ρ(w + μ|w_t| n) and ρ‖q‖, ρ‖w‖, where ρ = n D / tr W [N/m] makes motions and
        reactions comparable. ‖r‖ counts as no more than 10³ ρ‖q‖; otherwise unbounded reactions
        would solve problems that contradict themselves.
    certificate
        Sum of the bi-potential gaps Σ |w_n r_n| + |μ r_n |w_t| + w_t·r_t| [J].
    """

    residual: float
    natural_residual: float
    certificate: float

    @property
    def decisive(self) -> float:
        """The larger residual, which is what a tolerance is compared with."""
        return float(np.maximum(self.residual, self.natural_residual))


def project(tau: NDArray[np.float64], mu: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the points of Coulomb's cones nearest to `tau`.

    Parameters
    ----------
    tau
        One vector per contact, component 0 normal, shape [n, D].
    mu
        Friction coefficients, shape [n].
    """
    normal, tangential = tau[:, 0], np.linalg.norm(tau[:, 1:], axis=1)
    polar = mu * tangential <= -normal
    inside = ~polar & (tangential <= mu * normal)
    height = np.where(polar, 0.0, (normal + mu * tangential) / (1.0 + mu * mu))
    length = np.divide(mu * height, tangential, out=np.zeros_like(normal), where=tangential > 0.0)
    on_border = np.column_stack([height, length[:, None] * tau[:, 1:]])
    return np.where(inside[:, None], tau, on_border)


def measure(
    r: NDArray[np.float64],
    w: NDArray[np.float64],
    *,
    q: NDArray[np.float64],
    mu: NDArray[np.float64],
    stiffness: float,
) -> Measure:
    """Measure reactions and the motions that go with them; NaN where they are not finite.

    Parameters
    ----------
    r
        Reactions [N], shape [n, D].
    w
        Relative motions W r + q [m], shape [n, D].
    q
        Relative motions without reactions [m], shape [n, D].
    mu
        Friction coefficients, shape [n].
    stiffness
        The natural ρ = n D / tr W [N/m].
    """
    return measure_by_powers(r, w, q=q, mu=mu, stiffness=math.frexp(stiffness))


def measure_by_powers(
    r: NDArray[np.float64],
    w: NDArray[np.float64],
    *,
    q: NDArray[np.float64],
    mu: NDArray[np.float64],
    stiffness: tuple[float, int],
) -> Measure:
    """Measure as `measure` does, with a stiffness m 2^e given as (m, e), which may be no float."""
    if not (np.isfinite(r).all() and np.isfinite(w).all()):
        return Measure(math.nan, math.nan, math.nan)
    natural = _residual(r, w, q, mu, stiffness, largest=LARGEST_REACTIONS)
    r_unit, w_unit = _exponent(r), _exponent(w)
    scaled_r, scaled_w = np.ldexp(r, -r_unit), np.ldexp(w, -w_unit)
    slip = np.linalg.norm(scaled_w[:, 1:], axis=1)
    along = np.einsum("id,id->i", scaled_w[:, 1:], scaled_r[:, 1:])
    gaps = np.abs(scaled_w[:, 0] * scaled_r[:, 0]) + np.abs(mu * scaled_r[:, 0] * slip + along)
    with np.errstate(over="ignore", under="ignore"):  # An energy may be too large for a number.
        certificate = float(np.ldexp(gaps.sum(), r_unit + w_unit))
    return Measure(_residual(r, w, q, mu, (1.0, 0)), natural, certificate)


def _residual(
    r: NDArray[np.float64],
    w: NDArray[np.float64],
    q: NDArray[np.float64],
    mu: NDArray[np.float64],
    rho: tuple[float, int],
    *,
    largest: float = math.inf,
) -> float:
    """Return the residual with the stiffness ρ = m 2^e, where ‖r‖ counts as `largest` ρ‖q‖ at most.

    Everything is divided by the power of two of the largest of r, ρw and ρq: no square overflows,
    and what vanishes is nothing beside it.
    """
    mantissa, exponent = rho
    sizes = [(r, 0), (w, exponent), (q, exponent)]
    powers = [_exponent(x) + e for x, e in sizes if x.any()]
    if not powers:
        return 0.0
    unit = max(powers)
    r, w, q = (np.ldexp(r, -unit), *(mantissa * np.ldexp(x, exponent - unit) for x in (w, q)))
    shifted = w.copy()
    shifted[:, 0] += mu * np.linalg.norm(w[:, 1:], axis=1)
    error, length = np.linalg.norm(r - project(r - shifted, mu)), float(np.linalg.norm(r))
    called_for = largest * float(np.linalg.norm(q)) if q.any() else math.inf
    if length > called_for:  # Beside such reactions motions are lost in round-off.
        error = np.hypot(error, np.finfo(float).eps * length)
        length = called_for
    return float(error / max(length, float(np.linalg.norm(q)), float(np.linalg.norm(w))))


def _exponent(x: NDArray[np.float64]) -> int:
    """Return the exponent e with max |x| < 2^e; 0 where all are zero."""
    return math.frexp(float(np.abs(x).max(initial=0.0)))[1]
