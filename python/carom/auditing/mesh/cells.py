"""The cells of a body: shape functions at points of quadrature, and sums over cells and nodes.

A body may have cells of several kinds. Then all have as many nodes and points as those with the
most; others end with their first node, whose shape function is zero there, and with points of no
volume.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.mesh.kinds import Kind, kind_of
from carom.auditing.mesh.quadrature import Rule, rule_of_masses, rule_of_stresses


class Cells:
    """The cells of a body, in its own numbering of nodes.

    Parameters
    ----------
    types
        VTK's types of the cells, shape [cell_count].
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
    shared_volumes
        ∫N_a N_b dV of the cells [m³], shape [cell_count, a, b].
    middles
        Means of the nodes of each cell [m], shape [cell_count, D].
    """

    def __init__(
        self,
        types: Indices,
        nodes: Indices,
        points: Array,
        thickness: float,
        *,
        revolution: bool = False,
    ) -> None:
        self.revolution, self.nodes = revolution, nodes
        self.node_count, self.dimension = points.shape
        self.groups = [
            (kind_of(int(one), self.dimension), np.flatnonzero(types == one))
            for one in np.unique(types)
        ]
        """The kinds of cells, and the cells that are of each."""
        count, widest = nodes.shape
        most = max(len(rule_of_stresses(kind, revolution=revolution)[1]) for kind, _ in self.groups)
        self.gradients: Array = np.zeros((count, most, widest, self.dimension))
        self.hoops: Array = np.zeros((count, most, widest))
        self.weights: Array = np.zeros((count, most))
        self.shared_volumes: Array = np.zeros((count, widest, widest))
        self.middles: Array = np.zeros((count, self.dimension))
        self.second: Mask = np.zeros(count, dtype=bool)
        """Which cells are of second degree, shape [cell_count]."""
        self.shortest_edge = np.inf
        """Shortest distance between nodes of a cell in the reference configuration [m]."""
        for kind, mine in self.groups:
            self._fill(kind, mine, points[nodes[mine, : len(kind.nodes)]], thickness)

    def _fill(self, kind: Kind, mine: Indices, corners: Array, thickness: float) -> None:
        """Find what the cells of a kind have, whose nodes are at `corners` [m], [count, a, D]."""
        a = corners.shape[1]
        pairs = combinations(range(a), 2)
        apart = [np.linalg.norm(corners[:, i] - corners[:, j], axis=1).min() for i, j in pairs]
        self.shortest_edge = min(self.shortest_edge, float(min(apart)))
        self.middles[mine], self.second[mine] = corners.mean(axis=1), kind.degree > 1
        rule = rule_of_stresses(kind, revolution=self.revolution)
        gradients, volumes = _mapped(kind, corners, rule)
        q = gradients.shape[1]
        self.gradients[mine, :q, :a] = gradients
        depth, radius = self._depth(kind, corners, rule, thickness)
        self.weights[mine, :q] = volumes * depth
        if self.revolution:
            self.hoops[mine, :q, :a] = kind.values(rule[0])[None] / radius[..., None]
        rule = rule_of_masses(kind, revolution=self.revolution)
        _, volumes = _mapped(kind, corners, rule)
        values = kind.values(rule[0])
        depth, _ = self._depth(kind, corners, rule, thickness)
        shared = einsum("cq,qa,qb->cab", volumes * depth, values, values)
        self.shared_volumes[mine, :a, :a] = shared

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

    def _depth(
        self, kind: Kind, corners: Array, rule: Rule, thickness: float
    ) -> tuple[Array, Array]:
        """Return how far cells go on across the plane at points of a rule, and radii there [m]."""
        radius = einsum("ca,qa->cq", corners[..., 0], kind.values(rule[0]))
        if not self.revolution:
            return np.full(radius.shape, thickness), radius
        depth: Array = 2.0 * np.pi * radius
        return depth, radius

    def outer_sides(self) -> Indices:
        """Return the sides that belong to one cell only, outward as kinds have it, [count, a]."""
        widest = max(kind.facets.shape[1] for kind, _ in self.groups)
        sides: list[Indices] = []
        owners: list[Indices] = []
        for kind, mine in self.groups:
            own = self.nodes[mine][:, kind.facets]
            missing = widest - own.shape[2]
            own = np.concatenate([own, np.repeat(own[..., :1], missing, axis=2)], axis=2)
            sides.append(own.reshape(-1, widest))
            owners.append(np.repeat(mine, len(kind.facets)))
        every, owner = np.concatenate(sides), np.concatenate(owners)
        # In the order of the cells. What ends with its first node counts that once.
        every = every[np.argsort(owner, kind="stable")]
        again = np.concatenate([np.zeros((len(every), 1), bool), every[:, 1:] == every[:, :1]], 1)
        keys = np.sort(np.where(again, -1, every), axis=1)
        _, index, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
        outer: Indices = every[np.sort(index[count == 1])]
        return outer


def _mapped(kind: Kind, corners: Array, rule: Rule) -> tuple[Array, Array]:
    """Return gradients in X, shape [cell_count, q, a, D], and volumes of points of a rule."""
    places, weights = rule
    slopes = kind.slopes(places)
    jacobian = einsum("cai,qak->cqik", corners, slopes)
    inverse = np.linalg.inv(jacobian).astype(np.float64)
    gradients = einsum("qak,cqkj->cqaj", slopes, inverse)
    return gradients, np.linalg.det(jacobian) * weights
