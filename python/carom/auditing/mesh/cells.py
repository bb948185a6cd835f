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
    revolution
        Whether they are of a body of revolution around x = 0, of which they are the whole rings.

    Attributes
    ----------
    gradients
        ∂N_a/∂X at the points where stresses are [1/m], shape [cell_count, q, a, D].
    hoops
        N_a/R there [1/m], shape [cell_count, q, a]; zero but in a body of revolution.
    weights
        Volumes of these points [m³], shape [cell_count, q].
    """

    def __init__(
        self,
        kind: Kind,
        nodes: Indices,
        points: Array,
        thickness: float,
        *,
        revolution: bool = False,
    ) -> None:
        self.kind, self.revolution = kind, revolution
        self.nodes = nodes
        self.node_count, self.dimension = points.shape
        self._corners = points[nodes]
        apart = [self._corners[:, a] - self._corners[:, b] for a, b in _pairs(nodes.shape[1])]
        self.shortest_edge = float(min(np.linalg.norm(d, axis=1).min() for d in apart))
        """Shortest distance between nodes of a cell in the reference configuration [m]."""
        rule = rule_of_stresses(kind, revolution=revolution)
        self.gradients, volumes = self._mapped(rule)
        depth, radius = self._depth(rule, thickness)
        self.weights = volumes * depth
        self.hoops = np.zeros(self.gradients.shape[:3])
        if revolution:
            self.hoops = kind.values(rule[0])[None] / radius[..., None]
        rule = rule_of_masses(kind, revolution=revolution)
        _, volumes = self._mapped(rule)
        values = kind.values(rule[0])
        depth, _ = self._depth(rule, thickness)
        self.shared_volumes = einsum("cq,qa,qb->cab", volumes * depth, values, values)
        """∫N_a N_b dV of the cells [m³], shape [cell_count, a, b]."""

    def deformation_gradient(self, u: Array) -> Array:
        """Return F = I + Σ u_a ⊗ ∇N_a, shape [cell_count, q, 3, 3]."""
        gradient = einsum("cai,cqaj->cqij", u[self.nodes], self.gradients)
        f: Array = np.broadcast_to(np.eye(3), (*gradient.shape[:2], 3, 3)).copy()
        f[..., : self.dimension, : self.dimension] += gradient
        if self.revolution:
            f[..., 2, 2] += einsum("ca,cqa->cq", u[self.nodes][..., 0], self.hoops)
        return f

    def divergence(self, stress: Array) -> Array:
        """Return the nodal forces Σ_q w P·∇N_a [N] of stresses [Pa], shape [node_count, D]."""
        free = stress[..., : self.dimension, : self.dimension]
        local = einsum("cq,cqij,cqaj->cai", self.weights, free, self.gradients)
        if self.revolution:
            local[..., 0] += einsum("cq,cq,cqa->ca", self.weights, stress[..., 2, 2], self.hoops)
        return self.assembled(local)

    def assembled(self, local: Array) -> Array:
        """Sum vectors of the nodes of cells, shape [cell_count, a, D], over the cells."""
        index, size = self.nodes.ravel(), self.node_count
        flat = local.reshape(-1, self.dimension)
        return np.stack([np.bincount(index, part, size) for part in flat.T], axis=1)

    def mean(self, values: Array) -> Array:
        """Return means over each cell of values at its points, shape [cell_count, q, ...]."""
        share = self.weights / self.weights.sum(axis=1, keepdims=True)
        return einsum("cq,cq...->c...", share, values)

    def _depth(self, rule: Rule, thickness: float) -> tuple[Array, Array]:
        """Return how far cells go on across the plane at points of a rule, and radii there [m]."""
        radius = einsum("ca,qa->cq", self._corners[..., 0], self.kind.values(rule[0]))
        if not self.revolution:
            return np.full(radius.shape, thickness), radius
        depth: Array = 2.0 * np.pi * radius
        return depth, radius

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
