"""Cells of one kind: shape functions, quadrature, and sums over cells as sums over nodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.auditing.arrays import Array, Indices, einsum
from carom.errors import InputError

VTK_TRIANGLE, VTK_QUAD = 5, 9

_GAUSS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(3)
_CENTRE = np.array([[1.0, 1.0]]) / 3
_MIDDLES = np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])
"""Midpoints of the sides of the reference triangle, whose mean integrates quadratics exactly."""


class Cells:
    """Triangles or quadrilaterals of a body, in its own numbering of nodes.

    Parameters
    ----------
    vtk_type
        Kind of the cells, in VTK's numbers.
    nodes
        Nodes of the cells, counter-clockwise, shape [cell_count, 3 or 4].
    points
        Reference positions of the body's nodes [m], shape [node_count, 2].
    thickness
        Thickness [m].

    Attributes
    ----------
    gradients
        ∂N_a/∂X at the points where stresses are [1/m], shape [cell_count, q, a, 2].
    weights
        Volumes of these points [m³], shape [cell_count, q].
    """

    def __init__(self, vtk_type: int, nodes: Indices, points: Array, thickness: float) -> None:
        if vtk_type not in (VTK_TRIANGLE, VTK_QUAD):
            raise InputError(f"cannot audit cells of VTK type {vtk_type}")
        self._triangles = vtk_type == VTK_TRIANGLE
        self.nodes = nodes
        self.node_count = len(points)
        self._corners = points[nodes]
        sides = self._corners - np.roll(self._corners, 1, axis=1)
        self.shortest_edge = float(np.linalg.norm(sides, axis=2).min())
        """Shortest edge in the reference configuration [m]."""
        at = _CENTRE if self._triangles else _GAUSS
        self.gradients, areas = self._mapped(at)
        self.weights = areas * thickness
        at = _MIDDLES if self._triangles else _GAUSS
        _, areas = self._mapped(at)
        values = self._values(at)
        self.shared_volumes = einsum("cq,qa,qb->cab", areas * thickness, values, values)
        """∫N_a N_b dV of the cells [m³], shape [cell_count, a, b]."""

    def deformation_gradient(self, u: Array) -> Array:
        """Return F = I + Σ u_a ⊗ ∇N_a, shape [cell_count, q, 2, 2]."""
        return np.eye(2) + einsum("cai,cqaj->cqij", u[self.nodes], self.gradients)

    def divergence(self, stress: Array) -> Array:
        """Return the nodal forces Σ_q w P·∇N_a [N] of stresses [Pa], shape [node_count, 2]."""
        return self.assembled(einsum("cq,cqij,cqaj->cai", self.weights, stress, self.gradients))

    def assembled(self, local: Array) -> Array:
        """Sum vectors of the nodes of cells, shape [cell_count, a, 2], over the cells."""
        index, size = self.nodes.ravel(), self.node_count
        flat = local.reshape(-1, 2)
        return np.stack([np.bincount(index, flat[:, i], size) for i in range(2)], axis=1)

    def mean(self, values: Array) -> Array:
        """Return means over each cell of values at its points, shape [cell_count, q, ...]."""
        share = self.weights / self.weights.sum(axis=1, keepdims=True)
        return einsum("cq,cq...->c...", share, values)

    def _values(self, at: Array) -> Array:
        """Return N_a at reference points, shape [q, a]."""
        x, y = at.T
        if self._triangles:
            return np.stack([1 - x - y, x, y], axis=1)
        return np.stack([(1 + sx * x) * (1 + sy * y) / 4 for sx, sy in _signs()], axis=1)

    def _slopes(self, at: Array) -> Array:
        """Return ∂N_a/∂ξ at reference points, shape [q, a, 2]."""
        if self._triangles:
            return np.broadcast_to([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]], (len(at), 3, 2))
        x, y = at.T
        slopes = [(sx * (1 + sy * y) / 4, sy * (1 + sx * x) / 4) for sx, sy in _signs()]
        table: Array = np.array(slopes).transpose(2, 0, 1)
        return table

    def _mapped(self, at: Array) -> tuple[Array, Array]:
        """Return gradients in X, shape [cell_count, q, a, 2], and areas of reference points."""
        slopes = self._slopes(at)
        jacobian = einsum("cai,qak->cqik", self._corners, slopes)
        inverse = np.linalg.inv(jacobian).astype(np.float64)
        gradients = einsum("qak,cqkj->cqaj", slopes, inverse)
        share = (0.5 if self._triangles else 4.0) / len(at)
        return gradients, np.linalg.det(jacobian) * share


def _signs() -> Sequence[tuple[float, float]]:
    return ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))


def boundary(nodes: Indices) -> Indices:
    """Return the sides that belong to one cell only, the body on their left, shape [count, 2]."""
    sides = np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=2).reshape(-1, 2)
    _, index, count = np.unique(
        np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer: Indices = sides[np.sort(index[count == 1])]
    return outer
