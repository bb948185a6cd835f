"""The modes of a body: K φ = ω² M φ of where it is drawn, free or on its supports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from carom.modes.energies import Array

SHIFT = 1e-3
"""By how much the problem is shifted, in terms of (c/L)², c the speed of waves and L the size."""

RIGID = 1e-4
"""What is slower than this, in terms of the shift, moves without strain."""

MASSLESS = 1e-12
"""What is this much slower to follow than the slowest has no mass, relative to that."""

DENSE = 1500
"""Displacements up to which all modes are found at once."""


@dataclass(frozen=True)
class Modes:
    """Modes of a body with φᵀ M φ = 1, the slowest first.

    Parameters
    ----------
    frequencies
        ω [rad/s], shape [count]; those of motions without strain are zero and come first.
    shapes
        φ [kg^-½], shape [count, node_count, D].
    mass
        M of one direction [kg], [node_count, node_count].
    """

    frequencies: Array
    shapes: Array
    mass: sparse.csr_array

    @property
    def rigid(self) -> int:
        """How many are motions without strain."""
        return int((self.frequencies == 0.0).sum())

    def amplitudes(self, vectors: Array) -> Array:
        """Return φᵀ M x of the vectors of all nodes, shape [count]."""
        count = len(self.frequencies)
        result: Array = self.shapes.reshape(count, -1) @ (self.mass @ vectors).ravel()
        return result


def modes(matrices: Mapping[str, NDArray[Any]], count: int, *, slow: float) -> Modes:
    """Return the slowest modes of a body, and all motions without strain.

    Parameters
    ----------
    matrices
        What `carom._carom.Simulation.matrices` gives of it.
    count
        How many are wanted beside motions without strain; all there are, where that is fewer.
    slow
        c/L of the body [1/s], which tells motions without strain from modes.
    """
    dimension = round(matrices["stiffness"].shape[1] ** 0.5)
    nodes = int(matrices["rows"].max()) + 1
    mass = sparse.csr_array(
        (matrices["mass"], (matrices["rows"], matrices["columns"])), shape=(nodes, nodes)
    )
    free = np.flatnonzero(~matrices["held"])
    stiffness = _stiffness(matrices, nodes, dimension)[free][:, free]
    every = sparse.csr_array(sparse.kron(mass, sparse.eye_array(dimension)))[free][:, free]
    shift = SHIFT * slow**2
    wanted = min(count + dimension * (dimension + 1) // 2, len(free))
    # M φ = φ (K + s M)/(ω² + s): K + s M is positive definite where M is not.
    shifted = stiffness + shift * every
    shifted = 0.5 * (shifted + shifted.T)
    if len(free) <= DENSE or wanted >= len(free) - 1:
        values, vectors = eigh(every.toarray(), shifted.toarray())
    else:
        inverse = LinearOperator(shifted.shape, splu(shifted.tocsc()).solve, dtype=np.float64)
        start = np.ones(len(free))  # The same one each time: the same digits each time.
        values, vectors = eigsh(every, wanted, M=shifted, Minv=inverse, which="LA", v0=start)
    has_mass = values > MASSLESS * values.max()
    values, vectors = 1.0 / values[has_mass] - shift, vectors[:, has_mass]
    order = np.argsort(values)
    values, vectors = values[order], vectors[:, order]
    rigid = int((values < RIGID * shift).sum())
    taken = slice(0, rigid + count)
    values, vectors = values[taken], vectors[:, taken]
    vectors = vectors / np.sqrt((vectors * (every @ vectors)).sum(axis=0))
    shapes = np.zeros((vectors.shape[1], nodes * dimension))
    shapes[:, free] = vectors.T
    frequencies = np.sqrt(np.where(np.arange(len(values)) < rigid, 0.0, values))
    return Modes(frequencies, shapes.reshape(-1, nodes, dimension), mass)


def _stiffness(
    matrices: Mapping[str, NDArray[Any]], nodes: int, dimension: int
) -> sparse.csr_array:
    """Return K with the displacements of a node side by side [N/m]."""
    blocks = matrices["stiffness"].reshape(-1, dimension, dimension)
    rows = matrices["rows"][:, None, None] * dimension + np.arange(dimension)[:, None]
    columns = matrices["columns"][:, None, None] * dimension + np.arange(dimension)
    places = (np.broadcast_to(at, blocks.shape).ravel() for at in (rows, columns))
    size = nodes * dimension
    return sparse.csr_array((blocks.ravel(), tuple(places)), shape=(size, size))
