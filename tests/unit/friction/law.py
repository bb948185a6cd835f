"""Signorini's and Coulomb's laws, one by one, and not through a residual."""

import numpy as np


def violation(W, q, mu, r):
    """Return the largest violation of any of the laws, in natural units relative to the largest.

    With forces measured by ρ = n D / tr W the conditions are r_n ≥ 0, w_n ≥ 0, r_n w_n = 0,
    |r_t| ≤ μ r_n and maximal dissipation, μ r_n |w_t| + r_t·w_t = 0. Penetration is also compared
    with the motions alone, and may be 10³ times as large there.
    """
    trace = np.trace(W)
    rho = len(W) / trace if trace > 0 else 1.0
    w = rho * ((W @ r.ravel()).reshape(r.shape) + q)
    size = max(np.linalg.norm(r), np.linalg.norm(w), rho * np.linalg.norm(q))
    if size == 0:
        return 0.0
    # Reactions without bound must not hide that contacts go into one another.
    depth = np.linalg.norm(np.minimum(w[:, 0], 0.0))
    depth /= 1e3 * max(np.linalg.norm(w), rho * np.linalg.norm(q), 1e-300)
    r, w = r / size, w / size
    thrust, slip = np.linalg.norm(r[:, 1:], axis=1), np.linalg.norm(w[:, 1:], axis=1)
    return max(
        depth,
        (-r[:, 0]).max(initial=0.0),
        (-w[:, 0]).max(initial=0.0),
        np.abs(r[:, 0] * w[:, 0]).max(initial=0.0),
        (thrust - mu * r[:, 0]).max(initial=0.0),
        np.abs(mu * r[:, 0] * slip + np.sum(r[:, 1:] * w[:, 1:], axis=1)).max(initial=0.0),
    )
