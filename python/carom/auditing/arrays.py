"""Arrays, their types, and products of vectors in the plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]


def einsum(subscripts: str, *operands: Array) -> Array:
    """Return `numpy.einsum`, whose own type is anything."""
    result: Array = np.einsum(subscripts, *operands)
    return result


def cross(a: Array, b: Array) -> Array:
    """Return a × b of plane vectors, shape [..., 2], shape [...]."""
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def rotation(angle: float) -> Array:
    """Return the rotation of the plane by an angle [rad], shape [2, 2]."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


def turned(a: Array, spin: float) -> Array:
    """Return spin × a of plane vectors, shape [..., 2]."""
    return spin * np.stack([-a[..., 1], a[..., 0]], axis=-1)
