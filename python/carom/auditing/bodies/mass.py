"""The mass of a body as an operator: consistent, lumped, and moved off the nodes without mass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.auditing.arrays import Array, Indices, einsum
from carom.auditing.bodies.mass_matrix import MassMatrix
from carom.auditing.mesh.cells import Cells
from carom.auditing.mesh.facets import Facets

LAYERS = 5
"""Layers of massive nodes that share what a node without mass carried."""

NODES_PER_LAYER = 4
"""Most nodes of a layer."""

AMPLIFICATION = 2.5
"""Σ|e| up to which weights are taken without trying more nodes per layer."""

REPRODUCED = 1e-9
"""How well the weights must reproduce affine fields."""

TIE = 1e-9
"""Nodes are as far aside as one another up to this part of how far away they are."""


@dataclass(frozen=True)
class AddedMass:
    """A mass at a point that moves as the mean of nodes.

    Parameters
    ----------
    mass
        Mass [kg].
    nodes, shares
        Nodes of the body, and shares of them that add up to one.
    """

    mass: float
    nodes: Indices
    shares: Array


class NoMassInsideError(Exception):
    """What would be without mass is all there is near some node."""


class Mass(MassMatrix):
    """Multiplication by the mass matrix of a body.

    Where nodes are to have no mass, their velocity is taken to follow those of massive nodes near
    them, v_b = Σ e_bk v_k, with weights that reproduce affine fields. With P the map from massive
    to all nodes the mass is PᵀMP, which keeps total mass, centre and inertia.

    Parameters
    ----------
    cells
        The cells of the body.
    points
        Reference positions [m], shape [node_count, D].
    density
        Density of each cell [kg/m³], shape [cell_count].
    lumped
        Whether M is replaced by its row sums, or its scaled diagonal in cells of second degree.
    massless
        Nodes without mass, ascending.
    facets
        Facets between them.
    added
        Masses at points, beside that of the volume.
    """

    def __init__(
        self,
        cells: Cells,
        points: Array,
        density: Array,
        *,
        lumped: bool,
        massless: Indices,
        facets: Facets,
        added: Sequence[AddedMass] = (),
    ) -> None:
        self._cells = cells
        self._added: Sequence[AddedMass] = ()
        self._local = density[:, None, None] * cells.shared_volumes
        self._lumped: Array | None = None
        if lumped:
            self._lumped = _lumped(cells, self._local)
        self._added = added
        self._massless = massless
        self.sizes: Array = self._row_sizes()
        """How much each node resists what moves it alone [kg]: row sums without signs."""
        self.moved: Array = self.sizes[massless]
        """What nodes without mass had before it moved inside, likewise [kg]."""
        self.sizes[massless] = 0.0
        for one in added:
            np.add.at(self.sizes, one.nodes, one.mass * one.shares)
        self._follow = _Follow(cells.nodes, points, massless, facets)
        self.nodal: Array = self.times(np.ones((cells.node_count, cells.dimension)))[:, 0]
        """Row sums [kg], shape [node_count]."""
        self.total = float(self.nodal.sum())
        """Mass of the body [kg]."""

    def _row_sizes(self) -> Array:
        """Return the sums of the rows of the mass of the volume without signs, [node_count]."""
        if self._lumped is not None:
            return np.abs(self._lumped[:, 0])
        nodes, count = self._cells.nodes, self._cells.node_count
        row = np.repeat(nodes[:, :, None], nodes.shape[1], axis=2)
        entries, number = np.unique(row * count + nodes[:, None], return_inverse=True)
        values = np.abs(np.bincount(number.ravel(), self._local.ravel()))
        return np.bincount(entries // count, values, count).astype(np.float64)

    def times(self, v: Array) -> Array:
        """Return M v of nodal vectors, shape [node_count, D]."""
        return self._follow.transposed(self._all_nodes(self._follow.extended(v)))

    def resultant(self, values: Array) -> Array:
        """Return the sum of vectors of nodes, shape [D].

        In a body of revolution what is radial cancels around the axis.
        """
        total: Array = values.sum(axis=0)
        if self._cells.revolution:
            total[0] = 0.0
        return total

    def _all_nodes(self, v: Array) -> Array:
        product = self._of_volume(v)
        for one in self._added:
            product[one.nodes] += one.mass * np.outer(one.shares, one.shares @ v[one.nodes])
        return product

    def _of_volume(self, v: Array) -> Array:
        if self._lumped is not None:
            return self._lumped * v
        return self._cells.assembled(einsum("cab,cbi->cai", self._local, v[self._cells.nodes]))


def _lumped(cells: Cells, local: Array) -> Array:
    """Return a mass of nodes [kg] in place of consistent ones of cells, shape [node_count, 1].

    Row sums of cells of second degree may be negative: these have their diagonals, scaled to the
    mass of the cell (Hinton, Rock & Zienkiewicz 1976).
    """
    of_nodes = local.sum(axis=2)
    diagonal = einsum("caa->ca", local)
    whole = of_nodes.sum(axis=1, keepdims=True)
    scaled = diagonal * whole / diagonal.sum(axis=1, keepdims=True)
    of_nodes = np.where(cells.second[:, None], scaled, of_nodes)
    return cells.assembled(np.repeat(of_nodes[:, :, None], cells.dimension, axis=2))[:, :1]


class _Follow:
    """The map P from massive to all nodes, as triplets."""

    def __init__(self, cells: Indices, points: Array, massless: Indices, facets: Facets) -> None:
        rows, columns, weights = [], [], []
        without = np.zeros(len(points), dtype=bool)
        without[massless] = True
        near = _neighbours(cells, len(points)) if len(massless) else []
        inward = _inward(points, facets)
        for node in massless:
            leaders, share = _leaders(int(node), near, without, points, inward[node])
            rows.append(np.full(len(leaders), node))
            columns.append(leaders)
            weights.append(share)
        self._without = without
        self._rows = np.concatenate(rows) if rows else np.zeros(0, dtype=np.int64)
        self._columns = np.concatenate(columns) if rows else np.zeros(0, dtype=np.int64)
        self._weights = np.concatenate(weights)[:, None] if rows else np.zeros((0, 1))

    def extended(self, v: Array) -> Array:
        """Return P v; what `v` is at massless nodes does not count."""
        full = np.where(self._without[:, None], 0.0, v)
        np.add.at(full, self._rows, self._weights * v[self._columns])
        return full

    def transposed(self, f: Array) -> Array:
        """Return Pᵀ f, zero at massless nodes."""
        full = np.where(self._without[:, None], 0.0, f)
        np.add.at(full, self._columns, self._weights * f[self._rows])
        return full


def _inward(points: Array, facets: Facets) -> Array:
    """Return inward unit normals of the nodes of facets, shape [node_count, D]; else zero."""
    normal = np.zeros_like(points)
    vectors = facets.vectors(points)
    for _, rows, nodes in facets.groups:
        for corner in nodes.T:
            np.add.at(normal, corner, -vectors[rows])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return normal / np.where(size > 0, size, 1.0)


def _neighbours(cells: Indices, count: int) -> list[set[int]]:
    """Return for each node those that share a cell with it, itself included."""
    near: list[set[int]] = [set() for _ in range(count)]
    for nodes in cells.tolist():
        for node in nodes:
            near[node].update(nodes)
    return near


def _leaders(
    node: int, near: list[set[int]], without: NDArray[np.bool_], points: Array, inward: Array
) -> tuple[Indices, Array]:
    """Return massive nodes and weights that a node without mass follows.

    They are those of the nearest layers that stand most in line with its inward normal, as few as
    have weights that amplify little.
    """
    arms = points - points[node]
    aside = np.linalg.norm(arms - np.outer(arms @ inward, inward), axis=1)
    layers = [sorted(layer, key=lambda n: aside[n]) for layer in _layers(node, near, without)]
    far = np.linalg.norm(arms, axis=1)

    def nearest(layer: list[int], count: int) -> list[int]:
        # Those that are as far aside as the last one go with it.
        last = (
            aside[layer[count - 1]] + TIE * far[layer[count - 1]] if count <= len(layer) else np.inf
        )
        return [n for n in layer if aside[n] <= last]

    best: tuple[float, Indices, Array] | None = None
    for count in range(1, NODES_PER_LAYER + 1):
        massive = np.array([n for layer in layers for n in nearest(layer, count)], dtype=np.int64)
        weights = affine_weights(arms[massive])
        if weights is None:
            continue
        amplification = float(np.abs(weights).sum())
        if best is None or amplification < best[0] * (1 - TIE):
            best = (amplification, massive, weights)
        if amplification <= AMPLIFICATION * (1 + TIE):
            break
    if best is None:
        raise NoMassInsideError
    return best[1], best[2]


def _layers(node: int, near: list[set[int]], without: NDArray[np.bool_]) -> list[list[int]]:
    """Return the massive nodes around a node by their distance in the mesh, nearest first."""
    seen, front = {node}, {node}
    layers: list[list[int]] = []
    while front and len(layers) < LAYERS:
        front = set().union(*(near[n] for n in front)) - seen
        seen |= front
        massive = sorted(n for n in front if not without[n])
        if massive:
            layers.append(massive)
    return layers


def affine_weights(arms: Array) -> Array | None:
    """Return the weights e of least norm with Σe = 1 and Σ e x = 0, or None if there are none.

    Parameters
    ----------
    arms
        Positions x relative to the node that follows [m], shape [count, D].
    """
    if len(arms) == 0:
        return None
    scaled = arms / np.linalg.norm(arms, axis=1).max()
    # Of A e = b the least e is Aᵀ (A Aᵀ)⁺ b.
    conditions = np.column_stack([np.ones(len(scaled)), scaled]).T
    multipliers = np.linalg.pinv(conditions @ conditions.T, rcond=1e-10, hermitian=True)[:, 0]
    weights: Array = multipliers @ conditions
    wanted = np.eye(len(conditions))[0]
    reproduced = np.allclose(conditions @ weights, wanted, rtol=0, atol=REPRODUCED)
    return weights if reproduced else None
