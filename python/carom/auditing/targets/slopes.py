"""The slope of a function at a point, by a fit of second degree to its values around it."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, einsum

UNKNOWN = 0.01
"""Second derivatives of which points know less than this part of all they know are zero."""

ON_A_LINE = 1e-6
"""Points whose moments have a determinant below this part of the trace squared are on a line."""


def fitted_slope(offsets: Array, *, known: bool) -> tuple[Array, bool] | None:
    """Return weights of rises to other points, shape [count, 2], and whether all bends are known.

    The function of second degree through the point fits those at `offsets` [m], shape [count, 2],
    best where each counts by the inverse of the square of its distance. If the first component of
    the slope is `known`, rises are what is left without it, and its weights are zero. None if the
    points are on a line.
    """
    size = float(np.linalg.norm(offsets, axis=1).mean())
    p, q = (offsets / size).T
    weight = 1.0 / (p * p + q * q)
    first = np.stack([np.zeros_like(p) if known else p, q], axis=1)
    second = np.stack([0.5 * p * p, p * q, 0.5 * q * q], axis=1)
    linear = einsum("k,ki,kj->ij", weight, first, first)
    bending = einsum("k,ki,kj->ij", weight, second, second)
    mixed = einsum("k,ki,kj->ij", weight, first, second)
    scale = float(np.trace(linear))
    if known:
        linear[0, 0] = scale
    if np.linalg.det(linear) <= ON_A_LINE * scale**2:
        return None
    inverse = np.linalg.inv(linear)
    values, vectors = np.linalg.eigh(bending - mixed.T @ inverse @ mixed)
    sure = values > UNKNOWN * np.trace(bending)
    solve = (vectors[:, sure] / values[sure]) @ vectors[:, sure].T
    # What the second derivatives take, the slope does not have.
    bend = (second - first @ inverse @ mixed) @ solve
    slopes: Array = (first - bend @ mixed.T) @ inverse * (weight / size)[:, None]
    return slopes, bool(sure.all())
