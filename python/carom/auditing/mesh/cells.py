"""Cells of one kind: shape functions at points of quadrature, and sums over cells and nodes."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from carom.auditing.arrays import Array, Indices, einsum
from carom.auditing.mesh.kinds import Kind
from carom.auditing.mesh.quadrature import Rule, rule_of_masses, rule_of_stresses


class Cells:
    """The cells of a body, in its own numbering of nodes.

    Parameters
    ----------
    kind
        Their kind.
    nodes
        Nodes of the cells, in the order of their kind, shape [cell_count, a].
    points
        Reference positions of the body's nodes [m], shape [node_count, D].
    thickness
        Thickness [m]; 1 in space.

    Attributes
    ----------
    gradients
        ∂N_a/∂X at the points where stresses are [1/m], shape [cell_count, q, a, D].
    weights
        Volumes of these points [m³], shape [cell_count, q].
    """

    def __init__(self, kind: Kind, nodes: Indices, points: Array, thickness: float) -> None:
        self.kind = kind
        self.nodes = nodes
        self.node_count, self.dimension = points.shape
        self._corners = points[nodes]
        apart = [self._corners[:, a] - self._corners[:, b] for a, b in _pairs(nodes.shape[1])]
        self.shortest_edge = float(min(np.linalg.norm(d, axis=1).min() for d in apart))
        """Shortest distance between nodes of a cell in the reference configuration [m]."""
        self.gradients, volumes = self._mapped(rule_of_stresses(kind))
        self.weights = volumes * thickness
        rule = rule_of_masses(kind)
        _, volumes = self._mapped(rule)
        values = kind.values(rule[0])
        self.shared_volumes = einsum("cq,qa,qb->cab", volumes * thickness, values, values)
        """∫N_a N_b dV of the cells [m³], shape [cell_count, a, b]."""

    def deformation_gradient(self, u: Array) -> Array:
        """Return F = I + Σ u_a ⊗ ∇N_a, shape [cell_count, q, 3, 3]."""
        gradient = einsum("cai,cqaj->cqij", u[self.nodes], self.gradients)
        f: Array = np.broadcast_to(np.eye(3), (*gradient.shape[:2], 3, 3)).copy()
        f[..., : self.dimension, : self.dimension] += gradient
        return f

    def divergence(self, stress: Array) -> Array:
        """Return the nodal forces Σ_q w P·∇N_a [N] of stresses [Pa], shape [node_count, D]."""
        free = stress[..., : self.dimension, : self.dimension]
        return self.assembled(einsum("cq,cqij,cqaj->cai", self.weights, free, self.gradients))

    def assembled(self, local: Array) -> Array:
        """Sum vectors of the nodes of cells, shape [cell_count, a, D], over the cells."""
        index, size = self.nodes.ravel(), self.node_count
        flat = local.reshape(-1, self.dimension)
        return np.stack([np.bincount(index, part, size) for part in flat.T], axis=1)

    def mean(self, values: Array) -> Array:
        """Return means over each cell of values at its points, shape [cell_count, q, ...]."""
        share = self.weights / self.weights.sum(axis=1, keepdims=True)
        return einsum("cq,cq...->c...", share, values)

    def _mapped(self, rule: Rule) -> tuple[Array, Array]:
        """Return gradients in X, shape [cell_count, q, a, D], and volumes of points of a rule."""
        places, weights = rule
        slopes = self.kind.slopes(places)
        jacobian = einsum("cai,qak->cqik", self._corners, slopes)
        inverse = np.linalg.inv(jacobian).astype(np.float64)
        gradients = einsum("qak,cqkj->cqaj", slopes, inverse)
        return gradients, np.linalg.det(jacobian) * weights


def _pairs(count: int) -> list[tuple[int, int]]:
    return list(combinations(range(count), 2))


def boundary(kind: Kind, nodes: Indices) -> Indices:
    """Return the sides that belong to one cell only, outward as their kind has it, [count, a]."""
    sides = nodes[:, kind.facets].reshape(-1, kind.facets.shape[1])
    _, index, count = np.unique(
        np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer: Indices = sides[np.sort(index[count == 1])]
    return outer
