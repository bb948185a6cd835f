"""What other codes say of their bodies, and what is said where a code is not there."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask
from carom.case.foreign_body import CONTACT_SET
from carom.mesh_file import MeshArrays


class Code(Protocol):
    """What another code says of a body; a `carom.ForeignBody` does.

    Displacements and forces have the shape [node_count, D].
    """

    name: str
    points: Array
    velocity: Array
    fixed: Mask
    mass_entries: tuple[Indices, Indices, Array]

    def mesh(self) -> MeshArrays:
        """Return its cells, and its facets that may touch others."""

    def energy_at(self, u: Array) -> float:
        """Return E(u) [J] of displacements [m]."""

    def force_at(self, u: Array) -> Array:
        """Return ∂E/∂u [N]."""

    def stiffness_at(self, u: Array) -> tuple[Indices, Indices, Array]:
        """Return rows, columns and values of ∂²E/∂u² [N/m], which may be approximate."""


class NoCode:
    """The code of a body that nobody has handed over: its answers are no numbers.

    Parameters
    ----------
    name
        Name of the body.
    points
        Reference positions of its nodes [m], shape [node_count, D].
    facets
        Its facets that may touch others, by its own nodes, shape [facet_count, a].
    cells
        Nodes of its cells, shape [cell_count, b].
    """

    def __init__(self, name: str, points: Array, facets: Indices, cells: Indices) -> None:
        self.name, self.points = name, points
        self.velocity = np.full(points.shape, np.nan)
        self.fixed: Mask = np.zeros(points.shape, dtype=bool)
        every = np.arange(points.size)
        self.mass_entries = (every, every, np.full(points.size, np.nan))
        self._mesh = MeshArrays(
            points=points, blocks=[("", cells)], facet_sets={CONTACT_SET: [facets]}
        )

    def mesh(self) -> MeshArrays:
        """Return its cells and facets, as the run has them."""
        return self._mesh

    def energy_at(self, u: Array) -> float:
        """Return no number."""
        del u
        return float("nan")

    def force_at(self, u: Array) -> Array:
        """Return no numbers, [node_count, D]."""
        return np.full(u.shape, np.nan)

    def stiffness_at(self, u: Array) -> tuple[Indices, Indices, Array]:
        """Return a diagonal of no numbers."""
        del u
        return self.mass_entries
