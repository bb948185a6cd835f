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
        reactions comparable, and ‖r‖ counts as no more than 10³ ρ‖q‖: or else reactions without
        bound would solve problems that contradict themselves.
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
    if not (np.isfinite(r).all() and np.isfinite(w).all()):
        return Measure(math.nan, math.nan, math.nan)
    slip = np.linalg.norm(w[:, 1:], axis=1)
    shifted = w.copy()
    shifted[:, 0] += mu * slip

    def residual(rho: float, largest: float = math.inf) -> float:
        error = np.linalg.norm(r - project(r - rho * shifted, mu))
        length = float(np.linalg.norm(r))
        if length > largest:  # Beside such reactions motions are lost in round-off.
            error = np.hypot(error, np.finfo(float).eps * length)
            length = largest
        size = max(rho * float(np.linalg.norm(q)), length, rho * float(np.linalg.norm(w)))
        return float(error / size) if size > 0.0 else 0.0

    along = np.einsum("id,id->i", w[:, 1:], r[:, 1:])
    gaps = np.abs(w[:, 0] * r[:, 0]) + np.abs(mu * r[:, 0] * slip + along)
    called_for = stiffness * float(np.linalg.norm(q))
    natural = residual(stiffness, LARGEST_REACTIONS * called_for if called_for else math.inf)
    return Measure(residual(1.0), natural, float(gaps.sum()))
