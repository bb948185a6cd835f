"""Arrays, their types, and products of vectors in the plane and in space.

What turns, a spin or a moment, has one component in the plane and three in space: arrays of them
have the shape [..., 1] or [..., 3].
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]

AXES = "xyz"


def einsum(subscripts: str, *operands: Array) -> Array:
    """Return `numpy.einsum`, whose own type is anything."""
    result: Array = np.einsum(subscripts, *operands)
    return result


def sizes(vectors: Array) -> Array:
    """Return the lengths of vectors, shape [..., D], shape [...]."""
    lengths: Array = np.linalg.norm(vectors, axis=-1)
    return lengths


def components(name: str, dimension: int) -> list[str]:
    """Return the columns of a vector: its name with each axis."""
    return [f"{name}_{axis}" for axis in AXES[:dimension]]


def turning_components(name: str, dimension: int) -> list[str]:
    """Return the columns of what turns: the name itself in the plane."""
    return [name] if dimension == 2 else components(name, 3)


def turning_axes(dimension: int) -> int:
    """Return about how many axes things turn."""
    return 1 if dimension == 2 else 3


def cross(a: Array, b: Array) -> Array:
    """Return a × b of vectors, shape [..., D], as [..., 1] in the plane and [..., 3] in space."""
    if np.shape(a)[-1] == 2:
        product: Array = a[..., :1] * b[..., 1:] - a[..., 1:] * b[..., :1]
        return product
    (ax, ay, az), (bx, by, bz) = (np.moveaxis(np.asarray(v), -1, 0) for v in (a, b))
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def turned(a: Array, spin: Array) -> Array:
    """Return spin × a of vectors, shape [..., D]."""
    if np.shape(a)[-1] == 2:
        return spin * np.stack([-a[..., 1], a[..., 0]], axis=-1)
    return cross(np.broadcast_to(spin, np.shape(a)), a)


def rotation(turn: Array) -> Array:
    """Return the rotation by a vector [rad], shape [1] or [3], as a matrix, shape [D, D]."""
    unit = np.eye(2 if len(turn) == 1 else 3)
    spin = turned(unit, turn).T
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return unit
    # sin φ/φ and (1 − cos φ)/φ², the second without its cancellation.
    first, second = np.sin(angle) / angle, 0.5 * (np.sin(0.5 * angle) / (0.5 * angle)) ** 2
    matrix: Array = unit + first * spin + second * spin @ spin
    return matrix


def inertia(arms: Array, momentum: Callable[[Array], Array]) -> Array:
    """Return the inertia [kg m²] of nodes with these arms [m], shape [1, 1] or [3, 3].

    `momentum` makes the momenta of nodes of their velocities.
    """
    axes = np.eye(turning_axes(arms.shape[-1]))
    fields = [turned(arms, axis) for axis in axes]
    momenta = [momentum(field) for field in fields]
    return np.array([[float((f * p).sum()) for p in momenta] for f in fields])


def turned_with(vectors: Array, before: Array, after: Array) -> Array:
    """Return vectors turned by the least rotations that take unit vectors to others, [count, D]."""
    # Two reflections: at the plane across both, and across the second.
    middle = before + after
    middle = middle / np.linalg.norm(middle, axis=1, keepdims=True)
    across = vectors - 2.0 * einsum("ki,ki->k", vectors, middle)[:, None] * middle
    again: Array = across - 2.0 * einsum("ki,ki->k", across, after)[:, None] * after
    return again


def nearest_rotation(matrix: Array) -> Array:
    """Return the rotation R of the polar decomposition A = R U, shape [D, D]."""
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right, dtype=np.float64)


def solved(matrix: Array, right: Array) -> Array:
    """Return x of A x = b, shape [n]."""
    return np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
