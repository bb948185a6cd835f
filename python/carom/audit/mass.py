"""The mass of a body as an operator: consistent, lumped, and moved off the nodes without mass."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.audit.arrays import Array, Indices, einsum
from carom.audit.cells import Cells
from carom.errors import InputError

LAYERS = 8
"""Layers of neighbours in which a node without mass looks for nodes to follow."""

AMPLIFICATION = 4.0
"""Σ|e| up to which the weights of a neighbourhood are taken without looking further."""

REPRODUCED = 1e-9
"""How well the weights must reproduce affine fields."""


class Mass:
    """Multiplication by the mass matrix of a body.

    Where nodes are to have no mass, their velocity is taken to follow those of massive nodes near
    them, v_b = Σ e_bk v_k, with weights that reproduce affine fields. With P the map from massive
    to all nodes the mass is PᵀMP, which keeps total mass, centre and inertia.

    Parameters
    ----------
    cells
        The cells of the body.
    points
        Reference positions [m], shape [node_count, 2].
    density
        Density [kg/m³].
    lumped
        Whether M is replaced by its row sums.
    massless
        Nodes without mass, ascending.
    """

    def __init__(
        self, cells: Cells, points: Array, density: float, *, lumped: bool, massless: Indices
    ) -> None:
        self._cells = cells
        self._local = density * cells.shared_volumes
        self._lumped: Array | None = None
        if lumped:
            ones = np.ones((cells.node_count, 2))
            self._lumped = self._all_nodes(ones)[:, :1]
        self._massless = massless
        self._follow = _Follow(cells.nodes, points, massless)
        self.nodal: Array = self.times(np.ones((cells.node_count, 2)))[:, 0]
        """Row sums [kg], shape [node_count]."""
        self.total = float(self.nodal.sum())
        """Mass of the body [kg]."""

    def times(self, v: Array) -> Array:
        """Return M v of nodal vectors, shape [node_count, 2]."""
        return self._follow.transposed(self._all_nodes(self._follow.extended(v)))

    def mean(self, v: Array) -> Array:
        """Return the mean of nodal vectors by mass, shape [2]."""
        return self.nodal @ v / self.total

    def _all_nodes(self, v: Array) -> Array:
        if self._lumped is not None:
            return self._lumped * v
        return self._cells.assembled(einsum("cab,cbi->cai", self._local, v[self._cells.nodes]))


class _Follow:
    """The map P from massive to all nodes, as triplets."""

    def __init__(self, cells: Indices, points: Array, massless: Indices) -> None:
        rows, columns, weights = [], [], []
        without = np.zeros(len(points), dtype=bool)
        without[massless] = True
        near = _neighbours(cells, len(points)) if len(massless) else []
        for node in massless:
            leaders, share = _leaders(int(node), near, without, points)
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


def _neighbours(cells: Indices, count: int) -> list[set[int]]:
    """Return for each node those that share a cell with it, itself included."""
    near: list[set[int]] = [set() for _ in range(count)]
    for nodes in cells.tolist():
        for node in nodes:
            near[node].update(nodes)
    return near


def _leaders(
    node: int, near: list[set[int]], without: NDArray[np.bool_], points: Array
) -> tuple[Indices, Array]:
    """Return massive nodes and weights that a node without mass follows.

    Neighbourhoods grow layer by layer until their weights amplify little.
    """
    best: tuple[float, Indices, Array] | None = None
    around = {node}
    for _ in range(LAYERS):
        wider = set().union(*(near[n] for n in around))
        if wider == around:
            break
        around = wider
        massive = np.array(sorted(n for n in around if not without[n]), dtype=np.int64)
        weights = affine_weights(points[massive] - points[node])
        if weights is None:
            continue
        amplification = float(np.abs(weights).sum())
        if best is None or amplification < best[0]:
            best = (amplification, massive, weights)
        if amplification <= AMPLIFICATION:
            break
    if best is None:
        raise InputError(f"node {node} has no massive nodes near that could carry its mass")
    return best[1], best[2]


def affine_weights(arms: Array) -> Array | None:
    """Return weights e with Σe = 1 and Σ e x = 0, those of least Σ e² |x|⁴, or None.

    Parameters
    ----------
    arms
        Positions x relative to the node that follows [m], shape [count, 2].
    """
    if len(arms) == 0:
        return None
    scaled = arms / np.linalg.norm(arms, axis=1).min()
    # Of A e = b with a diagonal norm: e = ω Aᵀ (A ω Aᵀ)⁺ b.
    importance = np.linalg.norm(scaled, axis=1) ** -4
    conditions = np.column_stack([np.ones(len(scaled)), scaled]).T
    system = conditions * importance @ conditions.T
    multipliers = np.linalg.pinv(system, rcond=1e-10, hermitian=True)[:, 0]
    weights: Array = importance * (multipliers @ conditions)
    wanted = np.array([1.0, 0.0, 0.0])
    reproduced = np.allclose(conditions @ weights, wanted, rtol=0, atol=REPRODUCED)
    return weights if reproduced else None
