"""The mass matrix of a body that another code made."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.mass_matrix import MassMatrix

ALIKE = 1e-12
"""Masses differ from direction to direction by more than this part of the largest."""


class GivenMass(MassMatrix):
    """Multiplication by a mass matrix that somebody else made: see `Mass`.

    Parameters
    ----------
    entries
        Its rows, columns and values [kg]; component i of node n is number D n + i.
    shape
        [node_count, D].
    """

    def __init__(self, entries: tuple[Indices, Indices, Array], shape: tuple[int, ...]) -> None:
        self._rows, self._columns, self._values = entries
        self._shape = shape
        count, dimension = shape
        along, across = self._rows % dimension, self._columns % dimension
        nodes = self._rows // dimension * count + self._columns // dimension
        pairs, number = np.unique(nodes, return_inverse=True)
        blocks = (number.ravel() * dimension + along) * dimension + across
        size = len(pairs) * dimension**2
        matrices = np.bincount(blocks, self._values, size).reshape(-1, dimension, dimension)
        # Means over the directions of what nodes have with one another.
        shared = np.trace(matrices, axis1=1, axis2=2) / dimension
        beside = np.abs(matrices - shared[:, None, None] * np.eye(dimension)).max()
        self.plain = bool(beside <= ALIKE * np.abs(shared).max())
        self.nodal = np.bincount(pairs // count, shared, count).astype(np.float64)
        self.sizes = np.bincount(pairs // count, np.abs(shared), count).astype(np.float64)
        self.moved = np.zeros(0)
        self.total = float(self.nodal.sum())

    def times(self, v: Array) -> Array:
        """Return M v of nodal vectors, shape [node_count, D]."""
        products = self._values * v.ravel()[self._columns]
        summed = np.bincount(self._rows, products, v.size).astype(np.float64)
        return summed.reshape(self._shape)

    def mean(self, v: Array) -> Array:
        """Return the mean of nodal vectors by mass, shape [D]."""
        mean: Array = self.times(v).sum(axis=0) / self.total
        return mean
