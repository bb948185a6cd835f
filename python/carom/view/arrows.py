"""Arrows in the plane: slender, with heads of one size."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

LONGEST = 0.16
"""Length of the longest arrow, as a share of the picture's diagonal."""

_HEAD = 0.02
"""Length of a head, as a share of it; a short arrow is no more than half head."""


def arrows(
    tails: NDArray[np.float64], vectors: NDArray[np.float64], *, size: float
) -> NDArray[np.float64]:
    """Return arrows as polygons, shape [count, 7, 2] [m].

    Parameters
    ----------
    tails
        Where they begin [m], shape [count, 2].
    vectors
        From tail to tip [m], shape [count, 2]; none is zero.
    size
        The picture's diagonal [m].
    """
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    along = vectors / length
    across = np.column_stack([-along[:, 1], along[:, 0]])
    head = np.minimum(0.5 * length, _HEAD * size)
    thin, wide = 0.12 * head, 0.4 * head
    neck = tails + (length - head) * along
    corners = [
        tails + thin * across,
        neck + thin * across,
        neck + wide * across,
        tails + vectors,
        neck - wide * across,
        neck - thin * across,
        tails - thin * across,
    ]
    return np.stack(corners, axis=1)
