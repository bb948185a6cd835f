"""Whether W is what a Delassus operator is: symmetric and positive semidefinite."""

from __future__ import annotations

import math
import time
import warnings

import numpy as np
import scipy.sparse as sp

from carom.errors import InputError
from carom.friction.arrays import place

ROUND_OFF = 1e-12
"""Asymmetry relative to the largest entry of W that the order of a sum explains."""

LARGEST_ASYMMETRY = 0.01
"""Asymmetry relative to the largest entry of W above which W is not taken for symmetric."""

CLEARLY = 1e-4
"""How far below zero an eigenvalue of W, scaled to a mean of one, has to be for W to be refused."""

DENSE = 192
"""Rows up to which all eigenvalues are bounded at once."""

STEPS, MANY_STEPS = 32, 300
"""Lanczos steps for a look at a larger matrix, and for a search where no solver found an answer."""


class AsymmetryWarning(UserWarning):
    """W was not symmetric, as in a file with few digits, and has been made so."""


def symmetrised(W: sp.csr_array, *, dimension: int, stacklevel: int) -> tuple[sp.csr_array, float]:
    """Return (W + Wᵀ)/2 and the asymmetry max |W − Wᵀ| / max |W|.

    Raises
    ------
    InputError
        If the asymmetry is above 1 %.

    Warns
    -----
    AsymmetryWarning
        If it is above round-off.
    """
    largest = float(np.abs(W.data).max(initial=0.0))
    transposed = W.T.tocsr()
    difference = W - transposed
    if difference.nnz == 0:
        return W, 0.0
    entry = int(np.argmax(np.abs(difference.data)))
    asymmetry = abs(float(difference.data[entry])) / largest
    row, column = place(difference, entry)
    if asymmetry > LARGEST_ASYMMETRY:
        raise InputError(
            f"W[{row}, {column}] = {W[row, column]:.6g} but W[{column}, {row}] = "
            f"{W[column, row]:.6g} (contacts {row // dimension} and {column // dimension}): W is "
            f"asymmetric by {asymmetry:.2g} of its largest entry, where {LARGEST_ASYMMETRY:g} is "
            "allowed; give a symmetric W, or M and H as a GlobalProblem",
            "W",
        )
    if asymmetry > ROUND_OFF:
        warnings.warn(
            f"W is asymmetric by {asymmetry:.2g} of its largest entry (at [{row}, {column}]); "
            "(W + Wᵀ)/2 is solved instead",
            AsymmetryWarning,
            stacklevel=stacklevel + 1,
        )
    return W * 0.5 + transposed * 0.5, asymmetry


def refuse_indefinite(
    W: sp.csr_array,
    *,
    dimension: int,
    asymmetry: float = 0.0,
    steps: int = STEPS,
    seconds: float = math.inf,
) -> None:
    """Raise if W, symmetric but for an asymmetry removed, is clearly indefinite.

    W is taken in units in which its diagonal is one, so that stiff contacts count as much as soft
    ones. S W S with S_ii = W_ii^(−1/2) has as many negative eigenvalues as W (Sylvester), and
    their mean is one.

    Up to `DENSE` rows a Cholesky factor decides. Of larger matrices the diagonal, the minors of
    two rows and the least Ritz value of some Lanczos steps are checked. That value is never below
    the least eigenvalue. So a matrix that is refused is indefinite; one that is not refused may
    still be. After so many `seconds` the Lanczos process ends with what it has.
    """
    if not W.data.any():
        return
    tolerance = max(CLEARLY, 10.0 * asymmetry)
    # Between 1/2 and 1, so that no product of two numbers vanishes that is not nothing beside it.
    exponent = math.frexp(float(np.abs(W.data).max()))[1]
    data, diagonal = np.ldexp(W.data, -exponent), np.ldexp(W.diagonal(), -exponent)
    floor = CLEARLY * CLEARLY * float(np.abs(data).max())
    worst = int(np.argmin(diagonal))
    if diagonal[worst] < -floor:
        raise InputError(
            f"W[{worst}, {worst}] = {W[worst, worst]:.6g} (contact {worst // dimension}): a "
            f"diagonal entry must not be negative; {_REMEDY}",
            "W",
        )
    inverse_root = 1.0 / np.sqrt(np.maximum(diagonal, floor))
    owners = np.repeat(np.arange(W.shape[0]), np.diff(W.indptr))
    scaled = data * inverse_root[owners] * inverse_root[W.indices]
    entry = int(np.argmax(np.abs(scaled)))
    if abs(scaled[entry]) > 1.0 + tolerance:
        row, column = place(W, entry)
        bound = np.sqrt(max(diagonal[row], 0.0) * max(diagonal[column], 0.0))
        bound = np.ldexp(bound, exponent)
        raise InputError(
            f"|W[{row}, {column}]| = {abs(W.data[entry]):.6g} is larger than "
            f"√(W[{row}, {row}] W[{column}, {column}]) = {bound:.6g} (contacts {row // dimension} "
            f"and {column // dimension}): W is indefinite; {_REMEDY}",
            "W",
        )
    unit = sp.csr_array((scaled, W.indices, W.indptr), shape=W.shape)
    if W.shape[0] > DENSE:
        least = _least_ritz_value(unit, steps, time.perf_counter() + seconds)
    elif _has_factor(unit, shift=tolerance):
        return
    else:
        least = float(np.linalg.eigvalsh(unit.toarray())[0])
    if least < -tolerance:
        raise InputError(
            f"W is indefinite: scaled to a diagonal of ones it has an eigenvalue of {least:.3g} or "
            f"less; {_REMEDY}",
            "W",
        )


_REMEDY = "Hᵀ M⁻¹ H of a mass or stiffness M is never so"


def _has_factor(unit: sp.csr_array, *, shift: float) -> bool:
    """Whether W + shift I has a Cholesky factor."""
    try:
        np.linalg.cholesky(unit.toarray() + shift * np.eye(unit.shape[0]))
    except np.linalg.LinAlgError:
        return False
    return True


def _least_ritz_value(unit: sp.csr_array, steps: int, end: float) -> float:
    """Return the least Ritz value of the Lanczos process until `end` [Golub & Van Loan, ch. 10].

    Lost orthogonality repeats values and moves none out of the spectrum, so nothing is done
    about it.
    """
    size = unit.shape[0]
    vector = np.random.default_rng(0).standard_normal(size)
    vector /= np.linalg.norm(vector)
    before, beta = np.zeros(size), 0.0
    alphas, betas = [], []
    for _ in range(min(steps, size)):
        image = unit @ vector
        image -= beta * before
        alpha = float(vector @ image)
        image -= alpha * vector
        alphas.append(alpha)
        beta = float(np.linalg.norm(image))
        if beta <= np.finfo(float).eps * max(map(abs, alphas)) or time.perf_counter() > end:
            break
        betas.append(beta)
        before, vector = vector, image / beta
    order = len(alphas)
    tridiagonal = np.diag(alphas) + np.diag(betas[: order - 1], 1) + np.diag(betas[: order - 1], -1)
    return float(np.linalg.eigvalsh(tridiagonal)[0])
